#include "base/shell_word.hpp"

#include "base/printable.hpp"

namespace gaussdrift::base {

std::string shell_word(std::string_view text) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-";
  if (!text.empty() && text.find_first_not_of(plain) == text.npos) return std::string(text);
  if (printable(text) == text) {
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
    return word + "'";
  }
  std::string word = "$'";
  for (const char c : text) {
    constexpr std::string_view digits = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\'' || c == '\\')
      word += std::string("\\") + c;
    else if (byte >= 0x20 && byte < 0x7f)
      word += c;
    else  // always two digits, so that a digit may follow
      word += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
  }
  return word + "'";
}

}  // namespace gaussdrift::base
