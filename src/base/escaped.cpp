#include "base/escaped.hpp"

#include "base/printable.hpp"

namespace gaussdrift::base {

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : printable_lines(text)) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

}  // namespace gaussdrift::base
