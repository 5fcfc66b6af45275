// Rows of plain numbers are read straight from the text. A row that is anything else is cut into cells, and read or refused
// cell by cell.
#include "input/table_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/printable.hpp"
#include "gaussdrift/error.hpp"
#include "input/column_names.hpp"
#include "input/foreign_format.hpp"
#include "input/table_line.hpp"
#include "input/table_number.hpp"

namespace gaussdrift::input {

namespace {

using base::in_quotes;

constexpr std::size_t none = static_cast<std::size_t>(-1);
constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";

bool is_number(std::string_view text) { return read_cell(text).value.has_value(); }

/// How a row is laid out, for the reader of plain rows.
struct RowPlan {
  Separator separator = Separator::comma;
  std::vector<std::size_t> target;  // of each column: which coordinate it is, `weight` or `none`
  std::size_t coordinates = 0;
  std::size_t weight() const { return coordinates; }
};

/// The number that begins at `at`, also one with the exponent of Fortran, and where it ends; nullptr if none is there.
const char* read_plain_number(const char* at, const char* const end, double& number) {
  if (at < end && *at == '+') {  // std::from_chars takes none
    ++at;
    if (at < end && *at == '-') return nullptr;
  }
  auto [rest, error] = std::from_chars(at, end, number);
  if (error == std::errc() && rest < end && (*rest == 'D' || *rest == 'd')) {
    std::array<char, 48> copy;
    const auto before = static_cast<std::size_t>(rest - at);
    const char* behind = rest + 1;
    while (behind < end && ((*behind >= '0' && *behind <= '9') || *behind == '+' || *behind == '-')) ++behind;
    const auto length = static_cast<std::size_t>(behind - at);
    if (length > copy.size()) return nullptr;
    std::copy(at, behind, copy.begin());
    copy[before] = 'e';
    const auto again = std::from_chars(copy.data(), copy.data() + length, number);
    error = again.ec;
    if (again.ptr != copy.data() + length) return nullptr;
    rest = behind;
  }
  return error == std::errc() && std::isfinite(number) ? rest : nullptr;
}

/// Behind the quotation mark that ends what begins with one at `at`; nullptr if there is none.
const char* behind_quotes(const char* at, const char* const end) {
  for (++at; at < end; ++at)
    if (*at == '"') {
      if (at + 1 >= end || at[1] != '"') return at + 1;
      ++at;
    }
  return nullptr;
}

/// Reads a row of numbers, without a comment. False for any other, and for whatever is not clear: `coordinates` and
/// `weight` then hold nothing.
template <Separator separator>
bool read_plain_row(const char* at, const char* const end, const RowPlan& plan, double* coordinates, double& weight) {
  constexpr char letter = separator == Separator::comma ? ',' : separator == Separator::semicolon ? ';' : '\t';
  const auto is_blank = [](char c) { return c == ' ' || (separator != Separator::tab && c == '\t'); };
  const auto skip_blanks = [&] {
    while (at < end && is_blank(*at)) ++at;
  };
  for (std::size_t k = 0; k < plan.target.size(); ++k) {
    skip_blanks();
    const bool quoted = at < end && *at == '"';
    if (const std::size_t target = plan.target[k]; target != none) {
      if (quoted) {
        ++at;
        skip_blanks();
      }
      at = read_plain_number(at, end, target == plan.coordinates ? weight : coordinates[target]);
      if (!at) return false;
      if (quoted) {
        skip_blanks();
        if (at == end || *at++ != '"') return false;
      }
    } else if (quoted) {
      at = behind_quotes(at, end);
      if (!at) return false;
    } else {
      while (at < end && (separator == Separator::blanks ? !is_blank(*at) : *at != letter)) ++at;
    }
    const char* const behind = at;
    skip_blanks();
    if (k + 1 == plan.target.size()) return at == end;
    if (at == end) return false;
    if constexpr (separator == Separator::blanks) {
      if (at == behind) return false;
    } else {
      if (*at != letter) return false;
      ++at;
    }
  }
  return false;
}

bool read_plain_row(std::string_view line, const RowPlan& plan, double* coordinates, double& weight) {
  const char* const begin = line.data();
  const char* const end = begin + line.size();
  switch (plan.separator) {
    case Separator::comma:
      return read_plain_row<Separator::comma>(begin, end, plan, coordinates, weight);
    case Separator::semicolon:
      return read_plain_row<Separator::semicolon>(begin, end, plan, coordinates, weight);
    case Separator::tab:
      return read_plain_row<Separator::tab>(begin, end, plan, coordinates, weight);
    case Separator::blanks:
      return read_plain_row<Separator::blanks>(begin, end, plan, coordinates, weight);
  }
  return false;
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& name, const WantedColumns& wanted, std::size_t memory_limit)
      : text_(text), name_(name), wanted_(wanted), memory_limit_(memory_limit) {}

  TextTable parse() {
    check_format();
    Lines lines(text_);
    std::string_view line, comment;  // the last one before the names
    std::size_t comment_number = 0, blank_number = 0;
    bool begun = false;
    while (lines.next(line)) {
      const std::string_view inner = trimmed(line);
      if (inner.empty()) {
        if (blank_number == 0) blank_number = lines.number();
        continue;
      }
      if (inner.front() == '#') {
        if (!begun) comment = inner, comment_number = lines.number();
        continue;
      }
      if (!begun) {
        begun = true, blank_number = 0;
        const bool named = read_header(line, lines.number(), comment, comment_number);
        reserve();
        if (named) continue;
      }
      if (blank_number != 0) fail(blank_number, 1, "the line is blank, and points follow; remove it");
      table_.lines.add(row_, lines.number());
      read_row(line, lines.number());
      ++row_;
    }
    if (!begun)
      throw InputError(fmt::format("{} is empty; it must have a line of names and a line for every point", name_));
    if (row_ == 0) throw InputError(fmt::format("{}:{}: no points follow the line of names", name_, header_number_));
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(std::size_t line, std::size_t column, const std::string& what) const {
    throw InputError(fmt::format("{}:{}:{}: {}", name_, line, column, what));
  }
  std::size_t column_of(std::string_view line, std::string_view cell) const {
    return static_cast<std::size_t>(cell.data() - line.data()) + 1;  // in bytes
  }

  void check_format() {
    if (text_.substr(0, 3) == utf8_mark) text_.remove_prefix(3);
    const std::string format = foreign_format(text_);
    if (!format.empty())
      throw InputError(
          fmt::format("{} is {}. A table is text: a line of names, as in {}, then a line of numbers for "
                      "every point, separated by commas, semicolons, tabs or blanks",
                      name_, format, wanted_.example()));
    if (text_.find('\n') == std::string_view::npos && text_.find('\r') < text_.size() - 1)
      fail(1, text_.find('\r') + 1, "lines end with a carriage return alone; save the file with usual line ends");
  }

  // --- names ------------------------------------------------------------------------------------------------------

  /// False if the line has no names, and none are needed: it is the first row.
  bool read_header(std::string_view line, std::size_t number, std::string_view comment, std::size_t comment_number) {
    header_number_ = number;
    plan_.separator = separator_in(line).value_or(Separator::comma);
    const std::vector<Cell> cells = cells_of(line, plan_.separator);
    const bool named = !is_number(cells.front().text);
    if (named)
      for (const Cell& cell : cells) add_name(line, cell);
    else if (wanted_.by_number())
      number_columns(line, cells);
    else
      refuse_numbers(line, cells.front().text, comment, comment_number);
    const ChosenColumns chosen = choose_columns(
        {.names = names_, .named = named}, wanted_, [&](std::optional<std::size_t> column, const std::string& what) {
          fail(header_number_, column ? column_of(line, cells[*column].text) - (cells[*column].quoted ? 1 : 0) : 1,
               what);
        });
    plan_.target.assign(names_.size(), none);
    plan_.coordinates = chosen.coordinates.size();
    for (std::size_t k = 0; k < chosen.coordinates.size(); ++k) {
      plan_.target[chosen.coordinates[k]] = k;
      table_.names.push_back(names_[chosen.coordinates[k]]);
    }
    has_weight_ = chosen.weight.has_value();
    if (has_weight_) plan_.target[*chosen.weight] = plan_.weight();
    return named;
  }

  /// The first line holds numbers, and columns are chosen by number.
  void number_columns(std::string_view line, const std::vector<Cell>& cells) {
    for (std::size_t k = 0; k < cells.size(); ++k) names_.push_back(fmt::format("{}", k + 1));
    const auto counts_from = [&](double first) {
      for (std::size_t k = 0; k < cells.size(); ++k)
        if (read_cell(cells[k].text).value != first + static_cast<double>(k)) return false;
      return cells.size() > 1;
    };
    if (counts_from(0) || counts_from(1))
      fail(header_number_, 1,
           fmt::format("{} counts the columns, as pandas names columns without names; remove the line, or, if it is a "
                       "point, put a line of names above it",
                       in_quotes(trimmed(line))));
  }

  /// The first line that is no comment holds numbers.
  [[noreturn]] void refuse_numbers(std::string_view line, std::string_view cell, std::string_view comment,
                                   std::size_t comment_number) const {
    const std::size_t first = comment.find_first_not_of("# \t");
    const bool commented = first != std::string_view::npos && cells_of(comment.substr(first), plan_.separator).size() ==
                                                                  cells_of(line, plan_.separator).size();
    fail(header_number_, column_of(line, cell),
         commented ? fmt::format(
                         "{} is a number, and the names of the columns seem to stand in the comment above; remove the "
                         "# of line {}",
                         in_quotes(cell), comment_number)
                   : fmt::format("{} is a number; the first line must name the columns, as in {}{}", in_quotes(cell),
                                 wanted_.example(),
                                 wanted_.table == WantedColumns::Table::exactly
                                     ? ""
                                     : ", unless columns are chosen by number, as in --columns 1,2 --weight 3"));
  }

  void add_name(std::string_view line, const Cell& cell) {
    const auto refuse = [&](const std::string& what) {
      fail(header_number_, column_of(line, cell.text) - (cell.quoted ? 1 : 0), what);
    };
    const std::string name = unquoted(cell);
    const auto steers = [](char c) { return static_cast<unsigned char>(c) < 32 && c != '\t'; };
    if (name.empty()) {
      if (wanted_.coordinates.empty() || wanted_.table == WantedColumns::Table::exactly)
        refuse(fmt::format("column {} has no name{}", names_.size() + 1,
                           names_.empty()
                               ? "; pandas writes such a column, which numbers the lines, unless index=False; "
                                 "--columns names the coordinates"
                               : ""));
    } else if (is_number(name)) {
      refuse(fmt::format("{} is a number; the first line must name the columns", in_quotes(name)));
    } else if (!cell.quoted && name.find_first_of(";\t\"") != std::string::npos) {
      refuse(fmt::format(
          "{} is not the name of a column; columns are separated by {}, and a name that has {} in it "
          "stands in quotation marks",
          in_quotes(name), name_of(plan_.separator), name.find('"') != std::string::npos ? "one" : "others"));
    } else if (std::any_of(name.begin(), name.end(), steers)) {
      refuse(fmt::format("{} is not the name of a column; the file must be plain text", in_quotes(name)));
    } else if (std::find(names_.begin(), names_.end(), name) != names_.end()) {
      refuse(fmt::format("column {} is there twice", in_quotes(name)));
    }
    names_.push_back(name);
  }

  // --- numbers ----------------------------------------------------------------------------------------------------

  // One allocation for all numbers, refused if it is too large.
  void reserve() {
    const std::size_t ends = static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '\n')),
                      lines = ends + (text_.back() == '\n' ? 0 : 1);
    const std::size_t numbers = plan_.coordinates + (has_weight_ ? 1 : 0);
    const double bytes =
        static_cast<double>(text_.size()) + static_cast<double>(lines) * static_cast<double>(numbers * sizeof(double));
    if (bytes > static_cast<double>(memory_limit_))
      throw InputError(fmt::format("{} has about {} lines and would take {:.1f} GB to read; at most {:.1f} GB are used",
                                   name_, lines, bytes / 1e9, static_cast<double>(memory_limit_) / 1e9));
    table_.rows.reserve(lines * plan_.coordinates);
    if (has_weight_) table_.weights.reserve(lines);
  }

  void read_row(std::string_view line, std::size_t number) {
    const std::size_t first = table_.rows.size();
    table_.rows.resize(first + plan_.coordinates);
    double weight = 0;
    if (!read_plain_row(line, plan_, table_.rows.data() + first, weight))
      read_cells(line, number, table_.rows.data() + first, weight);
    if (has_weight_) table_.weights.push_back(weight);
  }

  void read_cells(std::string_view line, std::size_t number, double* coordinates, double& weight) const {
    std::vector<Cell> cells = cells_of(line, plan_.separator);
    if (!all_numbers(cells))
      if (const std::string_view before = without_comment(line); before.size() < line.size())
        if (std::vector<Cell> fewer = cells_of(before, plan_.separator); all_numbers(fewer)) cells = std::move(fewer);
    if (cells.size() != names_.size()) ragged(line, number, cells);
    for (std::size_t k = 0; k < cells.size(); ++k)
      if (plan_.target[k] != none)
        (plan_.target[k] == plan_.weight() ? weight : coordinates[plan_.target[k]]) = value(line, cells[k], number, k);
  }

  bool all_numbers(const std::vector<Cell>& cells) const {
    if (cells.size() != names_.size()) return false;
    for (std::size_t k = 0; k < cells.size(); ++k)
      if (plan_.target[k] != none && !is_number(cells[k].text)) return false;
    return true;
  }

  /// A comment at the end of a line begins with a # behind a blank.
  static std::string_view without_comment(std::string_view line) {
    for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1))
      if (at > 0 && (line[at - 1] == ' ' || line[at - 1] == '\t')) return trimmed(line.substr(0, at));
    return line;
  }

  [[noreturn]] void ragged(std::string_view line, std::size_t number, const std::vector<Cell>& cells) const {
    const std::size_t columns = names_.size(), count = cells.size();
    // Where the line ends too early, or the first cell too many begins.
    const std::size_t at = count < columns ? line.size() + 1 : column_of(line, cells[columns].text) - 1;
    const auto other = count == 1 ? separator_in(line) : std::nullopt;
    std::string remedy;
    if (other) remedy = fmt::format("; separate them by {}, not by {}", name_of(plan_.separator), name_of(*other));
    if (plan_.separator == Separator::comma && count == 2 * columns && line.find('.') == std::string_view::npos)
      remedy = "; the decimal sign is a point, not a comma";
    fail(number, at,
         fmt::format("{} {} where {} {} named ({}){}", count, count == 1 ? "value" : "values", columns,
                     columns == 1 ? "column is" : "columns are", listed(names_), remedy));
  }

  double value(std::string_view line, const Cell& cell, std::size_t number, std::size_t k) const {
    const CellNumber read = read_cell(cell.text);
    if (!read.value)
      fail(number, column_of(line, cell.text) - (cell.quoted ? 1 : 0),
           fmt::format("{} in column {}{}{}", read.problem, in_quotes(names_[k]), read.remedy.empty() ? "" : "; ",
                       read.remedy));
    return *read.value;
  }

  std::string_view text_;
  const std::string& name_;
  const WantedColumns& wanted_;
  std::size_t memory_limit_;
  std::vector<std::string> names_;  // of all columns
  std::size_t header_number_ = 1, row_ = 0;
  RowPlan plan_;
  bool has_weight_ = false;
  TextTable table_;
};

}  // namespace

TextTable parse_text_table(std::string_view text, const std::string& name, const WantedColumns& wanted,
                           std::size_t memory_limit) {
  return Parser(text, name, wanted, memory_limit).parse();
}

std::vector<std::string> names_in(std::string_view text) {
  if (text.substr(0, 3) == utf8_mark) text.remove_prefix(3);
  Lines lines(text);
  for (std::string_view line; lines.next(line);) {
    const std::string_view inner = trimmed(line);
    if (inner.empty() || inner.front() == '#') continue;
    std::vector<std::string> names;
    for (const Cell& cell : cells_of(line, separator_in(line).value_or(Separator::comma))) {
      if (is_number(cell.text)) return {};
      names.push_back(unquoted(cell));
    }
    return names;
  }
  return {};
}

}  // namespace gaussdrift::input
