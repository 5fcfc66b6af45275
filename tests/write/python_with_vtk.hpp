// VTK's own readers, in Python, for tests of what is written for them.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace gaussdrift::write {

/// Debian's Python has VTK; one found earlier in PATH may not.
inline std::string python_with_vtk() {
  for (const std::string python : {"/usr/bin/python3", "python3"})
    if (std::system((python + " -c 'import vtkmodules.vtkIOXML' 2>/dev/null").c_str()) == 0) return python;
  return "";
}

inline std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t length = std::fread(buffer.data(), 1, buffer.size(), pipe))
    text.append(buffer.data(), length);
  return pclose(pipe) == 0 ? text : "failed: " + text;
}

inline std::string read_series(const std::string& python, const std::filesystem::path& pvd) {
  return output_of(python + " " SOURCE_DIR "/tests/write/read_series.py '" + pvd.string() + "' 2>&1");
}

}  // namespace gaussdrift::write
