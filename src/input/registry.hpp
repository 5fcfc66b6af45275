// Every key of a case file: its type, default, range, symbol and meaning. Each stands beside the reader of its table, in
// tables/; the registry collects them. The reader, its messages, `gaussdrift explain`, the JSON schema and docs/cases.md
// are driven by it, so that they cannot disagree.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/named.hpp"

namespace gaussdrift::input {

enum class Type {
  text,         // a string
  texts,        // a list of strings
  number,       // a number or an expression of params, pi, e
  whole,        // the same, without a fraction
  boolean,      // true or false
  duration,     // seconds, or a text as "10 min"
  numbers,      // a list of numbers
  point,        // a list of as many numbers as the domain has dimensions
  expression,   // a string in x, y, z and params
  expressions,  // a list of strings in x, y, z, t and params, one a dimension
  choice,       // one of `choices`
  choices,      // a list of some of `choices`
  ends,         // one of `choices` for each axis, or a pair of them for its two ends
  clock         // a table { start = a date or number, unit = a unit or number }
};

struct Key {
  std::string table = {};  // empty: the top of the file
  std::string_view name;
  Type type = Type::text;
  bool required = false;
  std::string_view fallback = {};  // the default as it would be written, lists separated by ", "; empty: none
  Range range = {};
  std::vector<std::string_view> choices = {};
  bool or_flag = false;  // a choice: true is the first one, false none
  std::string_view unit = {};
  std::string_view symbol = {};  // in the thesis
  std::string meaning = {};
  std::string_view with = {};     // the key that it goes with: "file", "field", ...; empty: it stands by itself
  std::string_view value = {};    // and the value of that key: "rotation", ...; empty: any
  std::string_view or_with = {};  // another key that it goes with

  /// Does it go with the kind of a part ("field") and the value named there ("rotation")?
  bool belongs(std::string_view kind, std::string_view named) const {
    return with.empty() || (with == kind && (value.empty() || value == named)) || (!or_with.empty() && or_with == kind);
  }
};

struct Table {
  std::string name;
  bool required = false;
  std::string meaning = {};
  std::string_view unless = {};              // a required one may be missing where this one is there
  std::vector<std::string_view> kinds = {};  // keys of which a table has exactly one; the table may then be repeated,
                                             // [[velocity]], and its parts add up
};

/// A quantity of the thesis that is no key: it follows from keys.
struct Quantity {
  std::string_view symbol;
  std::string_view meaning;
  std::string_view formula = {};
  std::string_view unit = {};
  std::string_view set_by = {};  // the keys that it follows from
};

/// In the order of a well-written case file.
const std::vector<Table>& tables();
const std::vector<Key>& keys();
const std::vector<Quantity>& quantities();

/// Throws std::logic_error if there is no such key. Named formulas have keys of the same name: `value` is the
/// formula's.
const Key& find_key(std::string_view table, std::string_view name, std::string_view value = {});
const Table& find_table(std::string_view name);
/// Each once, in the order of the registry.
std::vector<std::string> key_names(std::string_view table);
/// The keys that go with a kind and the value named there.
std::vector<std::string> key_names(std::string_view table, std::string_view kind, std::string_view value);
std::vector<std::string> table_names();

/// "number", "list of 2 or 3 numbers", ... for people.
std::string type_text(const Key& key);
/// "at least 2", "greater than 0", "at least 1e-14 and less than 1"; empty without ends.
std::string range_text(const Range& range);

/// The first sentence of a meaning, for lists of keys and under errors.
std::string_view first_sentence(std::string_view meaning);

}  // namespace gaussdrift::input
