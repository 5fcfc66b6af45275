#include "cli/outputs_of.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/terminal.hpp"
#include "gaussdrift/error.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::cli {

namespace {

/// Whether the summary of a run says that it is complete; one of an older version does not speak of it.
bool says_complete(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const nlohmann::json summary = nlohmann::json::parse(in, nullptr, false);
  return summary.is_object() && summary.value("complete", true);
}

}  // namespace

void tell_if_unfinished(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / "run.toml") && !says_complete(folder / "summary.json"))
    note("note: {0} is not complete; gaussdrift resume {0} goes on\n", folder.string());
}

std::vector<read::WrittenOutput> outputs_of(const std::filesystem::path& place) {
  tell_if_unfinished(place);
  const std::string_view series = write::density_output().about.name;
  auto outputs = read::written_outputs(place, series);
  if (outputs.empty())
    throw FileError(fmt::format("{} holds no densities: name the folder of a run that wrote vtk = [\"{}\"], or a .vti",
                                place.string(), series));
  return outputs;
}

}  // namespace gaussdrift::cli
