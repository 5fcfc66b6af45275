#include "base/printable.hpp"

namespace gaussdrift::base {
namespace {

std::string hexadecimal(unsigned number, int digits) {
  std::string text;
  for (int k = digits - 1; k >= 0; --k) text += "0123456789abcdef"[number >> 4 * k & 0xF];
  return text;
}

/// Length of the UTF-8 character that `text` begins with, and its number; length 0 if there is none: overlong forms,
/// halves of pairs and numbers beyond Unicode are none.
struct Character {
  std::size_t length = 0;
  unsigned code = 0;
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {1, lead};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return {};
  unsigned code = lead & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return {};
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  constexpr unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < least[length] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
  return {length, code};
}

/// The last control characters, ends of lines, marks of direction, the byte-order mark: those that JSON leaves as they
/// are, so that its text stays JSON.
bool is_unseen(unsigned code) {
  return (code >= 0x7F && code < 0xA0) || code == 0x061C || (code >= 0x200E && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF;
}

std::string shown(std::string_view text, bool lines) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const auto [length, code] = first_character(text);
    const bool control = code < 0x20;
    if (length == 0 || (control && !(lines && (code == '\n' || code == '\t'))))
      result += "\\x" + hexadecimal(static_cast<unsigned char>(text[0]), 2);
    else if (is_unseen(code))
      result += "\\u" + hexadecimal(code, 4);
    else
      result += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result;
}

}  // namespace

std::string printable(std::string_view text) { return shown(text, false); }

std::string printable_lines(std::string_view text) { return shown(text, true); }

std::string shortened(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return std::string(text);
  std::size_t end = longest;
  while (end + 3 > longest && end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "...";
}

std::string in_quotes(std::string_view text, std::size_t longest) {
  return '"' + printable(shortened(text, longest)) + '"';
}

}  // namespace gaussdrift::base
