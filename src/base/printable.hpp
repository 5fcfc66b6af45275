// Makes text from files and names safe to print: it must not steer a terminal, forge a line or fill a
// screen.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gaussdrift::base {

/// Control characters and bytes that are not UTF-8 as \x1b; characters that are not seen and turn the direction of
/// writing, or end a line, as \u202e. All else stays, so that printable(printable(text)) == printable(text).
std::string printable(std::string_view text);

/// The same for text of several lines: ends of lines and tabs stay.
std::string printable_lines(std::string_view text);

/// The beginning of `text`: at most so many bytes, not cut within a character, and then "...".
std::string shortened(std::string_view text, std::size_t longest);

/// Text of a file as a message quotes it: printable, in quotation marks, shortened if it is long.
std::string in_quotes(std::string_view text, std::size_t longest = 24);

}  // namespace gaussdrift::base
