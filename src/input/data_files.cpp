// The files besides the case file that a run depends on.
#include "input/data_files.hpp"

#include "read/grid_file.hpp"

namespace gaussdrift::input {

namespace {

template <class Spec>
void add_file(const Spec& spec, std::vector<std::filesystem::path>& files) {
  if constexpr (requires { spec.file; }) {
    files.push_back(spec.file);
    if (spec.file.extension() == ".pvd")
      for (const read::SeriesEntry& entry : read::read_series(spec.file)) files.push_back(entry.file);
  }
}

}  // namespace

std::vector<std::filesystem::path> data_files(const Case& spec) {
  std::vector<std::filesystem::path> files;
  for (const auto& part : spec.velocity) std::visit([&](const auto& one) { add_file(one, files); }, part);
  for (const auto& part : spec.density) std::visit([&](const auto& one) { add_file(one, files); }, part);
  return files;
}

Case with_bare_names(Case spec) {
  const auto shorten = [](auto& one) {
    if constexpr (requires { one.file; }) one.file = one.file.filename();
  };
  for (auto& part : spec.velocity) std::visit(shorten, part);
  for (auto& part : spec.density) std::visit(shorten, part);
  return spec;
}

std::filesystem::path seen_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code error;
  // Links are followed. Absolute, for of a folder that is yet to be made the first parts may be all that there is.
  const std::filesystem::path relative = std::filesystem::relative(file, std::filesystem::absolute(folder), error);
  return error || relative.empty() ? std::filesystem::absolute(file) : relative;
}

}  // namespace gaussdrift::input
