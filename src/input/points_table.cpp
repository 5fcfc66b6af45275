// The reader of tables: lines are cut at commas, cells trimmed, numbers read without regard to the locale.
#include "input/points_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/suggest.hpp"
#include "base/text_file.hpp"

namespace gaussdrift::input {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view weight_name = "weight";
constexpr std::size_t largest_dimension = 4;  // of fgtd
constexpr std::string_view blanks = " \t";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// For messages: long cells are cut, bytes that would disturb a terminal are replaced.
std::string quoted(std::string_view cell) {
  constexpr std::size_t longest = 40;
  std::string text = "\"";
  for (const char c : cell.substr(0, longest)) text += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  return text + (cell.size() > longest ? "...\"" : "\"");
}

const char* word(PointsRole role) { return role == PointsRole::sources ? "sources" : "targets"; }

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
  bool only_blank_left() const {
    return text_.find_first_not_of(" \t\r\n", std::min(at_, text_.size())) == std::string_view::npos;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0, number_ = 0;
};

struct Header {
  std::vector<std::string> names;  // of all columns
  std::size_t weight = none;       // its column
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
};

class Parser {
 public:
  Parser(std::string_view text, const std::string& name, PointsRole role, std::size_t memory_limit)
      : text_(text), name_(name), role_(role), memory_limit_(memory_limit) {}
  /// A table of these columns instead; all are read as coordinates.
  Parser(std::string_view text, const std::string& name, const std::vector<std::string>& expected,
         std::size_t memory_limit)
      : text_(text), name_(name), role_(PointsRole::targets), expected_(expected), memory_limit_(memory_limit) {}

  PointsTable parse() {
    check_encoding();
    Lines lines(text_);
    std::string_view line;
    if (lines.only_blank_left() || !lines.next(line))
      throw InputError(fmt::format("{} is empty; it must have a header line and a line for every point", name_));
    read_header(line);
    reserve();
    while (lines.next(line)) {
      if (trimmed(line).empty()) {
        if (lines.only_blank_left()) break;
        fail(lines.number(), 1, "the line is blank, and points follow; remove it");
      }
      read_row(line, lines.number());
    }
    if (table_.positions.empty())
      throw InputError(fmt::format("{}:{}: no points follow the header line", name_, lines.number()));
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(std::size_t line, std::size_t column, const std::string& what) const {
    throw InputError(fmt::format("{}:{}:{}: {}", name_, line, column, what));
  }
  std::size_t column_of(std::string_view line, std::string_view cell) const {
    return static_cast<std::size_t>(cell.data() - line.data()) + 1;  // in bytes
  }

  void check_encoding() {
    constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
    if (text_.substr(0, 3) == utf8_mark) text_.remove_prefix(3);
    if (text_.substr(0, 2) == "\xFF\xFE" || text_.substr(0, 2) == "\xFE\xFF")
      fail(1, 1, "the file is UTF-16; save it as UTF-8");
  }

  void read_header(std::string_view line) {
    std::size_t begin = 0;
    while (true) {
      const std::size_t comma = line.find(',', begin);
      add_column(line, trimmed(line.substr(begin, comma == std::string_view::npos ? comma : comma - begin)));
      if (comma == std::string_view::npos) break;
      begin = comma + 1;
    }
    for (const std::string& wanted : expected_)
      if (std::find(header_.names.begin(), header_.names.end(), wanted) == header_.names.end())
        fail(1, 1,
             fmt::format("there is no column \"{}\" among {}; the columns must be {}", wanted,
                         fmt::join(header_.names, ", "), fmt::join(expected_, ",")));
    if (role_ == PointsRole::sources && header_.weight == Header::none) {
      const auto meant = base::suggest(weight_name, header_.names);
      fail(1, 1,
           fmt::format("there is no column \"weight\" among {}; {}", fmt::join(header_.names, ", "),
                       meant ? fmt::format("is \"{}\" meant?", *meant)
                             : std::string("add one, with 1 in every line if all sources count the same")));
    }
    if (table_.coordinates.empty())
      fail(1, 1, fmt::format("there are no coordinates; {} have 1 to {}", word(role_), largest_dimension));
  }

  void add_column(std::string_view line, std::string_view cell) {
    const std::size_t column = column_of(line, cell);
    std::string_view name = cell;
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    if (name.empty()) fail(1, column, fmt::format("column {} has no name", header_.names.size() + 1));
    double number = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), number).ptr == name.data() + name.size())
      fail(1, column, fmt::format("{} is a number; the first line must name the columns", quoted(name)));
    if (name.find_first_of(";\t\"") != std::string_view::npos)
      fail(1, column, fmt::format("{} is not the name of a column; columns are separated by commas", quoted(name)));
    if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }))
      fail(1, column, fmt::format("{} is not the name of a column; the file must be plain text", quoted(name)));
    if (std::find(header_.names.begin(), header_.names.end(), name) != header_.names.end())
      fail(1, column, fmt::format("column {} is there twice", quoted(name)));
    if (!expected_.empty()) {
      if (std::find(expected_.begin(), expected_.end(), name) == expected_.end())
        fail(1, column,
             fmt::format("column {} is not one of those that are wanted; the columns must be {}", quoted(name),
                         fmt::join(expected_, ",")));
      table_.coordinates.emplace_back(name);
    } else if (name == weight_name) {
      if (role_ == PointsRole::targets) fail(1, column, "targets have coordinates only; remove the column \"weight\"");
      header_.weight = header_.names.size();
    } else {
      if (table_.coordinates.size() == largest_dimension)
        fail(1, column,
             fmt::format("{} would be coordinate {}; {} have 1 to {}{}", quoted(name), largest_dimension + 1,
                         word(role_), largest_dimension,
                         role_ == PointsRole::sources ? " and a column \"weight\", nothing else" : ", nothing else"));
      table_.coordinates.emplace_back(name);
    }
    header_.names.emplace_back(name);
  }

  // One allocation for all numbers, refused if it is too large.
  void reserve() {
    const std::size_t lines = static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '\n'));
    const double bytes = static_cast<double>(text_.size()) +
                         static_cast<double>(lines) * static_cast<double>(header_.names.size() * sizeof(double));
    if (bytes > static_cast<double>(memory_limit_))
      throw InputError(fmt::format("{} has about {} lines and would take {:.1f} GB to read; at most {:.1f} GB are used",
                                   name_, lines, bytes / 1e9, static_cast<double>(memory_limit_) / 1e9));
    table_.positions.reserve(lines * table_.coordinates.size());
    if (header_.weight != Header::none) table_.weights.reserve(lines);
  }

  void read_row(std::string_view line, std::size_t number) {
    const std::size_t columns = header_.names.size();
    std::size_t begin = 0;
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t comma = line.find(',', begin);
      const bool last = comma == std::string_view::npos;
      if (last != (k + 1 == columns)) {
        const auto cells = static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
        fail(number, (last ? line.size() : comma) + 1,
             fmt::format("{} {} where the header names {} columns ({})", cells, cells == 1 ? "value" : "values",
                         columns, fmt::join(header_.names, ", ")));
      }
      const std::string_view cell = trimmed(line.substr(begin, last ? comma : comma - begin));
      (k == header_.weight ? table_.weights : table_.positions).push_back(value(line, cell, number, k));
      begin = comma + 1;
    }
  }

  double value(std::string_view line, std::string_view cell, std::size_t number, std::size_t k) const {
    const char* begin = cell.data();
    const char* const end = cell.data() + cell.size();
    if (cell.size() > 1 && *begin == '+' && begin[1] != '-') ++begin;
    double result = 0;
    const auto [rest, error] = std::from_chars(begin, end, result);
    if (error == std::errc() && rest == end && std::isfinite(result)) return result;

    const auto refuse = [&](const std::string& what) {
      fail(number, column_of(line, cell), fmt::format("{} in column \"{}\"", what, header_.names[k]));
    };
    if (cell.empty()) refuse("there is no value");
    if (error == std::errc() && rest == end) refuse(fmt::format("{} is not finite", cell));
    if (error == std::errc::result_out_of_range && rest == end)
      refuse(fmt::format("{} is outside the range of double precision", quoted(cell)));
    refuse(fmt::format("{} is not a number", quoted(cell)));
    return 0;  // not reached
  }

  std::string_view text_;
  const std::string& name_;
  PointsRole role_;
  std::vector<std::string> expected_;
  std::size_t memory_limit_;
  Header header_;
  PointsTable table_;
};

std::string read_text(const fs::path& file, std::size_t memory_limit) {
  return base::read_text_file(file, "a table of points (CSV)", memory_limit);
}

}  // namespace

PointsTable parse_points_table(std::string_view text, const std::string& name, PointsRole role,
                               std::size_t memory_limit) {
  return Parser(text, name, role, memory_limit).parse();
}

PointsTable read_points_table(const fs::path& file, PointsRole role, std::size_t memory_limit) {
  return parse_points_table(read_text(file, memory_limit), file.string(), role, memory_limit);
}

std::vector<double> parse_named_columns(std::string_view text, const std::string& name,
                                        const std::vector<std::string>& names, std::size_t memory_limit) {
  const PointsTable table = Parser(text, name, names, memory_limit).parse();
  const std::size_t columns = names.size();
  std::vector<std::size_t> from(columns);
  for (std::size_t k = 0; k < columns; ++k)
    from[k] = static_cast<std::size_t>(std::find(table.coordinates.begin(), table.coordinates.end(), names[k]) -
                                       table.coordinates.begin());
  std::vector<double> rows(table.positions.size());
  for (std::size_t row = 0; row < rows.size(); row += columns)
    for (std::size_t k = 0; k < columns; ++k) rows[row + k] = table.positions[row + from[k]];
  return rows;
}

std::vector<double> read_named_columns(const fs::path& file, const std::vector<std::string>& names,
                                       std::size_t memory_limit) {
  return parse_named_columns(read_text(file, memory_limit), file.string(), names, memory_limit);
}

}  // namespace gaussdrift::input
