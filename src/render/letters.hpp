// How much room a line of text takes, without a font: charts are laid out before it is known who draws them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gaussdrift::render {

/// The code points of a text; a byte that is no UTF-8 counts as a question mark, a control character as a blank.
std::vector<char32_t> code_points(const std::string& text);
std::string utf8(char32_t code);
/// The same text with nothing in it that is no UTF-8 or cannot be seen. Ends of lines stay.
std::string well_formed(const std::string& text);

/// Width in pixels of one line in DejaVu Sans, whose letters are wider than those of most fonts.
double letters_width(const std::string& text, double size);
/// In Helvetica.
double narrow_letters_width(const std::string& text, double size);

/// The digit or sign that stands raised for this code point, as in 10⁻³; 0: it is no such.
char32_t raised(char32_t code);

/// The text in lines of at most `width` pixels, broken at blanks. A longer word is a line of its own.
std::vector<std::string> broken(const std::string& text, double width, double size);

}  // namespace gaussdrift::render
