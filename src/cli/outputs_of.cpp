#include "cli/outputs_of.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/shell_word.hpp"
#include "base/suggest.hpp"
#include "cli/terminal.hpp"
#include "gaussdrift/error.hpp"
#include "sim/grid_fields.hpp"
#include "write/folder_facts.hpp"
#include "write/folder_lock.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::cli {

namespace {

/// Of a damaged status.json nothing is known; what is looked at does not depend on it.
bool says_running(const std::filesystem::path& folder) {
  try {
    return write::state_of_folder(folder) == "running";
  } catch (const FileError&) {
    return false;
  }
}

}  // namespace

void tell_if_unfinished(const std::filesystem::path& folder, bool locked) {
  if (!std::filesystem::exists(folder / "run.toml") || write::says_complete(folder)) return;
  const std::string go_on = fmt::format("gaussdrift resume {} goes on", base::shell_word(folder.string()));
  if (!locked && write::is_in_use(folder))
    note("note: {} is not complete: a process writes into it\n", folder.string());
  else if (says_running(folder))
    note("note: {} is not complete: its process was killed, or could not say how it ended; {}\n", folder.string(),
         go_on);
  else
    note("note: {} is not complete; {}\n", folder.string(), go_on);
}

std::vector<read::WrittenOutput> outputs_of(const std::filesystem::path& place, bool locked) {
  tell_if_unfinished(place, locked);
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
    if (kind.about.is_on_grid && std::find(names.begin(), names.end(), kind.about.name) == names.end())
      names.emplace_back(kind.about.name);
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
