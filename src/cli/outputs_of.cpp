#include "cli/outputs_of.hpp"

#include <fmt/format.h>

#include "cli/terminal.hpp"
#include "gaussdrift/error.hpp"
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

}  // namespace gaussdrift::cli
