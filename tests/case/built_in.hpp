// The cases of cases/.
#pragma once

#include <string>
#include <vector>

#include "gaussdrift/read_case.hpp"

namespace gaussdrift {

inline Case built_in(const std::string& name, const std::vector<std::string>& overrides) {
  return read_case(SOURCE_DIR "/cases/" + name + ".toml", overrides).spec;
}

}  // namespace gaussdrift
