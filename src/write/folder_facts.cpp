#include "write/folder_facts.hpp"

#include <fmt/format.h>

#include "base/json_file.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

/// A member of a file, a text; empty where there is none of them.
std::string text_in(const fs::path& file, std::size_t most_bytes, const char* member) {
  constexpr const char* remedy = "remove it: resume goes on without it";
  const auto object = base::json_if_there(file, most_bytes, remedy);
  if (!object || !object->contains(member)) return "";
  const nlohmann::ordered_json& value = object->at(member);
  if (!value.is_string())
    throw FileError(fmt::format("{} is damaged: {} is no text; {}", file.string(), member, remedy));
  return value.get<std::string>();
}

}  // namespace

bool says_complete(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  constexpr const char* remedy =
      "run the case again, or remove the file: gaussdrift resume then goes on from the last checkpoint";
  const auto summary = base::json_if_there(file, base::most_json_of_numbers, remedy);
  if (!summary) return false;
  const auto complete = summary->find("complete");
  if (complete == summary->end()) return true;
  if (!complete->is_boolean())
    throw FileError(fmt::format("{} is damaged: complete is neither true nor false; {}", file.string(), remedy));
  return complete->get<bool>();
}

std::string state_of_folder(const fs::path& folder) {
  return text_in(folder / "status.json", base::most_json_of_names, "state");
}

std::size_t outputs_of_folder(const fs::path& folder) {
  const auto status =
      base::json_if_there(folder / "status.json", base::most_json_of_names, "remove it: resume goes on without it");
  const auto outputs = status ? status->value("outputs", nlohmann::ordered_json()) : nlohmann::ordered_json();
  return outputs.is_number_unsigned() ? outputs.get<std::size_t>() : 0;
}

std::string name_of_run(const fs::path& folder) {
  return text_in(folder / "provenance.json", base::most_json_of_numbers, "name");
}

OwnFiles files_of_study(const fs::path& folder) {
  OwnFiles files({"study.html", "study.json", "study.md"});
  const fs::path list = folder / "study.json";
  constexpr const char* remedy =
      "what the earlier study wrote is not known; move its files away, or choose another folder with --out";
  const auto told = base::json_if_there(list, base::most_json_of_numbers, remedy);
  if (!told) return files;
  try {
    for (const auto& experiment : told->at("experiments"))
      for (const char* ending : {".csv", ".pdf", ".png", ".svg"})
        files.add(experiment.at("name").get<std::string>() + ending);
  } catch (const nlohmann::json::exception&) {
    throw FileError(fmt::format("{} is damaged: it has no list of experiments; {}", list.string(), remedy));
  }
  return files;
}

}  // namespace gaussdrift::write
