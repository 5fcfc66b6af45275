// Every key of a case file: its type, default, range, symbol and meaning, in one table. The reader, its messages and
// docs/cases.md are driven by it, so that they cannot disagree.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::input {

enum class Type {
  text,         // a string
  number,       // a number or an expression of params, pi, e
  whole,        // the same, without a fraction
  numbers,      // a list of numbers
  point,        // a list of as many numbers as the domain has dimensions
  expression,   // a string in x, y, z and params
  expressions,  // a list of strings in x, y, z, t and params, one a dimension
  choice,       // one of `choices`
  choices       // a list of some of `choices`
};

/// Numbers from `least` to `most`; an end that is `open` is not among them.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_open = false, most_open = false;

  bool contains(double value) const;
  /// "at least 2", "greater than 0", "between 1e-14 and 1, 1 excluded"; empty without ends.
  std::string text() const;
};

struct Key {
  std::string_view table;  // empty: the top of the file
  std::string_view name;
  Type type = Type::text;
  bool required = false;
  std::string_view fallback = {};  // the default as it would be written, lists separated by ", "; empty: none
  Range range = {};
  std::vector<std::string_view> choices = {};
  std::string_view unit = {};
  std::string_view symbol = {};  // in the thesis
  std::string_view meaning = {};
};

struct Table {
  std::string_view name;
  bool required = false;
  std::string_view meaning = {};
};

/// In the order of a well-written case file.
const std::vector<Table>& tables();
const std::vector<Key>& keys();

/// Throws std::logic_error if there is no such key.
const Key& find_key(std::string_view table, std::string_view name);
std::vector<std::string> key_names(std::string_view table);
std::vector<std::string> table_names();

/// "number", "list of 2 or 3 numbers", ... for people.
std::string type_text(const Key& key);

/// The tables of keys and of functions, as docs/cases.md shows them.
std::string registry_markdown();
std::string functions_markdown();

}  // namespace gaussdrift::input
