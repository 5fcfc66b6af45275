// Refuses names of results whose ending asks for a kind of file that is not written, and says what is possible.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

/// The ending in small letters if it is that of data, pictures or documents; else nothing.
inline std::string known_ending(const std::filesystem::path& name) {
  constexpr std::array<std::string_view, 30> known{".nc",  ".nc4",  ".h5",  ".hdf5", ".vti",  ".vtr",  ".vtp", ".vtu",
                                                   ".vtk", ".vts",  ".pvd", ".csv",  ".txt",  ".json", ".png", ".jpg",
                                                   ".gif", ".jpeg", ".tif", ".bmp",  ".svg",  ".tiff", ".pdf", ".mp4",
                                                   ".avi", ".npy",  ".npz", ".html", ".pvti", ".pvtp"};
  std::string ending = name.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(known.begin(), known.end(), ending) != known.end() ? ending : "";
}

/// For results that fill a folder. A folder that exists may have any name.
inline void check_folder_name(const std::filesystem::path& out, std::string_view what) {
  std::error_code error;
  if (known_ending(out).empty() || std::filesystem::is_directory(out, error)) return;
  throw CommandLineError(fmt::format("--out {}: {}; give the name of a folder, such as {}", out.string(), what,
                                     std::filesystem::path(out).replace_extension().string()));
}

}  // namespace gaussdrift::cli
