#include "cli/outputs_of.hpp"

#include <fmt/format.h>

#include "gaussdrift/error.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::cli {

std::vector<read::WrittenOutput> outputs_of(const std::filesystem::path& place) {
  const std::string_view series = write::density_output().about.name;
  auto outputs = read::written_outputs(place, series);
  if (outputs.empty())
    throw FileError(fmt::format("{} holds no densities: name the folder of a run that wrote vtk = [\"{}\"], or a .vti",
                                place.string(), series));
  return outputs;
}

}  // namespace gaussdrift::cli
