#include "cli/outputs_of.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/terminal.hpp"
#include "gaussdrift/error.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::cli {

bool says_complete(const std::filesystem::path& folder) {
  std::ifstream in(folder / "summary.json", std::ios::binary);
  const nlohmann::json summary = nlohmann::json::parse(in, nullptr, false);
  if (!summary.is_object()) return false;
  const auto complete = summary.find("complete");
  return complete == summary.end() || *complete == true;
}

void tell_if_unfinished(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / "run.toml") && !says_complete(folder))
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
