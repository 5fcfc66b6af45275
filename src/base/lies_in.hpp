// Folders of strangers: a link in them may lead anywhere.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace gaussdrift::base {

/// Whether `file` lies in `folder`, at any depth, once all links on the way are followed. It need not be there.
inline bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  if (file.native().find('\0') != std::string::npos) return false;
  std::error_code problem;
  const fs::path inside = fs::weakly_canonical(file, problem);
  if (problem) return false;
  const fs::path from_there = inside.lexically_relative(fs::weakly_canonical(folder, problem));
  return !problem && !from_there.empty() && *from_there.begin() != "..";
}

}  // namespace gaussdrift::base
