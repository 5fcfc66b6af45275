// Verbs that look at what runs have left: report, render, compare.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/number.hpp"
#include "base/suggest.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "read/written_run.hpp"
#include "reference/norms.hpp"
#include "reference/reference.hpp"
#include "render/styles.hpp"
#include "report/page.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

std::vector<read::WrittenOutput> outputs_of(const fs::path& place) {
  const std::string_view series = write::density_output().about.name;
  auto outputs = read::written_outputs(place, series);
  if (outputs.empty())
    throw FileError(fmt::format("{} holds no densities: name the folder of a run that wrote vtk = [\"{}\"], or a .vti",
                                place.string(), series));
  return outputs;
}

/// The one at a time that was typed, maybe with few digits: the nearest within a thousandth.
std::size_t output_at(double wanted, const std::vector<read::WrittenOutput>& outputs, const fs::path& folder) {
  std::optional<std::size_t> nearest;
  std::vector<double> times;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!outputs[i].time) continue;
    const double time = *outputs[i].time, apart = std::abs(wanted - time);
    times.push_back(time);
    if (apart <= 1e-3 * std::max(1e-9, std::abs(time)) &&
        (!nearest || apart < std::abs(wanted - *outputs[*nearest].time)))
      nearest = i;
  }
  if (!nearest)
    throw CommandLineError(fmt::format("--times {:g}: no output of {} is within a thousandth of it; there are {:.6g}",
                                       wanted, folder.string(), fmt::join(times, ", ")));
  return *nearest;
}

/// Names of files need not be UTF-8, JSON must.
std::string laid_out(const nlohmann::ordered_json& document) {
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// "50 x 50 points from (0, 0) with spacing 0.02".
std::string described(const Lattice& lattice) {
  std::vector<std::size_t> points;
  std::vector<double> origin;
  for (int k = 0; k < lattice.dimension; ++k) {
    points.push_back(lattice.points[k]);
    origin.push_back(lattice.origin[k]);
  }
  return fmt::format("{} points from ({:.10g}) with spacing {:.10g}", fmt::join(points, " x "), fmt::join(origin, ", "),
                     lattice.spacing);
}

std::string in_text(std::optional<double> time) { return time ? fmt::format("t = {:g}", *time) : "no time"; }

bool same_time(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

/// Outputs of two runs that belong together, as indices, and those that have no partner.
struct Partners {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<std::size_t> first_alone, second_alone;
};

/// Two single outputs belong together whatever their times; others if their times agree, or if neither has one, in
/// their order.
Partners partners_of(const std::vector<read::WrittenOutput>& a, const std::vector<read::WrittenOutput>& b) {
  if (a.size() == 1 && b.size() == 1) return {.pairs = {{0, 0}}, .first_alone = {}, .second_alone = {}};
  Partners partners;
  std::vector<bool> taken(b.size(), false);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t j = 0;
    while (j < b.size() && (taken[j] || a[i].time.has_value() != b[j].time.has_value() ||
                            (a[i].time && !same_time(*a[i].time, *b[j].time))))
      ++j;
    if (j == b.size()) {
      partners.first_alone.push_back(i);
      continue;
    }
    taken[j] = true;
    partners.pairs.emplace_back(i, j);
  }
  for (std::size_t j = 0; j < b.size(); ++j)
    if (!taken[j]) partners.second_alone.push_back(j);
  return partners;
}

/// "t = 0, 0.5 and 1", at most the first and the last where they are many.
std::string times_text(const std::vector<read::WrittenOutput>& outputs) {
  std::vector<std::string> times;
  for (const auto& output : outputs) times.push_back(output.time ? fmt::format("{:g}", *output.time) : "none");
  if (times.size() > 8) return fmt::format("{} from t = {} to {}", times.size(), times.front(), times.back());
  return fmt::format("t = {}", fmt::join(times, ", "));
}

}  // namespace

ExitCode report(const ReportOptions& options) {
  const report::ReportFiles files = report::write_report(options.folder, true);
  if (options.json) {
    nlohmann::ordered_json written = nlohmann::ordered_json::array();
    for (const fs::path& file : files.written) written.push_back(file.string());
    say("{}\n", laid_out(nlohmann::ordered_json{{"written", written}, {"left_out", files.left_out}}));
  } else {
    for (const fs::path& file : files.written) say("wrote  {}\n", file.string());
    for (const std::string& what : files.left_out) say("left out {}\n", what);
  }
  for (const std::string& why : files.failed) note("error: {}\n", why);
  return files.failed.empty() ? ExitCode::ok : ExitCode::files;
}

namespace {

const render::Style& style_called(const std::string& name) {
  if (const render::Style* style = base::find_or_null(render::styles(), name)) return *style;
  std::vector<std::string> names;
  for (const render::Style& style : render::styles()) names.emplace_back(style.about.name);
  const auto near = base::suggest(name, names);
  throw CommandLineError(fmt::format("--style {} is not known{} there are {}", name,
                                     near ? fmt::format("; did you mean {}?", *near) : ";", fmt::join(names, ", ")));
}

}  // namespace

ExitCode render(const RenderOptions& options) {
  if (const std::string reason = render::unavailable_reason(); !reason.empty()) throw Error(ExitCode::internal, reason);
  const std::vector<std::string> fields{"rho", "rho_exact", "error"};
  if (std::find(fields.begin(), fields.end(), options.field) == fields.end()) {
    const auto near = base::suggest(options.field, fields);
    throw CommandLineError(fmt::format("--field {}: there are rho, rho_exact, error{}", options.field,
                                       near ? fmt::format("; did you mean {}?", *near) : ""));
  }
  const bool error = options.field == "error";
  const render::Style* style = options.style.empty() ? nullptr : &style_called(options.style);
  const auto outputs = outputs_of(options.folder);
  std::set<std::size_t> wanted;
  for (const double time : options.times) wanted.insert(output_at(time, outputs, options.folder));
  for (std::size_t i = 0; options.times.empty() && i < outputs.size(); ++i) wanted.insert(i);
  // Read twice, for the range and for the picture: all of a run at once need not fit into memory.
  double low = 0, high = 0;
  int dimension = 2;
  for (const std::size_t i : wanted) {
    const DensityGrid density = read::read_density(outputs[i].file, options.field);
    dimension = density.lattice.dimension;
    for (const double value : density.rho) low = std::min(low, value), high = std::max(high, value);  // not of NaN
  }
  if (!style) style = &render::default_style(dimension, error);
  if (!style->about.shows(dimension))
    throw CommandLineError(
        fmt::format("--style {} does not show densities of {} dimensions", style->about.name, dimension));
  const auto [range_min, range_max] = style->range(low, high);
  const fs::path out = options.out.empty()
                           ? (fs::is_directory(options.folder) ? options.folder / "images" : fs::path("."))
                           : options.out;
  nlohmann::ordered_json written = nlohmann::ordered_json::array();
  const fs::path named = (options.folder / "").parent_path();  // "a/b/" is "a/b"
  for (const std::size_t i : wanted) {
    const fs::path png = out / fmt::format("{}{}_{:04}.png", options.field == "rho" ? "" : options.field + "_",
                                           style->about.name, outputs[i].number);
    draw(*style, read::read_density(outputs[i].file, options.field),
         {.title = named.stem().string(),
          .quantity = options.field == "rho" ? "density" : options.field,
          .time = outputs[i].time,
          .range_min = range_min,
          .range_max = range_max},
         png);
    written.push_back(png.string());
    if (!options.json) say("wrote  {}\n", png.string());
  }
  if (options.json) say("{}\n", laid_out(nlohmann::ordered_json{{"written", written}}));
  return ExitCode::ok;
}

ExitCode compare(const CompareOptions& options) {
  const auto a = outputs_of(options.first), b = outputs_of(options.second);
  const Partners partners = partners_of(a, b);
  if (partners.pairs.empty())
    throw FileError(
        fmt::format("{} and {} have no output time in common: the one has {}, the other {}; compare two of "
                    "their files to see how far apart they are all the same",
                    options.first.string(), options.second.string(), times_text(a), times_text(b)));
  nlohmann::ordered_json rows = nlohmann::ordered_json::array(), alone = nlohmann::ordered_json::array();
  const auto number = [](std::optional<double> t) { return t ? nlohmann::ordered_json(*t) : nullptr; };
  const auto tell_alone = [&](const std::vector<read::WrittenOutput>& outputs, const std::vector<std::size_t>& which,
                              const fs::path& other) {
    for (const std::size_t i : which) {
      note("warning: {} ({}) is not compared: {} has no output at that time\n", outputs[i].file.string(),
           in_text(outputs[i].time), other.string());
      alone.push_back({{"file", outputs[i].file.string()}, {"t", number(outputs[i].time)}});
    }
  };
  tell_alone(a, partners.first_alone, options.second);
  tell_alone(b, partners.second_alone, options.first);
  double worst = 0;
  for (const auto& [i, j] : partners.pairs) {
    const std::optional<double> time = a[i].time, other = b[j].time;
    const bool at_other_time = time && other && !same_time(*time, *other);
    if (at_other_time)  // has it come back?
      note("warning: the times differ: {} is at t = {}, {} at t = {}\n", a[i].file.string(),
           base::told_apart(*time, *other), b[j].file.string(), base::told_apart(*other, *time));
    const DensityGrid x = read::read_density(a[i].file, "rho"), y = read::read_density(b[j].file, "rho");
    const auto apart_by = [&](int k) {
      return std::abs(x.lattice.origin[static_cast<std::size_t>(k)] - y.lattice.origin[static_cast<std::size_t>(k)]);
    };
    const double same = 1e-6 * x.lattice.spacing;
    if (x.lattice.points != y.lattice.points || std::abs(x.lattice.spacing - y.lattice.spacing) > same * 1e-3 ||
        apart_by(0) > same || apart_by(1) > same || apart_by(2) > same)
      throw FileError(fmt::format(
          "{} and {} are on different grids, {} and {}; run one of them with the domain and [evaluate] of the other",
          a[i].file.string(), b[j].file.string(), described(x.lattice), described(y.lattice)));
    const ErrorNorms norms = gaussdrift::compare(x.rho, y.rho);
    const double linf = std::isnan(norms.linf) ? (x.rho == y.rho ? 0.0 : INFINITY) : norms.linf;
    worst = std::max(worst, linf);
    rows.push_back({{"t", number(time)}, {"L1", norms.l1}, {"L2", norms.l2}, {"Linf", linf}});
    if (at_other_time) rows.back()["t_second"] = number(other);
    if (!options.json) say("{:<14} L1 {:.2e}  L2 {:.2e}  Linf {:.2e}\n", in_text(time), norms.l1, norms.l2, linf);
  }
  const bool apart = options.tolerance >= 0 && !(worst <= options.tolerance);
  if (options.json)
    say("{}\n", laid_out(nlohmann::ordered_json{
                    {"outputs", rows}, {"not_compared", alone}, {"largest", worst}, {"within", !apart}}));
  else
    say("largest difference {:.2e}, relative to {}{}\n", worst, options.second.string(),
        options.tolerance < 0 ? ""
        : apart               ? fmt::format(": more than {:g}", options.tolerance)
                              : fmt::format(": within {:g}", options.tolerance));
  return apart ? ExitCode::check : ExitCode::ok;
}

}  // namespace gaussdrift::cli
