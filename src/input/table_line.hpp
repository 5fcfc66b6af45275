// A line of a table cut into its cells: by commas, semicolons, tabs or blanks, with cells in quotation marks.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::input {

enum class Separator { comma, semicolon, tab, blanks };

/// "commas"
const char* name_of(Separator separator);

struct Cell {
  std::string_view text;  // without blanks around it, and without its quotation marks
  bool quoted = false;
};

/// What separates the cells of a line: the first of comma, semicolon, tab and blank that it has outside of quotation
/// marks. Nothing if the line has one cell.
std::optional<Separator> separator_in(std::string_view line);

/// A cell is quoted if it begins with a quotation mark and another one is its end; within it separators are letters. Any
/// number of blanks separate cells where blanks do, and none at the ends of the line.
std::vector<Cell> cells_of(std::string_view line, Separator separator);

/// The text of a quoted cell, in which two quotation marks stand for one.
std::string unquoted(const Cell& cell);

/// Without blanks and tabs around it.
std::string_view trimmed(std::string_view text);

/// The lines of a text one after the other, without their ends (LF or CRLF).
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  bool next(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos) end = text_.size();
    line = text_.substr(at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = end + 1;
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; }  // of the line that next() gave last, from 1

 private:
  std::string_view text_;
  std::size_t at_ = 0, number_ = 0;
};

}  // namespace gaussdrift::input
