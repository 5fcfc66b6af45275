// Names of several files: wind_*.nc.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "read/grid_file.hpp"

namespace gaussdrift::read {

namespace {

constexpr std::size_t most_files = 100'000;

/// `*` stands for any letters, `?` for one.
bool fits(std::string_view name, std::string_view pattern) {
  std::size_t at = 0, in_pattern = 0, star = std::string_view::npos, from = 0;
  while (at < name.size()) {
    if (in_pattern < pattern.size() && (pattern[in_pattern] == '?' || pattern[in_pattern] == name[at]) &&
        pattern[in_pattern] != '*') {
      ++at, ++in_pattern;
    } else if (in_pattern < pattern.size() && pattern[in_pattern] == '*') {
      star = in_pattern++;
      from = at;
    } else if (star != std::string_view::npos) {
      in_pattern = star + 1;
      at = ++from;
    } else {
      return false;
    }
  }
  return std::all_of(pattern.begin() + static_cast<std::ptrdiff_t>(in_pattern), pattern.end(),
                     [](char c) { return c == '*'; });
}

}  // namespace

std::vector<std::filesystem::path> files_of_pattern(const std::filesystem::path& file) {
  const std::string pattern = file.filename().string();
  std::error_code error;
  if (pattern.find_first_of("*?") == std::string::npos || std::filesystem::exists(file, error)) return {file};
  const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!fits(entry->path().filename().string(), pattern)) continue;
    if (files.size() == most_files)
      throw GridFileError(fmt::format("more than {} files are called {}", most_files, pattern));
    files.push_back(entry->path());
  }
  if (files.empty())
    throw GridFileError(fmt::format("there is no file {} in {}", pattern, folder.string()),
                        "paths are relative to the folder of the case file; * stands for any letters, ? for one");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace gaussdrift::read
