// Text as part of HTML, SVG or XML.
#pragma once

#include <string>
#include <string_view>

namespace gaussdrift::base {

/// What means something there is written as an entity, and what is not printable (printable.hpp) as it is printed.
std::string escaped(std::string_view text);

}  // namespace gaussdrift::base
