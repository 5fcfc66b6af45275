// Names in the folder of a run or of other results, and how a folder is refused.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "gaussdrift/error.hpp"

namespace gaussdrift::write {

inline constexpr const char* status_name = "status.json";
inline constexpr const char* earlier_name = "earlier";

[[noreturn]] inline void refuse(const std::filesystem::path& folder, const std::string& what) {
  throw FileError(
      fmt::format("cannot use {} as output folder: {}; choose another folder with --out", folder.string(), what));
}

}  // namespace gaussdrift::write
