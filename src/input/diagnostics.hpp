// Complaints about a case file, each with its place, laid out for people:
//
//   error: unknown key "overlapp" in [particles]; did you mean "overlap"?
//     --> cone.toml:29:1
//      |
//   29 | overlapp = 2
//      | ^^^^^^^^
//      = known keys: per_axis, overlap, cutoff
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::input {

/// A stretch of one line, of the file or of an override. Lines count from 1; columns from 0, in bytes.
struct Place {
  int override_index = -1;  // -1: in the file
  std::size_t line = 1;
  std::size_t column = 0;
  std::size_t length = 1;

  Place part(std::size_t from, std::size_t count) const { return {override_index, line, column + from, count}; }
};

/// In the order of the file, then of the overrides.
bool comes_before(const Place& a, const Place& b);

/// The lines of the file and the overrides.
class Source {
 public:
  Source(std::string name, std::string_view text, std::vector<std::string> overrides);

  const std::string& name() const { return name_; }
  const std::vector<std::string>& overrides() const { return overrides_; }
  /// The line of the file, or the override, that a place lies in.
  std::string_view line(const Place& place) const;
  std::string_view text(const Place& place) const;
  /// Byte of the column that counts `characters` from 1, as TOML positions do.
  std::size_t byte_column(std::size_t line, std::size_t characters) const;
  /// Just after the last line that is not empty: where something missing could be added.
  Place end() const;

 private:
  std::string name_;
  std::vector<std::string> lines_, overrides_;
};

class Diagnostics {
 public:
  explicit Diagnostics(const Source& source) : source_(source) {}

  void error(const Place& place, const std::string& message, const std::string& note = "");
  void warning(const Place& place, const std::string& message, const std::string& note = "");

  int errors() const { return static_cast<int>(errors_.size()); }
  /// All errors in the order of the file, with the count at the end.
  std::string error_text() const;
  std::vector<std::string> warnings() const;

 private:
  struct Entry {
    Place place;
    std::string kind, message, note;
  };
  std::string layout(const Entry& entry) const;
  static std::vector<Entry> in_file_order(std::vector<Entry> entries);

  const Source& source_;
  std::vector<Entry> errors_, warnings_;
};

}  // namespace gaussdrift::input
