// Tables 3.2 to 3.5, 4.1 to 4.8 (the transform), 6.1 and 6.2 (divergence-free fields) of [Sch06] again: `hermite` with
// the thesis's parameters and points beside the published numbers, and `automatic` asked for the error that these
// parameters gave. docs/reproduce.md.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace gaussdrift::study {

/// What the numbers of a column are, hence how they are printed and when they agree.
enum class Quantity {
  count,    // exact
  bound,    // proven error, printed as a power of ten: the same power
  error,    // measured, printed as a power of ten or with digits: that power or less
  seconds,  // of another machine: no comparison
  factor    // of seconds
};

struct Column {
  std::string name;
  Quantity quantity = Quantity::error;
  int decades = 0;         // powers of ten that an error may be larger, a bound different
  int digits = 1;          // printed
  bool automatic = false;  // has a third number
  bool published = true;   // has a first number
};

struct Entry {
  std::optional<double> published, computed, automatic;
  bool kept = true;  // automatic keeps its promise
};

struct Row {
  std::string name;
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

/// A printed power of ten ends somewhere, and the thesis's weights are not known to the last digit: an error may be
/// this factor beyond it.
constexpr double error_slack = 1.25;

/// Is the computed number as good as the published one, and does automatic keep its promise?
bool agrees(const Column& column, const Entry& entry);
/// floor(log10 x), where 1e-3 is -3 although it is rounded.
int power_of_ten(double x);

enum class TableSet { fgtd, divergence };

struct FgtdOptions {
  TableSet set = TableSet::fgtd;
  std::string table;  // one of table_numbers(set), or empty for all
  int threads = 0;    // 0: all, but one where seconds are measured, as the thesis's machine had one
  // What is larger is left out (rows) or measured at a sample of the targets; infinite for everything.
  double most_points = 1e6;
  double most_pairs = 5e7;  // of sources and targets in a direct sum
  double most_terms = 5e9;  // of expansions that are timed

  static FgtdOptions everything() {
    FgtdOptions options;
    options.most_points = options.most_pairs = options.most_terms = std::numeric_limits<double>::infinity();
    return options;
  }
};

struct FgtdReproduction {
  std::string source;  // "Schroeder 2006, Tables ..."
  std::vector<Table> tables;
  int threads = 1;  // of the times
  double seconds = 0;
  std::size_t compared = 0;  // numbers that can agree or not
  std::size_t equal = 0;     // errors: the same power of ten; counts: the same number
  std::size_t better = 0;    // a smaller power of ten
  std::vector<std::string> disagreements;
};

/// "3.2", ..., "4.8"; "6.1", "6.2"
std::vector<std::string> table_numbers(TableSet set);

/// `progress` is told the table that is being computed.
FgtdReproduction reproduce_fgtd(const FgtdOptions& options,
                                const std::function<void(const std::string&)>& progress = {});

std::string to_text(const FgtdReproduction& result);
std::string to_json(const FgtdReproduction& result);

}  // namespace gaussdrift::study
