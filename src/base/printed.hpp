// What a value looks like where it is written to a stream.
#pragma once

#include <sstream>
#include <string>

namespace gaussdrift::base {

/// Throws std::bad_alloc where there is no memory. A stream by itself would keep silent, and lose the rest of the text.
template <class Value>
std::string printed(const Value& value) {
  std::ostringstream text;
  text.exceptions(std::ios::badbit);
  text << value;
  return text.str();
}

}  // namespace gaussdrift::base
