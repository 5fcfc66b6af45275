// The files of cases/, part of the program: what `gaussdrift new` lists and writes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::input {

struct ExampleFile {
  std::string_view name;   // "rotating_cone.toml"
  std::string_view bytes;  // as it stands in cases/
};

/// Cases and the data that they read, in alphabetical order. Generated from cases/ by cmake/EmbedFiles.cmake.
const std::vector<ExampleFile>& example_files();

}  // namespace gaussdrift::input
