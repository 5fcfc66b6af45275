// The reader of tables: lines are cut at commas, cells trimmed, lines that begin with # left out.
#include "input/points_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "base/printable.hpp"
#include "base/suggest.hpp"
#include "base/text_file.hpp"
#include "gaussdrift/error.hpp"
#include "input/column_names.hpp"
#include "input/foreign_format.hpp"
#include "input/table_number.hpp"

namespace gaussdrift::input {

namespace fs = std::filesystem;

namespace {

using base::in_quotes;

constexpr std::string_view weight_name = "weight";
constexpr std::size_t largest_dimension = 4;  // of fgtd
constexpr std::string_view blanks = " \t";
constexpr std::size_t none = static_cast<std::size_t>(-1);

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

const char* word(PointsRole role) { return role == PointsRole::sources ? "sources" : "targets"; }

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_number(std::string_view text) { return read_cell(text).value.has_value(); }

/// The separator of a line without commas; empty if the line has one value.
std::string_view separator_of(std::string_view line) {
  const std::string_view inner = trimmed(line);
  if (inner.find(';') != std::string_view::npos) return "semicolons";
  if (inner.find('\t') != std::string_view::npos) return "tabs";
  if (inner.find(' ') != std::string_view::npos) return "blanks";
  return {};
}

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

class Parser {
 public:
  /// Points, of these coordinates or of all columns but the weight.
  Parser(std::string_view text, const std::string& name, PointsRole role, std::vector<std::string> coordinates,
         std::size_t memory_limit)
      : text_(text), name_(name), role_(role), wanted_(std::move(coordinates)), memory_limit_(memory_limit) {}
  /// A table of these columns and no others; all are read as coordinates.
  Parser(std::string_view text, const std::string& name, std::vector<std::string> exactly, std::size_t memory_limit)
      : Parser(text, name, PointsRole::targets, std::move(exactly), memory_limit) {
    exactly_ = true;
  }

  PointsTable parse() {
    check_format();
    Lines lines(text_);
    std::string_view line;
    std::string_view comment;  // the last before the names
    std::size_t comment_number = 0, blank_number = 0;
    bool named = false;
    while (lines.next(line)) {
      const std::string_view inner = trimmed(line);
      if (inner.empty()) {
        if (blank_number == 0) blank_number = lines.number();
        continue;
      }
      if (inner.front() == '#') {
        if (!named) comment = inner, comment_number = lines.number();
        continue;
      }
      if (!named) {
        read_header(line, lines.number(), comment, comment_number);
        reserve();
        named = true, blank_number = 0;
        continue;
      }
      if (blank_number != 0) fail(blank_number, 1, "the line is blank, and points follow; remove it");
      rows_.add(size(), lines.number());
      read_row(line, lines.number());
    }
    if (!named)
      throw InputError(fmt::format("{} is empty; it must have a line of names and a line for every point", name_));
    if (table_.positions.empty())
      throw InputError(fmt::format("{}:{}: no points follow the line of names", name_, header_number_));
    if (wanted_.empty()) tell_doubts();
    return std::move(table_);
  }
  RowLines lines() const { return rows_; }

 private:
  [[noreturn]] void fail(std::size_t line, std::size_t column, const std::string& what) const {
    throw InputError(fmt::format("{}:{}:{}: {}", name_, line, column, what));
  }
  std::size_t column_of(std::string_view line, std::string_view cell) const {
    return static_cast<std::size_t>(cell.data() - line.data()) + 1;  // in bytes
  }
  std::size_t size() const {
    return table_.coordinates.empty() ? 0 : table_.positions.size() / table_.coordinates.size();
  }

  void check_format() {
    constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
    if (text_.substr(0, 3) == utf8_mark) text_.remove_prefix(3);
    const std::string format = foreign_format(text_);
    if (!format.empty())
      throw InputError(
          fmt::format("{} is {}. A table is text: a line of names, as in {}, then a line of numbers for "
                      "every point, separated by commas",
                      name_, format, example()));
    if (text_.find('\n') == std::string_view::npos && text_.find('\r') < text_.size() - 1)
      fail(1, text_.find('\r') + 1, "lines end with a carriage return alone; save the file with usual line ends");
  }

  /// "x,y,weight", or what must be there.
  std::string example() const {
    if (exactly_) return listed(wanted_, ",");
    return role_ == PointsRole::sources ? "x,y,weight" : "x,y";
  }

  // --- names ------------------------------------------------------------------------------------------------------

  void read_header(std::string_view line, std::size_t number, std::string_view comment, std::size_t comment_number) {
    header_number_ = number;
    check_separators(line);
    std::vector<std::string_view> cells;
    for (std::size_t begin = 0;;) {
      const std::size_t comma = line.find(',', begin);
      cells.push_back(trimmed(line.substr(begin, comma == std::string_view::npos ? comma : comma - begin)));
      if (comma == std::string_view::npos) break;
      begin = comma + 1;
    }
    if (is_number(cells.front())) no_names(line, cells.front(), comment, comment_number);
    for (const std::string_view cell : cells) add_name(line, cell);
    table_.coordinates = wanted_;
    exactly_                       ? choose_exactly(line, cells)
    : role_ == PointsRole::sources ? choose_sources(line, cells)
                                   : choose_targets(line, cells);
    target_.assign(names_.size(), none);
    for (std::size_t k = 0; k < table_.coordinates.size(); ++k)
      target_[static_cast<std::size_t>(std::find(names_.begin(), names_.end(), table_.coordinates[k]) -
                                       names_.begin())] = k;
  }

  void check_separators(std::string_view line) const {
    if (line.find(',') != std::string_view::npos) return;
    const std::string_view separator = separator_of(line);
    if (!separator.empty())
      fail(header_number_, 1,
           fmt::format("names are separated by {} in {}; separate names and numbers by commas, as in {}", separator,
                       in_quotes(trimmed(line)), example()));
  }

  /// The first line that is no comment holds numbers.
  [[noreturn]] void no_names(std::string_view line, std::string_view cell, std::string_view comment,
                             std::size_t comment_number) const {
    const std::size_t first = comment.find_first_not_of("# \t");
    const bool commented = first != std::string_view::npos &&
                           std::count(comment.begin(), comment.end(), ',') == std::count(line.begin(), line.end(), ',');
    fail(header_number_, column_of(line, cell),
         commented ? fmt::format("{} is a number, and the names of the columns seem to stand in the comment above; "
                                 "remove the # of line {}",
                                 in_quotes(cell), comment_number)
                   : fmt::format("{} is a number; the first line must name the columns, as in {}", in_quotes(cell),
                                 example()));
  }

  void add_name(std::string_view line, std::string_view cell) {
    const auto refuse = [&](const std::string& what) { fail(header_number_, column_of(line, cell), what); };
    std::string_view name = cell;
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    if (name.empty()) {
      if (wanted_.empty() || exactly_)
        refuse(fmt::format("column {} has no name{}", names_.size() + 1,
                           names_.empty()
                               ? "; pandas writes such a column, which numbers the lines, unless index=False; "
                                 "--columns names the coordinates"
                               : ""));
    } else if (is_number(name)) {
      refuse(fmt::format("{} is a number; the first line must name the columns", in_quotes(name)));
    } else if (name.find_first_of(";\t\"") != std::string_view::npos) {
      refuse(fmt::format("{} is not the name of a column; columns are separated by commas", in_quotes(name)));
    } else if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 32; })) {
      refuse(fmt::format("{} is not the name of a column; the file must be plain text", in_quotes(name)));
    } else if (contains(names_, name)) {
      refuse(fmt::format("column {} is there twice", in_quotes(name)));
    }
    names_.emplace_back(name);
  }

  /// Refuses names of --columns that the table does not have.
  void check_wanted() const {
    for (const std::string& wanted : wanted_) {
      if (contains(names_, wanted)) continue;
      const auto meant = base::suggest(wanted, names_);
      fail(header_number_, 1,
           fmt::format("there is no column {} among {}{}", in_quotes(wanted), listed(names_),
                       meant ? fmt::format("; is {} meant?", in_quotes(*meant)) : ""));
    }
  }

  void choose_exactly(std::string_view line, const std::vector<std::string_view>& cells) const {
    const std::string rule = fmt::format("the columns must be {}", listed(wanted_, ","));
    for (std::size_t k = 0; k < names_.size(); ++k)
      if (!contains(wanted_, names_[k]) && names_.size() >= wanted_.size())
        fail(header_number_, column_of(line, cells[k]),
             fmt::format("column {} is not one of those that are wanted; {}: remove it", in_quotes(names_[k]), rule));
    for (const std::string& wanted : wanted_)
      if (!contains(names_, wanted))
        fail(header_number_, 1,
             fmt::format("there is no column {} among {}; {}", in_quotes(wanted), listed(names_), rule));
  }

  void choose_sources(std::string_view line, const std::vector<std::string_view>& cells) {
    weight_ = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), weight_name) - names_.begin());
    if (weight_ == names_.size()) {
      const auto meant = base::suggest(weight_name, names_);
      fail(header_number_, 1,
           fmt::format("there is no column \"weight\" among {}; {}", listed(names_),
                       meant ? fmt::format("is {} meant?", in_quotes(*meant))
                             : std::string("add one, with 1 in every line if all sources count the same")));
    }
    if (contains(wanted_, weight_name))
      fail(header_number_, column_of(line, cells[weight_]), "the column \"weight\" is not a coordinate of sources");
    check_wanted();
    choose_coordinates(line, cells);
  }

  void choose_targets(std::string_view line, const std::vector<std::string_view>& cells) {
    check_wanted();
    const auto found = std::find(names_.begin(), names_.end(), weight_name);
    if (wanted_.empty() && found != names_.end())
      fail(header_number_, column_of(line, cells[static_cast<std::size_t>(found - names_.begin())]),
           "targets have coordinates only; remove the column \"weight\", or name the coordinates by --columns");
    choose_coordinates(line, cells);
  }

  /// All columns but the weight, if they were not named.
  void choose_coordinates(std::string_view line, const std::vector<std::string_view>& cells) {
    if (!wanted_.empty()) return;
    std::vector<std::string> trusted;
    std::size_t doubted = none;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (k == weight_) continue;
      table_.coordinates.push_back(names_[k]);
      if (!names_no_coordinate(names_[k]))
        trusted.push_back(names_[k]);
      else if (doubted == none)
        doubted = k;
    }
    if (doubted != none) {
      const std::string all = listed(table_.coordinates, ",");
      fail(header_number_, column_of(line, cells[doubted]),
           trusted.empty()
               ? fmt::format("is the column {} a coordinate? Say so by --columns {}", in_quotes(names_[doubted]), all)
               : fmt::format("is the column {} a coordinate? --columns {} takes the others, --columns {} takes all",
                             in_quotes(names_[doubted]), listed(trusted, ","), all));
    }
    if (table_.coordinates.empty())
      fail(header_number_, 1, fmt::format("there are no coordinates; {} have 1 to {}", word(role_), largest_dimension));
    if (table_.coordinates.size() > largest_dimension) {
      const std::string& fifth = table_.coordinates[largest_dimension];
      const auto k = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), fifth) - names_.begin());
      fail(header_number_, column_of(line, cells[k]),
           fmt::format("{} would be coordinate {}; {} have 1 to {}: name them, as in --columns x,y", in_quotes(fifth),
                       largest_dimension + 1, word(role_), largest_dimension));
    }
  }

  void tell_doubts() {
    const auto& coordinates = table_.coordinates;
    for (const std::string& doubt : doubtful_coordinates(coordinates, table_.positions)) {
      std::vector<std::string> axes;
      std::copy_if(coordinates.begin(), coordinates.end(), std::back_inserter(axes), names_an_axis);
      table_.doubts.push_back(
          fmt::format("{}: {}; {}--columns {} says that it is one", name_, doubt,
                      axes.empty() ? "" : fmt::format("--columns {} leaves it out, ", listed(axes, ",")),
                      listed(coordinates, ",")));
    }
  }

  // --- numbers ----------------------------------------------------------------------------------------------------

  // One allocation for all numbers, refused if it is too large.
  void reserve() {
    const std::size_t lines = static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '\n'));
    const std::size_t numbers = table_.coordinates.size() + (weight_ < names_.size() ? 1 : 0);
    const double bytes =
        static_cast<double>(text_.size()) + static_cast<double>(lines) * static_cast<double>(numbers * sizeof(double));
    if (bytes > static_cast<double>(memory_limit_))
      throw InputError(fmt::format("{} has about {} lines and would take {:.1f} GB to read; at most {:.1f} GB are used",
                                   name_, lines, bytes / 1e9, static_cast<double>(memory_limit_) / 1e9));
    table_.positions.reserve(lines * table_.coordinates.size());
    if (weight_ < names_.size()) table_.weights.reserve(lines);
  }

  void read_row(std::string_view line, std::size_t number) {
    const std::size_t columns = names_.size(), first = table_.positions.size();
    table_.positions.resize(first + table_.coordinates.size());
    std::size_t begin = 0;
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t comma = line.find(',', begin);
      const bool last = comma == std::string_view::npos;
      if (last != (k + 1 == columns)) ragged(line, number, last ? line.size() : comma);
      const std::string_view cell = trimmed(line.substr(begin, last ? comma : comma - begin));
      if (k == weight_)
        table_.weights.push_back(value(line, cell, number, k));
      else if (target_[k] != none)
        table_.positions[first + target_[k]] = value(line, cell, number, k);
      begin = comma + 1;
    }
  }

  [[noreturn]] void ragged(std::string_view line, std::size_t number, std::size_t at) const {
    const std::size_t columns = names_.size();
    const auto cells = static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
    const std::string_view separator = cells == 1 ? separator_of(line) : std::string_view();
    std::string remedy;
    if (!separator.empty()) remedy = fmt::format("; separate them by commas, not by {}", separator);
    if (cells == 2 * columns && line.find('.') == std::string_view::npos)
      remedy = "; the decimal sign is a point, not a comma";
    fail(number, at + 1,
         fmt::format("{} {} where {} {} named ({}){}", cells, cells == 1 ? "value" : "values", columns,
                     columns == 1 ? "column is" : "columns are", listed(names_), remedy));
  }

  double value(std::string_view line, std::string_view cell, std::size_t number, std::size_t k) const {
    const CellNumber read = read_cell(cell);
    if (!read.value)
      fail(number, column_of(line, cell),
           fmt::format("{} in column {}{}{}", read.problem, in_quotes(names_[k]), read.remedy.empty() ? "" : "; ",
                       read.remedy));
    return *read.value;
  }

  std::string_view text_;
  const std::string& name_;
  PointsRole role_;
  std::vector<std::string> wanted_;  // columns that were named; empty: all but the weight
  bool exactly_ = false;             // and no others
  std::size_t memory_limit_;
  std::vector<std::string> names_;  // of all columns
  std::size_t header_number_ = 1;
  std::size_t weight_ = none;        // its column
  std::vector<std::size_t> target_;  // of each column: which coordinate it is, or none
  PointsTable table_;
  RowLines rows_;
};

}  // namespace

PointsTable parse_points_table(std::string_view text, const std::string& name, PointsRole role,
                               std::size_t memory_limit, const CoordinateNames& coordinates) {
  return Parser(text, name, role, coordinates, memory_limit).parse();
}

PointsTable read_points_table(const fs::path& file, PointsRole role, std::size_t memory_limit,
                              const CoordinateNames& coordinates) {
  return parse_points_table(base::read_text_file(file, "a table of points (CSV)", memory_limit), file.string(), role,
                            memory_limit, coordinates);
}

NamedColumns parse_named_columns(std::string_view text, const std::string& name, const std::vector<std::string>& names,
                                 std::size_t memory_limit) {
  Parser parser(text, name, names, memory_limit);
  PointsTable table = parser.parse();
  return {std::move(table.positions), parser.lines()};
}

NamedColumns read_named_columns(const fs::path& file, const std::vector<std::string>& names, std::size_t memory_limit) {
  return parse_named_columns(base::read_text_file(file, "a table of points (CSV)", memory_limit), file.string(), names,
                             memory_limit);
}

}  // namespace gaussdrift::input
