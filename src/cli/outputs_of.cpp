#include "cli/outputs_of.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/suggest.hpp"
#include "cli/terminal.hpp"
#include "gaussdrift/error.hpp"
#include "sim/grid_fields.hpp"
#include "write/output_files.hpp"
#include "write/told_by_folder.hpp"

namespace gaussdrift::cli {

void tell_if_unfinished(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / "run.toml") && !write::says_complete(folder))
    note("note: {0} is not complete; gaussdrift resume {0} goes on\n", folder.string());
}

std::vector<read::WrittenOutput> outputs_of(const std::filesystem::path& place) {
  tell_if_unfinished(place);
  const std::string_view series = write::density_output().about.name;
  auto outputs = read::written_outputs(place, series);
  if (outputs.empty())
    throw FileError(
        fmt::format("{} holds no densities: name the folder of a run that wrote vtk = [\"{}\"], or a .vti or .pvti",
                    place.string(), series));
  return outputs;
}

std::vector<std::string> arrays_of_outputs() {
  std::vector<std::string> names{"rho", "rho_exact", "error"};
  for (const GridFieldKind& kind : grid_fields())
    if (std::find(names.begin(), names.end(), kind.about.name) == names.end()) names.emplace_back(kind.about.name);
  return names;
}

void check_array(const std::string& field) {
  const std::vector<std::string> names = arrays_of_outputs();
  if (std::find(names.begin(), names.end(), field) != names.end()) return;
  const auto near = base::suggest(field, names);
  throw CommandLineError(fmt::format("--field {}: there are {}{}", field, fmt::join(names, ", "),
                                     near ? fmt::format("; did you mean {}?", *near) : ""));
}

}  // namespace gaussdrift::cli
