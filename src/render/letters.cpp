#include "render/letters.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace gaussdrift::render {
namespace {

// Thousandths of the size, of the letters from ' ' to '~'. From the fonts' own tables of advances.
using Widths = std::array<int, 95>;
constexpr Widths dejavu{318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
                        636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
                        575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
                        611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
                        278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};
constexpr Widths helvetica{278,  278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
                           556,  556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
                           1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
                           667,  778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
                           333,  556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
                           556,  556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584};

/// Of others: those of DejaVu Sans, or a little more.
int width_of_rare(char32_t code) {
  if (code == 0xB7) return 318;
  if (raised(code)) return raised(code) == U'-' || raised(code) == U'+' ? 528 : 401;
  if (code >= 0x2200 && code < 0x2300) return 838;  // signs of mathematics
  if (code == 0x2014 || code == 0x2026 || code >= 0x2E80) return 1000;
  if (code == 0xD7 || code == 0xB1 || (code >= 0x2190 && code < 0x2200)) return 838;
  return code >= 0x400 && code < 0x2000 ? 900 : 680;
}

double width(const std::string& text, double size, const Widths& widths, double rare) {
  double sum = 0;
  for (const char32_t code : code_points(text))
    sum += code >= U' ' && code <= U'~' ? widths[static_cast<std::size_t>(code - U' ')] : rare * width_of_rare(code);
  return 1e-3 * size * sum;
}

}  // namespace

std::vector<char32_t> code_points(const std::string& text) {
  std::vector<char32_t> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80                   ? 1
                               : byte >= 0xC2 && byte < 0xE0 ? 2
                               : byte >= 0xE0 && byte < 0xF0 ? 3
                               : byte >= 0xF0 && byte < 0xF5 ? 4
                                                             : 0;
    char32_t code = length == 1 ? byte : length == 0 ? 0 : byte & (0x7F >> length);
    bool whole = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; whole && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      whole = (next & 0xC0) == 0x80;
      code = code << 6 | (next & 0x3F);
    }
    const bool forbidden = (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF || code == 0xFFFE || code == 0xFFFF;
    codes.push_back(!whole || forbidden ? U'?' : code < 0x20 || (code >= 0x7F && code < 0xA0) ? U' ' : code);
    i += whole ? length : 1;
  }
  return codes;
}

std::string utf8(char32_t code) {
  const auto byte = [](char32_t bits) { return static_cast<char>(static_cast<unsigned char>(bits)); };
  if (code < 0x80) return {byte(code)};
  if (code < 0x800) return {byte(0xC0 | code >> 6), byte(0x80 | (code & 0x3F))};
  if (code < 0x10000) return {byte(0xE0 | code >> 12), byte(0x80 | (code >> 6 & 0x3F)), byte(0x80 | (code & 0x3F))};
  return {byte(0xF0 | code >> 18), byte(0x80 | (code >> 12 & 0x3F)), byte(0x80 | (code >> 6 & 0x3F)),
          byte(0x80 | (code & 0x3F))};
}

std::string well_formed(const std::string& text) {
  std::string clean;
  for (std::size_t i = 0, end = 0; end != text.npos; i = end + 1) {
    end = text.find('\n', i);
    if (i > 0) clean += '\n';
    for (const char32_t code : code_points(text.substr(i, end == text.npos ? end : end - i))) clean += utf8(code);
  }
  return clean;
}

double letters_width(const std::string& text, double size) { return width(text, size, dejavu, 1); }

// Raised letters are small ones there, 0.7 times as large.
double narrow_letters_width(const std::string& text, double size) { return width(text, size, helvetica, 0.9); }

char32_t raised(char32_t code) {
  constexpr std::u32string_view up = U"⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", plain = U"0123456789-+";
  const std::size_t at = up.find(code);
  return at == up.npos ? 0 : plain[at];
}

std::vector<std::string> broken(const std::string& text, double width, double size) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find(' ', i), text.size());
    const std::string word = text.substr(i, end - i);
    if (!line.empty() && letters_width(line + " " + word, size) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line += (line.empty() ? "" : " ") + word;
    }
    i = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

}  // namespace gaussdrift::render
