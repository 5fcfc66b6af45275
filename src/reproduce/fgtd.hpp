// Tables 3.2 to 3.5, 4.1 to 4.9 (the transform), 6.1 and 6.2 (divergence-free fields) of [Sch06] again: `hermite` with
// the thesis's parameters and points beside the published numbers, and `automatic` asked for the error that these
// parameters gave. docs/reproduce.md.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace gaussdrift::reproduce {

/// What the numbers of a column are, hence how they are shown.
enum class Quantity {
  count,  // whole
  error,  // a power of ten, or digits
  seconds,
  factor  // of seconds
};

/// How the published number is compared with the computed one.
enum class Comparison {
  none,        // seconds of another machine; numbers that nobody published
  arithmetic,  // follows from a formula, nothing is measured: the same number, or the same power of ten
  digits,      // measured: all printed digits
  order,       // measured: the printed order of magnitude, between a third of the power of ten and its end
  at_most      // measured: at most the printed power of ten
};
/// The kinds that compare, in that order.
constexpr std::array comparisons{Comparison::arithmetic, Comparison::digits, Comparison::order, Comparison::at_most};
std::string to_string(Comparison comparison);

struct Column {
  std::string name = {};
  std::string printed = {};  // column of the published table; empty: nobody published it
  Quantity quantity = Quantity::error;
  Comparison comparison = Comparison::none;
  int digits = 1;            // shown
  bool automatic = false;    // has a third number
  int decades = 0;           // powers of ten that a number may be off and agree nevertheless, larger unless arithmetic
  std::string why_off = {};  // the reason
  double unit = 1;           // of the published number in those of the computed one
};

struct Entry {
  std::optional<double> computed, automatic;
  bool kept = true;                           // automatic keeps its promise
  std::optional<Comparison> comparison = {};  // where it is not that of the column
  std::optional<double> published = {};       // filled in from the published table
  double last_digit = 0;                      // a unit of the last digit of that
};

struct Row {
  std::string name;
  std::size_t printed = 0;     // row of the published table
  std::vector<Entry> entries;  // as many as columns
  std::string note;
};

struct Table {
  std::string number;  // "4.6"
  std::string title;
  std::string what;  // what is computed, one line
  std::vector<Column> columns;
  std::vector<Row> rows;
};

/// The thesis's weights are not known to the last digit. An error may be beyond the end of the printed power of ten by
/// this factor.
constexpr double error_slack = 1.25;

Comparison comparison_of(const Column& column, const Entry& entry);
/// Are both numbers there, and is there a comparison for them?
bool is_compared(const Column& column, const Entry& entry);
/// Does the computed number agree with the published one as the comparison says, and does automatic keep its promise?
bool agrees(const Column& column, const Entry& entry);
/// Is it compared, and a power of ten away from the published one, larger unless it follows by arithmetic?
bool off(const Column& column, const Entry& entry);
/// floor(log10 x), where 1e-3 is -3 although it is rounded.
int power_of_ten(double x);

enum class TableSet { fgtd, divergence };

struct FgtdOptions {
  TableSet set = TableSet::fgtd;
  std::string table;  // one of table_numbers(set), or empty for all
  int threads = 0;    // 0: all, but one where seconds are measured, as the thesis's machine had one
  // Larger rows are left out, larger sums are measured at a sample of the targets; infinite for everything.
  double most_points = 1e6;
  double most_pairs = 5e7;  // of sources and targets in a direct sum
  double most_terms = 5e9;  // of expansions that are timed

  static FgtdOptions everything() {
    FgtdOptions options;
    options.most_points = options.most_pairs = options.most_terms = std::numeric_limits<double>::infinity();
    return options;
  }
};

/// Where seconds are measured.
inline int timed_threads(const FgtdOptions& options) { return options.threads > 0 ? options.threads : 1; }

struct FgtdReproduction {
  std::string source;  // "Schroeder 2006, Tables ..."
  std::vector<Table> tables;
  int threads = 1;  // of the times
  double seconds = 0;
  std::size_t compared = 0;  // numbers that can agree or not
  std::array<std::size_t, comparisons.size()> by_kind{};
  struct Off {
    std::string place, why;  // "Table 4.1, N = 200, p=8 nu=2 bound: 1.1e3, published 1e2"
  };
  std::vector<Off> off;  // numbers a power of ten away that agree nevertheless
  std::vector<std::string> disagreements;
};

/// "3.2", ..., "4.9"; "6.1", "6.2"
std::vector<std::string> table_numbers(TableSet set);

/// `progress` is told the table that is being computed.
FgtdReproduction reproduce_fgtd(const FgtdOptions& options,
                                const std::function<void(const std::string&)>& progress = {});

std::string to_text(const FgtdReproduction& result);
std::string to_json(const FgtdReproduction& result);

}  // namespace gaussdrift::reproduce
