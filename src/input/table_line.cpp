#include "input/table_line.hpp"

#include <algorithm>
#include <array>

namespace gaussdrift::input {

namespace {

constexpr std::string_view blanks = " \t";
constexpr std::size_t none = std::string_view::npos;

char letter_of(Separator separator) {
  return separator == Separator::comma ? ',' : separator == Separator::semicolon ? ';' : '\t';
}

/// Blanks that do not separate cells.
std::string_view padding_of(Separator separator) { return separator == Separator::tab ? " " : blanks; }

std::size_t skip(std::string_view line, std::size_t at, std::string_view letters) {
  const std::size_t found = line.find_first_not_of(letters, at);
  return found == none ? line.size() : found;
}

/// Where the quotation mark stands that ends what begins with one at `begin`.
std::size_t closing(std::string_view line, std::size_t begin) {
  for (std::size_t at = begin + 1; at < line.size(); ++at) {
    if (line[at] != '"') continue;
    if (at + 1 >= line.size() || line[at + 1] != '"') return at;
    ++at;
  }
  return none;
}

/// Cuts one cell off; `at` comes behind it, and to where a separator is, or the end.
Cell take_cell(std::string_view line, std::size_t& at, Separator separator) {
  const bool by_blanks = separator == Separator::blanks;
  const auto ends = [&](std::size_t place) {
    return place >= line.size() || (by_blanks ? blanks.find(line[place]) != none : line[place] == letter_of(separator));
  };
  const std::size_t begin = skip(line, at, padding_of(separator));
  if (begin < line.size() && line[begin] == '"')
    if (const std::size_t end = closing(line, begin); end != none) {
      const std::size_t behind = by_blanks ? end + 1 : skip(line, end + 1, padding_of(separator));
      if (ends(behind)) {
        at = behind;
        return {trimmed(line.substr(begin + 1, end - begin - 1)), true};
      }
    }
  std::size_t end = by_blanks ? line.find_first_of(blanks, begin) : line.find(letter_of(separator), at);
  if (end == none) end = line.size();
  const std::string_view whole = line.substr(at, end - at);
  at = end;
  return {trimmed(whole), false};
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == none) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

const char* name_of(Separator separator) {
  switch (separator) {
    case Separator::comma:
      return "commas";
    case Separator::semicolon:
      return "semicolons";
    case Separator::tab:
      return "tabs";
    case Separator::blanks:
      return "blanks";
  }
  return "";
}

std::optional<Separator> separator_in(std::string_view line) {
  constexpr std::string_view letters = ",;\t ";
  constexpr std::array<Separator, 4> separators{Separator::comma, Separator::semicolon, Separator::tab,
                                                Separator::blanks};
  const std::string_view inner = trimmed(line);
  std::size_t best = none;
  bool cell_begins = true;
  for (std::size_t at = 0; at < inner.size(); ++at) {
    const std::size_t which = letters.find(inner[at]);
    if (which != none) best = std::min(best, which);
    if (cell_begins && inner[at] == '"')
      if (const std::size_t end = closing(inner, at); end != none) at = end;
    cell_begins = which != none;
  }
  return best == none ? std::nullopt : std::optional(separators[best]);
}

std::vector<Cell> cells_of(std::string_view line, Separator separator) {
  std::vector<Cell> cells;
  std::size_t at = 0;
  if (separator == Separator::blanks) {
    while (skip(line, at, blanks) < line.size()) cells.push_back(take_cell(line, at, separator));
    return cells;
  }
  while (true) {
    cells.push_back(take_cell(line, at, separator));
    if (at >= line.size()) return cells;
    ++at;
  }
}

std::string unquoted(const Cell& cell) {
  std::string text(cell.text);
  if (cell.quoted)
    for (std::size_t at = 0; (at = text.find("\"\"", at)) != std::string::npos; ++at) text.erase(at, 1);
  return text;
}

}  // namespace gaussdrift::input
