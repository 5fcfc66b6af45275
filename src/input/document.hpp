// A TOML text as a tree of values with their places, after the overrides. Knows nothing about cases.
// document.cpp is the one place that knows toml++.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "input/diagnostics.hpp"

namespace gaussdrift::input {

struct Entry;

struct Value {
  enum class Kind { table, list, text, whole, number, boolean, date };
  Kind kind = Kind::table;
  Place place;                 // of the value; of the header for a table [name]
  std::string text;            // text, date
  std::int64_t whole = 0;      // whole
  double number = 0;           // whole, number
  bool boolean = false;        // boolean
  std::vector<Value> items;    // list
  std::vector<Entry> entries;  // table, in file order

  Entry* find(const std::string& name);
  const Entry* find(const std::string& name) const;
  /// "the string "abc"", "the number 2.5", "a list", "true", ... : what was found, for messages.
  std::string description() const;
};

struct Entry {
  std::string name;
  Place place;  // of the key
  Value value;
};

/// The tree of the file with the overrides "table.key=value" put in. What does not parse is reported; nothing is
/// returned if the file itself is not TOML.
std::optional<Value> read_document(const std::string& text, const Source& source, Diagnostics& diagnostics);

/// Place of `length` bytes from byte `position` of a string's content, if the string is written on one line without
/// escapes.
Place place_in_text(const Value& value, const Source& source, std::size_t position, std::size_t length);

}  // namespace gaussdrift::input
