// "1 frame", "2 frames".
#pragma once

#include <cstddef>
#include <string>

namespace gaussdrift::base {

/// A number that is already written, before its thing: plural but for "1".
inline std::string counted(const std::string& number, const char* thing) {
  return number + " " + thing + (number == "1" ? "" : "s");
}
inline std::string counted(std::size_t number, const char* thing) { return counted(std::to_string(number), thing); }

}  // namespace gaussdrift::base
