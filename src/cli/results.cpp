// Verbs that look at what runs have left: report, render, compare.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/suggest.hpp"
#include "cli/verbs.hpp"
#include "render/picture.hpp"
#include "sim/reference.hpp"
#include "study/report.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

/// Names of density/density_*.vti in their order, or the one file itself.
std::vector<fs::path> densities_of(const fs::path& place) {
  if (fs::is_regular_file(place)) return {place};
  std::vector<fs::path> files;
  if (fs::is_directory(place / "density"))
    for (const auto& entry : fs::directory_iterator(place / "density"))
      if (entry.path().extension() == ".vti") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw FileError(
        fs::exists(place)
            ? fmt::format("{} holds no densities: name the folder of a run that wrote vtk = [\"density\"], or a .vti",
                          place.string())
            : fmt::format("there is no {}", place.string()));
  return files;
}

std::vector<double> times_of(const fs::path& folder) {
  std::vector<double> times;
  std::ifstream in(folder / "summary.json");
  const auto summary = nlohmann::json::parse(in, nullptr, false);
  if (!summary.is_discarded() && summary.contains("frames"))
    for (const auto& frame : summary["frames"]) times.push_back(frame["t"].get<double>());
  return times;
}

}  // namespace

ExitCode report(const ReportOptions& options) {
  const study::ReportFiles files = study::write_report(options.folder, true);
  if (options.json) {
    nlohmann::ordered_json written = nlohmann::ordered_json::array();
    for (const fs::path& file : files.written) written.push_back(file.string());
    fmt::print("{}\n", nlohmann::ordered_json{{"written", written}, {"left_out", files.left_out}}.dump(2));
  } else {
    for (const fs::path& file : files.written) fmt::print("wrote  {}\n", file.string());
    for (const std::string& what : files.left_out) fmt::print("left out {}\n", what);
  }
  return ExitCode::ok;
}

ExitCode render(const RenderOptions& options) {
  if (const std::string reason = render::unavailable_reason(); !reason.empty()) throw Error(ExitCode::internal, reason);
  const std::vector<std::string> fields{"rho", "rho_exact", "error"};
  if (std::find(fields.begin(), fields.end(), options.field) == fields.end()) {
    const auto near = base::suggest(options.field, fields);
    throw CommandLineError(fmt::format("--field {}: there are rho, rho_exact, error{}", options.field,
                                       near ? fmt::format("; did you mean {}?", *near) : ""));
  }
  const bool error = options.field == "error";
  std::vector<std::string> names;
  std::optional<render::Style> style;
  for (const auto known :
       {render::Style::surface, render::Style::contour, render::Style::heatmap, render::Style::slices,
        render::Style::projection, render::Style::isosurface, render::Style::error}) {
    names.push_back(render::to_string(known));
    if (names.back() == options.style) style = known;
  }
  if (!options.style.empty() && !style) {
    const auto near = base::suggest(options.style, names);
    throw CommandLineError(fmt::format("--style {} is not known{} there are {}", options.style,
                                       near ? fmt::format("; did you mean {}?", *near) : ";", fmt::join(names, ", ")));
  }
  const auto files = densities_of(options.folder);
  const auto times = times_of(options.folder);
  std::vector<std::pair<double, DensityGrid>> frames;
  std::vector<std::size_t> numbers;  // of the outputs
  for (const double wanted : options.times)
    if (std::none_of(times.begin(), times.end(),
                     [&](double time) { return std::abs(wanted - time) <= 1e-3 * std::max(1e-9, std::abs(time)); }))
      throw CommandLineError(fmt::format("--times {:g}: no output of {} is within a thousandth of it; there are {:.6g}",
                                         wanted, options.folder.string(), fmt::join(times, ", ")));
  double low = 0, high = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const double time = i < times.size() ? times[i] : static_cast<double>(i);
    if (!options.times.empty() && std::none_of(options.times.begin(), options.times.end(), [&](double wanted) {
          return std::abs(wanted - time) <= 1e-3 * std::max(1e-9, std::abs(time));
        }))
      continue;
    numbers.push_back(i);
    frames.emplace_back(time, study::read_density(files[i], options.field));
    const auto [least, most] = std::minmax_element(frames.back().second.rho.begin(), frames.back().second.rho.end());
    low = std::min(low, *least), high = std::max(high, *most);
  }
  if (frames.empty())
    throw CommandLineError(fmt::format("none of --times is an output time of {}", options.folder.string()));
  const int dimension = frames.front().second.lattice.dimension;
  if (!style) style = error ? render::Style::error : dimension == 2 ? render::Style::surface : render::Style::slices;
  if (!render::shows(*style, dimension))
    throw CommandLineError(
        fmt::format("--style {} does not show densities of {} dimensions", render::to_string(*style), dimension));
  const auto [range_min, range_max] =
      *style == render::Style::error ? render::symmetric_range(low, high) : render::rounded_range(low, high);
  const fs::path out = options.out.empty()
                           ? (fs::is_directory(options.folder) ? options.folder / "images" : fs::path("."))
                           : options.out;
  nlohmann::ordered_json written = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const fs::path png = out / fmt::format("{}{}_{:04}.png", options.field == "rho" ? "" : options.field + "_",
                                           render::to_string(*style), numbers[i]);
    draw(*style, frames[i].second,
         {.title = options.folder.filename().string(),
          .quantity = options.field == "rho" ? "density" : options.field,
          .time = frames[i].first,
          .range_min = range_min,
          .range_max = range_max},
         png);
    written.push_back(png.string());
    if (!options.json) fmt::print("wrote  {}\n", png.string());
  }
  if (options.json) fmt::print("{}\n", nlohmann::ordered_json{{"written", written}}.dump(2));
  return ExitCode::ok;
}

ExitCode compare(const CompareOptions& options) {
  const auto a = densities_of(options.first), b = densities_of(options.second);
  if (a.size() != b.size())
    throw FileError(fmt::format("{} has {} outputs, {} has {}: compare runs with the same output times",
                                options.first.string(), a.size(), options.second.string(), b.size()));
  const auto times_a = times_of(options.first), times_b = times_of(options.second);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i < times_a.size() && i < times_b.size() &&
        std::abs(times_a[i] - times_b[i]) > 1e-9 * std::max(1.0, std::abs(times_a[i])))
      throw FileError(
          fmt::format("output {} is at t = {:g} in the one and at t = {:g} in the other", i, times_a[i], times_b[i]));
    const DensityGrid x = study::read_density(a[i], "rho"), y = study::read_density(b[i], "rho");
    const auto apart_by = [&](int k) {
      return std::abs(x.lattice.origin[static_cast<std::size_t>(k)] - y.lattice.origin[static_cast<std::size_t>(k)]);
    };
    const double same = 1e-6 * x.lattice.spacing;
    if (x.lattice.points != y.lattice.points || std::abs(x.lattice.spacing - y.lattice.spacing) > same * 1e-3 ||
        apart_by(0) > same || apart_by(1) > same || apart_by(2) > same)
      throw FileError(fmt::format(
          "{} and {} are on different grids; run one of them with the domain and evaluate.per_axis of the other",
          a[i].string(), b[i].string()));
    const ErrorNorms norms = gaussdrift::compare(x.rho, y.rho);
    const double linf = std::isnan(norms.linf) ? (x.rho == y.rho ? 0.0 : INFINITY) : norms.linf;
    worst = std::max(worst, linf);
    rows.push_back({{"t", i < times_a.size() ? times_a[i] : static_cast<double>(i)},
                    {"L1", norms.l1},
                    {"L2", norms.l2},
                    {"Linf", linf}});
    if (!options.json)
      fmt::print("t = {:<10.6g} L1 {:.2e}  L2 {:.2e}  Linf {:.2e}\n", rows.back()["t"].get<double>(), norms.l1,
                 norms.l2, linf);
  }
  const bool apart = options.tolerance >= 0 && !(worst <= options.tolerance);
  if (options.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"outputs", rows}, {"largest", worst}, {"within", !apart}}.dump(2));
  else
    fmt::print("largest difference {:.2e}, relative to {}{}\n", worst, options.second.string(),
               options.tolerance < 0 ? ""
               : apart               ? fmt::format(": more than {:g}", options.tolerance)
                                     : fmt::format(": within {:g}", options.tolerance));
  return apart ? ExitCode::check : ExitCode::ok;
}

}  // namespace gaussdrift::cli
