// The document of a case while it is read: finds tables, keys and values, and complains about what is wrong with them.
// tables/ has a file a table, which says what its keys mean and which rules they keep.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/named.hpp"
#include "expression/expression.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice.hpp"
#include "input/diagnostics.hpp"
#include "input/document.hpp"
#include "input/registry.hpp"

namespace gaussdrift::input {

/// An output this close to the end, relative to it, is the end: "2*pi" in two spellings.
constexpr double same_time = 1e-12;

/// A number with the value it was written as.
struct Number {
  double number;
  const Value* written;  // null: the default
};

struct Parameter {
  std::string name;
  double value = 1;
  Place place;
  bool valid = false;  // false: already complained about
  bool used = false;
};

/// What tables have told that others need.
struct Facts {
  int dimension = 0;  // 0: not known because of an error
  bool domain_valid = false;
  bool on_sphere = false;  // places are longitudes and latitudes
  Box box;                 // the domain, if it is valid
  std::array<bool, max_dimension> one_particle_across{};
  std::vector<std::pair<Place, std::shared_ptr<const GridData>>> grid_files;
  std::optional<double> end;  // time.end, elapsed
};

/// Reads a part of a table that may be repeated: its kind, and the value of that key.
using ReadPart = std::function<void(std::string_view kind, const Value& value)>;

class Reader {
 public:
  Reader(const Value& root, const Source& of_file, Diagnostics& complaints, std::filesystem::path case_folder,
         int threads_of_fits)
      : source(of_file),
        diagnostics(complaints),
        folder(std::move(case_folder)),
        threads(threads_of_fits),
        root_(root) {}

  // --- Structure: what stands in the file.

  void read_version();
  void check_names();
  void check_tables();
  bool is_meant(std::string_view label) const;

  // --- Tables and keys.

  /// The table, or the part of it that is being read.
  const Value* table(std::string_view name) const;
  const Entry* find(std::string_view table_name, std::string_view name) const;
  /// What stands at the top of the file under this name, one table or several.
  const Entry* top(std::string_view name) const { return root_.find(std::string(name)); }
  /// "velocity", or "velocity[2]" for the second of several parts.
  std::string label_of(std::string_view table_name) const;
  std::string label_of(const Key& key) const;
  /// The entry of a required key, or a complaint at the head of its table (a missing table has been complained about).
  const Entry* require(const Key& key);
  void wrong_type(const Value& value, const std::string& label, const std::string& wanted);
  /// The one key of several that exclude each other; nothing, after a complaint, if there is none or more than one.
  std::optional<std::string_view> exactly_one(std::string_view table_name, const std::vector<std::string_view>& names);
  /// Calls read(kind, value of that key) for each part of a table that may be repeated. Keys that do not go with the
  /// kind, or with the formula named there, have been complained about.
  void each_part(std::string_view table_name, const ReadPart& read);

  // --- Values.

  std::string text(std::string_view table_name, std::string_view name);
  std::vector<std::pair<std::string, double>> constants() const;
  /// Seconds; none if the key is not there, or after a complaint.
  std::optional<double> duration(std::string_view table_name, std::string_view name);
  /// A number or an expression of the params, finite. Nothing after a complaint.
  std::optional<double> number_in(const Value& value, const std::string& label) {
    return number_in(value, label, false);
  }
  /// The same for a key, in its range; its default if it is absent.
  std::optional<Number> number(std::string_view table_name, std::string_view name, const std::string& note = "");
  std::optional<double> number_of(const Key& key, const Entry& entry, const std::string& note = "");
  /// The parameters of a named formula, all of them if nothing was complained about.
  Arguments arguments(const Key& kind, const NamedFormula& formula, const Value& written);
  bool check_range(const Key& key, double value, const Value& written, const std::string& note = "");
  /// A list of numbers; nothing if one of them was complained about.
  std::optional<std::vector<double>> numbers(const Entry& entry, const Key& key);
  /// A list of as many numbers as there are dimensions, each in the key's range.
  std::optional<std::vector<double>> point_of(const Key& key, const Entry& entry);
  /// As many entries as the domain has dimensions?
  bool has_entries(const Value& value, const Key& key, std::string_view what);
  /// One of the key's choices; the index, or nothing after a complaint.
  std::optional<std::size_t> choice_in(const Value& value, const Key& key, const std::string& label);
  std::string choice(std::string_view table_name, std::string_view name);
  /// True or false; false if the key is not there, or after a complaint.
  bool flag(std::string_view table_name, std::string_view name);
  /// Those of the key's choices that are in the list of the file, as indices; the default ones if it has none.
  std::vector<std::size_t> choices(std::string_view table_name, std::string_view name);
  /// An expression of position, perhaps time; compiled here to find its errors. A plain number is one too.
  std::string field_expression(const Value& value, const std::string& label, bool with_time);
  /// The same of tracers too, by their names.
  std::string tracer_expression(const Value& value, const std::string& label, const std::vector<std::string>& tracers);
  /// The same of time alone.
  std::string time_expression(const Value& value, const std::string& label);

  const Source& source;
  Diagnostics& diagnostics;
  const std::filesystem::path folder;  // of the case file
  const int threads;
  Facts facts;
  std::vector<Parameter> params;
  std::vector<std::string> later_params;  // not read yet

 private:
  /// is_time: a date of the data of the case is one too.
  std::optional<double> number_in(const Value& value, const std::string& label, bool is_time);
  /// What a date means; nothing after a complaint.
  std::optional<double> time_of_date(const Value& value, const std::string& label);
  /// The tables of the registry as they stand at the top of the file: all [effects.x] lie in one.
  static std::vector<std::string> top_level_tables();
  void check_effects(const Entry& effects);
  /// A table that may be repeated: one table, or a list of tables.
  void check_parts(const Entry& entry);
  /// "; did you mean "overlap"?" or "; it belongs in [time]".
  std::string remedy_for(const std::string& name, const std::vector<std::string>& known, std::string_view table_name);
  /// The answer to a word that is known from other programs, or else the note.
  static std::string answer_to(const std::string& name, const std::string& note);
  void unknown_at_top(const Entry& entry, const std::vector<std::string>& known);
  void check_keys(const Entry& table, const std::string& table_name);
  /// "; it belongs in [time]" for a key that exists elsewhere.
  static std::string home_of(const std::string& name);
  void check_part(const Table& home, const ReadPart& read);
  /// The first kind that the part has, if any.
  std::string_view kind_of_part(const Table& home) const;
  /// Complains about keys of the part that do not go with its kind.
  void check_companions(const Key& kind, const Entry& chosen);
  /// Marks parameters as used; false if one of them has no value because of an earlier error.
  bool use(const std::vector<std::string>& names);
  std::string expression_of(const Value& value, const std::string& label, const std::vector<std::string>& variables,
                            const std::function<std::string(const std::string& token)>& explain);
  void expression_error(const Value& value, const ExpressionError& error, const std::string& message,
                        const std::string& note);

  const Value& root_;
  std::string_view part_table_;  // of a table that may be repeated: the part that is being read
  std::string part_label_;
  const Value* part_ = nullptr;
  std::vector<std::string> meant_;  // tables and keys that a misspelt name was taken for: not missing, then
};

// --- words of messages

std::string without_backticks(std::string_view text);
std::string meaning_note(const Key& key);
std::string quoted_list(const std::vector<std::string_view>& words);
/// "2.5", or "0 (from "R - R")" for an expression.
std::string found_number(double value, const Value& written);

}  // namespace gaussdrift::input
