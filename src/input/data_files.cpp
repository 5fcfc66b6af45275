// The files besides the case file that a run depends on.
#include "input/data_files.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "base/json_file.hpp"
#include "gaussdrift/error.hpp"
#include "read/grid_file.hpp"

namespace gaussdrift::input {

namespace {

template <class Spec>
void add_file(const Spec& spec, std::vector<std::filesystem::path>& files) {
  if constexpr (requires { spec.file; }) {
    for (const std::filesystem::path& file : read::files_of_pattern(spec.file)) files.push_back(file);
    std::error_code error;
    if (spec.file.extension() == ".pvd")
      for (const read::SeriesEntry& entry : read::read_series(spec.file, false))
        if (std::filesystem::exists(entry.file, error)) files.push_back(entry.file);
  }
}

/// As provenance.json of a run tells; empty where it does not. The file may be a stranger's.
std::filesystem::path told_path(const std::filesystem::path& folder, const std::string& name) {
  std::optional<nlohmann::ordered_json> told;
  try {
    told = base::json_if_there(folder / "provenance.json", base::most_json_of_names, "");
  } catch (const FileError&) {  // then nothing is known of the data
  }
  if (!told) return {};
  const auto paths = told->find("data_paths");
  if (paths == told->end() || !paths->is_object()) return {};
  const auto path = paths->find(name);
  return path != paths->end() && path->is_string() ? path->get<std::string>() : std::string();
}

}  // namespace

std::filesystem::path find_data_file(const std::filesystem::path& case_folder, const std::string& name) {
  const auto named = std::filesystem::absolute(case_folder / name).lexically_normal();
  std::error_code error;
  if (std::filesystem::exists(named, error)) return named;
  const std::filesystem::path told = told_path(case_folder, name);
  return !told.empty() && std::filesystem::exists(told, error) ? told : named;
}

std::string where_data_file_was(const std::filesystem::path& case_folder, const std::string& name) {
  const std::filesystem::path told = told_path(case_folder, name);
  std::error_code error;
  if (told.empty() || std::filesystem::exists(find_data_file(case_folder, name), error)) return "";
  return fmt::format("this is the case of a run, and when the run began the file was {}; put it there again",
                     told.string());
}

std::vector<std::filesystem::path> data_files(const Case& spec) {
  std::vector<std::filesystem::path> files;
  for (const auto& part : spec.velocity) std::visit([&](const auto& one) { add_file(one, files); }, part);
  for (const auto& part : spec.density) std::visit([&](const auto& one) { add_file(one, files); }, part);
  for (const auto& part : spec.sources) std::visit([&](const auto& one) { add_file(one, files); }, part.what);
  for (const EffectSpec& effect : spec.effects.list)
    if (effect.file) add_file(*effect.file, files);
  return files;
}

Case with_bare_names(Case spec) {
  const auto shorten = [](auto& one) {
    if constexpr (requires { one.file; }) one.file = one.file.filename();
  };
  for (auto& part : spec.velocity) std::visit(shorten, part);
  for (auto& part : spec.density) std::visit(shorten, part);
  for (auto& part : spec.sources) std::visit(shorten, part.what);
  for (EffectSpec& effect : spec.effects.list)
    if (effect.file) shorten(*effect.file);
  return spec;
}

std::filesystem::path seen_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code error;
  // Links are followed. Absolute, for of a folder that is yet to be made the first parts may be all that there is.
  const std::filesystem::path relative = std::filesystem::relative(file, std::filesystem::absolute(folder), error);
  return error || relative.empty() ? std::filesystem::absolute(file) : relative;
}

}  // namespace gaussdrift::input
