#include "read/written_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "base/number.hpp"
#include "gaussdrift/error.hpp"
#include "read/grid_file.hpp"

namespace gaussdrift::read {

namespace fs = std::filesystem;

namespace {

/// "density_0012.vti": 12. More than 9999 outputs have longer numbers, so names do not sort as numbers do.
std::optional<std::size_t> number_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  const char *first = stem.data() + stem.rfind('_') + 1, *last = stem.data() + stem.size();
  std::size_t number = 0;
  const auto read = std::from_chars(first, last, number);
  if (file.extension() != ".vti" || read.ec != std::errc() || read.ptr != last) return std::nullopt;
  return number;
}

read::GridSnapshot snapshot(const fs::path& file, const std::string& array) {
  try {
    return read::read_snapshot(file, array);
  } catch (const read::GridFileError& error) {
    // Paths of cases are relative to them; these are not.
    const bool tells = !error.remedy().empty() && fs::exists(file);
    throw FileError(tells ? fmt::format("{}; {}", error.what(), error.remedy()) : std::string(error.what()));
  }
}

}  // namespace

std::vector<WrittenOutput> written_outputs(const fs::path& place, std::string_view series) {
  if (!fs::exists(place)) throw FileError(fmt::format("there is no {}", place.string()));
  if (!fs::is_directory(place)) return {{place, snapshot(place, "rho").time, number_of(place).value_or(0)}};
  std::vector<WrittenOutput> outputs;
  const fs::path folder = place / series;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (const auto number = number_of(entry.path())) outputs.push_back({entry.path(), {}, *number});
  std::sort(outputs.begin(), outputs.end(),
            [](const WrittenOutput& a, const WrittenOutput& b) { return a.number < b.number; });
  std::vector<read::SeriesEntry> listed;
  try {
    if (const fs::path list = place / fmt::format("{}.pvd", series); fs::exists(list)) listed = read::read_series(list);
  } catch (const read::GridFileError&) {  // the files say it themselves
  }
  std::map<fs::path, double> times;  // by name
  for (const read::SeriesEntry& entry : listed) {
    // A run names files of its own. What leads elsewhere was put there by somebody.
    const fs::path inside = entry.file.lexically_normal().lexically_relative((place / "").lexically_normal());
    if (inside.empty() || *inside.begin() == "..")
      throw FileError(fmt::format("line {} of {}.pvd in {} names {}, which is not in the folder of the run", entry.line,
                                  series, place.string(), entry.file.string()));
    times[entry.file.filename()] = entry.time;
  }
  for (WrittenOutput& output : outputs) {
    const auto known = times.find(output.file.filename());
    output.time = known != times.end() ? known->second : snapshot(output.file, "rho").time;
  }
  return outputs;
}

DensityGrid read_density(const fs::path& file, const std::string& array) {
  read::GridSnapshot data = snapshot(file, array);
  DensityGrid density;
  density.lattice.dimension = data.dimension;
  double spacing = 0;  // of the first axis that has one
  for (int k = 0; k < data.dimension && spacing == 0; ++k)
    if (const auto& nodes = data.axis[static_cast<std::size_t>(k)]; nodes.size() > 1) spacing = nodes[1] - nodes[0];
  if (spacing == 0) throw FileError(fmt::format("the grid of {} is a single point", file.string()));
  density.lattice.spacing = spacing;
  for (int k = 0; k < data.dimension; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const std::vector<double>& nodes = data.axis[axis];
    density.lattice.points[axis] = nodes.size();
    density.lattice.origin[axis] = nodes.front();
    // Coordinates are rounded: origins may be large against spacings.
    const double rounding = 1e-6 * spacing + 1e-15 * std::max(std::abs(nodes.front()), std::abs(nodes.back()));
    for (std::size_t i = 1; i < nodes.size(); ++i)
      if (!(std::abs(nodes[i] - nodes[i - 1] - spacing) <= rounding))
        throw FileError(fmt::format(
            "the grid of {} is not equally spaced, the same on all axes, as densities are: {} between points {} and {} "
            "along {}, {} elsewhere",
            file.string(), base::told_apart(nodes[i] - nodes[i - 1], spacing), i, i + 1, "xyz"[k],
            base::told_apart(spacing, nodes[i] - nodes[i - 1])));
  }
  density.rho = std::move(data.values);
  return density;
}

}  // namespace gaussdrift::read
