#include "input/read_case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "base/lattice.hpp"
#include "base/number.hpp"
#include "base/printable.hpp"
#include "base/suggest.hpp"
#include "base/text_file.hpp"
#include "effect/catalogue.hpp"
#include "expression/expression.hpp"
#include "field/density/shapes.hpp"
#include "field/gaussians/gaussian_velocity.hpp"
#include "field/named/named_fields.hpp"
#include "input/diagnostics.hpp"
#include "input/document.hpp"
#include "input/effect_rules.hpp"
#include "input/foreign_keys.hpp"
#include "input/gaussian_table.hpp"
#include "input/registry.hpp"
#include "particle/cutoff.hpp"
#include "read/grid_file.hpp"
#include "render/styles.hpp"
#include "time/tableau.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::input {
namespace {

// A case is a few kilobytes; a long list of output times may take more. Data belong into files of their own.
constexpr std::size_t largest_case_file = 4'000'000;
constexpr double largest_lattice = 2147483648.0;  // 2^31 points: 16 GiB a column
constexpr double most_steps = 2147483648.0;
// An output this close to the end, relative to it, is the end: "2*pi" in two spellings.
constexpr double same_time = 1e-12;

using Kind = Value::Kind;

std::string without_backticks(std::string_view text) {
  std::string plain(text);
  std::erase(plain, '`');
  return plain;
}

/// Titles go to terminals, pages and pictures.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return base::printable(text);
}

std::string meaning_note(const Key& key) {
  return fmt::format("{}: {}", key.name, without_backticks(first_sentence(key.meaning)));
}

std::string quoted_list(const std::vector<std::string_view>& words) {
  std::vector<std::string> shown;
  shown.reserve(words.size());
  for (const auto word : words) shown.push_back(fmt::format("\"{}\"", word));
  return fmt::format("{}", fmt::join(shown, ", "));
}

/// "2.5", or "0 (from "R - R")" for an expression.
std::string found_number(double value, const Value& written) {
  return written.kind == Kind::text ? fmt::format("{} (from \"{}\")", value, written.text) : fmt::format("{}", value);
}

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

/// Turns the tree into a Case. Every read_ function complains about everything wrong in its table and carries on.
class Reader {
 public:
  Reader(const Value& root, const Source& source, Diagnostics& diagnostics, std::filesystem::path folder, int threads)
      : root_(root), source_(source), diagnostics_(diagnostics), folder_(std::move(folder)), threads_(threads) {}

  Case read() {
    Case scene;
    check_names();
    read_version();
    check_tables();
    scene.title = one_line(text("case", "title"));
    scene.cite = one_line(text("case", "cite"));
    read_params(scene.params);
    read_domain(scene.domain);
    read_velocity(scene.velocity);
    read_density(scene.density);
    read_particles(scene.particles, scene.domain);
    read_time(scene.time);
    check_times_of_files();
    read_evaluate(scene.evaluate, scene.domain);
    read_output(scene.output, scene.time);
    read_effects(scene);
    read_reference(scene);
    read_accuracy(scene);
    read_checks(scene);
    if (diagnostics_.errors() == 0) warn_unused_params();
    return scene;
  }

 private:
  // --- structure --------------------------------------------------------------------------------------------------

  void read_version() {
    const Key& key = find_key("", "gaussdrift");
    const Entry* entry = root_.find("gaussdrift");
    if (!entry && is_meant("gaussdrift")) return;
    if (!entry) {
      diagnostics_.error({-1, 1, 0, 1}, "the file does not say which version of the format it has",
                         "begin the file with: gaussdrift = 1");
      return;
    }
    const Value& value = entry->value;
    if (value.kind != Kind::whole)
      diagnostics_.error(value.place,
                         fmt::format("gaussdrift must be the version of the format, found {}", value.description()),
                         "begin the file with: gaussdrift = 1");
    else if (!key.range.contains(value.number))
      diagnostics_.error(value.place,
                         fmt::format("this program reads version {} of the format, the file has version {}",
                                     range_text(key.range), value.whole));
  }

  void check_names() {
    const std::vector<std::string> known = top_level_tables();
    for (const Entry& entry : root_.entries) {
      if (entry.name == "gaussdrift") continue;
      if (std::find(known.begin(), known.end(), entry.name) == known.end())
        unknown_at_top(entry, known);
      else if (entry.name != "effects" && !find_table(entry.name).kinds.empty())
        check_parts(entry);
      else if (entry.value.kind != Kind::table)
        diagnostics_.error(entry.place, fmt::format("{} must be one table [{}], found {}", entry.name, entry.name,
                                                    entry.value.description()));
      else if (entry.name == "effects")
        check_effects(entry);
      else if (entry.name != "params")
        check_keys(entry, entry.name);
    }
  }

  /// The tables of the registry as they stand at the top of the file: all [effects.x] lie in one.
  static std::vector<std::string> top_level_tables() {
    std::vector<std::string> names;
    for (const std::string& name : table_names()) {
      const std::string top = name.substr(0, name.find('.'));
      if (std::find(names.begin(), names.end(), top) == names.end()) names.push_back(top);
    }
    return names;
  }

  void check_effects(const Entry& effects) {
    const std::vector<std::string> known = effect_names();
    for (const Entry& entry : effects.value.entries) {
      if (std::find(known.begin(), known.end(), entry.name) == known.end()) {
        const auto near = base::suggest(entry.name, known);
        diagnostics_.error(entry.place,
                           fmt::format("unknown effect \"{}\"{}", entry.name,
                                       near ? fmt::format("; did you mean [effects.{}]?", *near) : ""),
                           answer_to(entry.name, fmt::format("known effects: {}", fmt::join(known, ", "))));
      } else if (entry.value.kind != Kind::table) {
        diagnostics_.error(entry.place, fmt::format("effects.{0} must be one table [effects.{0}], found {1}",
                                                    entry.name, entry.value.description()));
      } else {
        check_keys(entry, "effects." + entry.name);
      }
    }
  }

  /// A table that may be repeated: one table, or a list of tables.
  void check_parts(const Entry& entry) {
    const Value& value = entry.value;
    const bool several =
        value.kind == Kind::list && !value.items.empty() &&
        std::all_of(value.items.begin(), value.items.end(), [](const Value& item) { return item.kind == Kind::table; });
    if (value.kind != Kind::table && !several)
      diagnostics_.error(entry.place, fmt::format("{} must be a table [{}], or several tables [[{}]], found {}",
                                                  entry.name, entry.name, entry.name, value.description()));
  }

  void check_tables() {
    std::vector<std::string> missing;
    for (const Table& table : tables())
      if (table.required && !root_.find(std::string(table.name)) && !is_meant(table.name))
        missing.push_back(fmt::format("[{}]", table.name));
    if (!missing.empty())
      diagnostics_.error(source_.end(),
                         fmt::format("missing table{}: {}", missing.size() == 1 ? "" : "s", fmt::join(missing, ", ")),
                         "a case has at least [domain], [velocity], [density], [particles] and [time]");
  }

  bool is_meant(std::string_view label) const { return std::find(meant_.begin(), meant_.end(), label) != meant_.end(); }

  /// "; did you mean "overlap"?" or "; it belongs in [time]".
  std::string remedy_for(const std::string& name, const std::vector<std::string>& known, std::string_view table_name) {
    if (const ForeignKey* foreign = find_foreign_key(name)) {
      if (foreign->key.empty()) return "";
      meant_.emplace_back(foreign->key);
      return fmt::format("; did you mean {}?", foreign->key);
    }
    const auto near = base::suggest(name, known);
    if (!near) return home_of(name);
    meant_.push_back(table_name.empty() ? *near : fmt::format("{}.{}", table_name, *near));
    const bool is_table = table_name.empty() && *near != "gaussdrift";
    return fmt::format("; did you mean {}?", is_table ? fmt::format("[{}]", *near) : fmt::format("\"{}\"", *near));
  }

  /// The answer to a word that is known from other programs, or else the note.
  static std::string answer_to(const std::string& name, const std::string& note) {
    const ForeignKey* foreign = find_foreign_key(name);
    return foreign ? std::string(foreign->answer) : note;
  }

  void unknown_at_top(const Entry& entry, const std::vector<std::string>& known) {
    const bool is_table = entry.value.kind == Kind::table;
    std::vector<std::string> candidates = known;
    if (!is_table) candidates.emplace_back("gaussdrift");
    const std::vector<std::string> effects = effect_names();
    const bool is_effect = std::find(effects.begin(), effects.end(), entry.name) != effects.end();
    const std::string remedy =
        is_effect ? fmt::format("; did you mean [effects.{}]?", entry.name) : remedy_for(entry.name, candidates, "");
    diagnostics_.error(entry.place,
                       is_table ? fmt::format("unknown table [{}]{}", entry.name, remedy)
                                : fmt::format("unknown key \"{}\" at the top of the file{}", entry.name, remedy),
                       answer_to(entry.name, fmt::format("known tables: {}", fmt::join(known, ", "))));
  }

  void check_keys(const Entry& table, const std::string& table_name) {
    const std::vector<std::string> known = key_names(table_name);
    for (const Entry& entry : table.value.entries) {
      if (std::find(known.begin(), known.end(), entry.name) != known.end()) continue;
      const std::string remedy = remedy_for(entry.name, known, table_name);
      diagnostics_.error(entry.place, fmt::format("unknown key \"{}\" in [{}]{}", entry.name, table_name, remedy),
                         answer_to(entry.name, fmt::format("known keys: {}", fmt::join(known, ", "))));
    }
  }

  /// "; it belongs in [time]" for a key that exists elsewhere.
  static std::string home_of(const std::string& name) {
    std::vector<std::string> homes;
    for (const Key& key : keys())
      if (key.name == name && !key.table.empty()) homes.push_back(fmt::format("[{}]", key.table));
    return homes.empty() ? "" : fmt::format("; it belongs in {}", fmt::join(homes, " or "));
  }

  /// The table, or the part of it that is being read.
  const Value* table(std::string_view name) const {
    if (part_ && name == part_table_) return part_;
    const Value* home = &root_;
    for (std::size_t first = 0; first <= name.size();) {  // "effects.reaction" is a table in a table
      const std::size_t dot = std::min(name.find('.', first), name.size());
      const Entry* entry = home->find(std::string(name.substr(first, dot - first)));
      if (!entry || entry->value.kind != Kind::table) return nullptr;
      home = &entry->value;
      first = dot + 1;
    }
    return home;
  }

  const Entry* find(std::string_view table_name, std::string_view name) const {
    const Value* home = table(table_name);
    return home ? home->find(std::string(name)) : nullptr;
  }

  /// "velocity", or "velocity[2]" for the second of several parts.
  std::string label_of(std::string_view table_name) const {
    return part_ && table_name == part_table_ ? part_label_ : std::string(table_name);
  }
  std::string label_of(const Key& key) const {
    return key.table.empty() ? std::string(key.name) : fmt::format("{}.{}", label_of(key.table), key.name);
  }

  /// The entry of a required key, or a complaint at the head of its table (a missing table has been complained about).
  const Entry* require(const Key& key) {
    const Entry* entry = find(key.table, key.name);
    const Value* home = table(key.table);
    if (!entry && home && !is_meant(label_of(key)))
      diagnostics_.error(home->place, fmt::format("{} is missing", label_of(key)), meaning_note(key));
    return entry;
  }

  void wrong_type(const Value& value, const std::string& label, const std::string& wanted) {
    diagnostics_.error(value.place, fmt::format("{} must be {}, found {}", label, wanted, value.description()));
  }

  /// The one key of several that exclude each other; nothing, after a complaint, if there is none or more than one.
  std::optional<std::string_view> exactly_one(std::string_view table_name, const std::vector<std::string_view>& names) {
    const Value* home = table(table_name);
    std::vector<const Entry*> found;
    bool misspelt = false;
    for (const auto name : names) {
      if (const Entry* entry = find(table_name, name)) found.push_back(entry);
      misspelt = misspelt || is_meant(fmt::format("{}.{}", label_of(table_name), name));
    }
    if (found.size() == 1)
      return *std::find_if(names.begin(), names.end(), [&](std::string_view name) { return name == found[0]->name; });
    const std::string rule = fmt::format("give exactly one of {}", quoted_list(names));
    std::sort(found.begin(), found.end(),
              [](const Entry* a, const Entry* b) { return comes_before(a->place, b->place); });
    if (found.size() > 1)
      diagnostics_.error(found[1]->place,
                         fmt::format("[{}] has both \"{}\" and \"{}\"", table_name, found[0]->name, found[1]->name),
                         rule);
    else if (home && !misspelt)
      diagnostics_.error(home->place, fmt::format("[{}] has none of {}", table_name, quoted_list(names)), rule);
    return std::nullopt;
  }

  /// Calls read(kind, value of that key) for each part of a table that may be repeated. Keys that do not go with the
  /// kind, or with the formula named there, have been complained about.
  template <class Read>
  void each_part(std::string_view table_name, const Read& read) {
    const Entry* entry = root_.find(std::string(table_name));
    if (!entry) return;
    const Value& value = entry->value;
    const bool several = value.kind == Kind::list;
    const std::size_t count = several ? value.items.size() : 1;
    for (std::size_t k = 0; k < count; ++k) {
      part_ = several ? &value.items[k] : &value;
      if (part_->kind != Kind::table) continue;
      part_table_ = table_name;
      part_label_ = count > 1 ? fmt::format("{}[{}]", table_name, k + 1) : std::string(table_name);
      check_part(find_table(table_name), read);
    }
    part_ = nullptr;
  }

  template <class Read>
  void check_part(const Table& home, const Read& read) {
    const std::vector<std::string> all = key_names(home.name);
    for (const Entry& entry : part_->entries) {
      if (std::find(all.begin(), all.end(), entry.name) != all.end()) continue;
      const auto kind = kind_of_part(home);
      const std::vector<std::string> known =
          kind.empty() ? all : key_names(home.name, kind, part_->find(std::string(kind))->value.text);
      const std::string remedy = remedy_for(entry.name, known, label_of(home.name));
      diagnostics_.error(entry.place, fmt::format("unknown key \"{}\" in [{}]{}", entry.name, home.name, remedy),
                         answer_to(entry.name, fmt::format("known keys: {}", fmt::join(known, ", "))));
    }
    const auto kind = exactly_one(home.name, home.kinds);
    if (!kind) return;
    const Entry& chosen = *find(home.name, *kind);
    const Key& key = find_key(home.name, *kind);
    if (key.type == Type::choice && !choice_in(chosen.value, key, label_of(key))) return;
    check_companions(key, chosen);
    read(*kind, chosen.value);
  }

  /// The first kind that the part has, if any.
  std::string_view kind_of_part(const Table& home) const {
    for (const auto kind : home.kinds)
      if (part_->find(std::string(kind))) return kind;
    return {};
  }

  /// Complains about keys of the part that do not go with its kind.
  void check_companions(const Key& kind, const Entry& chosen) {
    const std::string named = kind.type == Type::choice ? chosen.value.text : "";
    const auto known = key_names(kind.table, kind.name, named);
    for (const Entry& entry : part_->entries) {
      if (&entry == &chosen || std::find(known.begin(), known.end(), entry.name) != known.end()) continue;
      std::vector<std::string> homes;
      for (const Key& key : keys()) {
        if (key.table != kind.table || key.name != entry.name) continue;
        if (key.value.empty())
          homes.push_back(fmt::format("\"{}\"", key.with));
        else if (homes.empty())
          homes.push_back(fmt::format("{} = \"{}\"", key.with, key.value));
        else
          homes.push_back(fmt::format("\"{}\"", key.value));
      }
      if (homes.empty()) continue;  // unknown: complained about already
      const std::string chosen_text =
          named.empty() ? fmt::format("\"{}\"", kind.name) : fmt::format("{} = \"{}\"", kind.name, named);
      diagnostics_.error(
          entry.place,
          fmt::format("\"{}\" goes with {}, not with {}", entry.name, fmt::join(homes, " or "), chosen_text),
          fmt::format("known keys with {}: {}", chosen_text, fmt::join(known, ", ")));
    }
  }

  // --- values -----------------------------------------------------------------------------------------------------

  std::string text(std::string_view table_name, std::string_view name) {
    const Key& key = find_key(table_name, name);
    const Entry* entry = find(table_name, name);
    if (!entry) return std::string(key.fallback);
    if (entry->value.kind != Kind::text) wrong_type(entry->value, label_of(key), type_text(key));
    return entry->value.text;
  }

  std::vector<std::pair<std::string, double>> constants() const {
    std::vector<std::pair<std::string, double>> list;
    for (const Parameter& parameter : params_) list.emplace_back(parameter.name, parameter.value);
    return list;
  }

  /// Marks parameters as used; false if one of them has no value because of an earlier error.
  bool use(const std::vector<std::string>& names) {
    bool valid = true;
    for (Parameter& parameter : params_)
      if (std::find(names.begin(), names.end(), parameter.name) != names.end()) {
        parameter.used = true;
        valid = valid && parameter.valid;
      }
    return valid;
  }

  void expression_error(const Value& value, const ExpressionError& error, const std::string& message,
                        const std::string& note) {
    diagnostics_.error(place_in_text(value, source_, error.position(), error.length()), message, note);
  }

  /// A number or an expression of the params, finite. Nothing after a complaint.
  std::optional<double> number_in(const Value& value, const std::string& label) {
    double number = value.number;
    if (value.kind == Kind::text) {
      try {
        const Expression expression(value.text, {}, constants());
        if (!use(expression.used_names())) return std::nullopt;
        number = expression.evaluate();
      } catch (const ExpressionError& error) {
        const std::string token = value.text.substr(std::min(error.position(), value.text.size()), error.length());
        std::string message = error.what();
        if (token == "x" || token == "y" || token == "z" || token == "t")
          message = fmt::format("\"{}\" has no value here: {} is one number for the whole run", token, label);
        else if (std::find(later_params_.begin(), later_params_.end(), token) != later_params_.end())
          message = fmt::format("\"{}\" is not defined yet; a parameter may use those before it", token);
        expression_error(value, error, message, fmt::format("{} may be an expression of the params, pi and e", label));
        return std::nullopt;
      }
    } else if (value.kind != Kind::whole && value.kind != Kind::number) {
      wrong_type(value, label, "a number or an expression");
      return std::nullopt;
    }
    if (!std::isfinite(number)) {
      diagnostics_.error(value.place, fmt::format("{} must be finite, found {}", label, found_number(number, value)));
      return std::nullopt;
    }
    return number;
  }

  /// The same for a key, in its range; its default if it is absent.
  std::optional<Number> number(std::string_view table_name, std::string_view name, const std::string& note = "") {
    const Key& key = find_key(table_name, name);
    const Entry* entry = key.required ? require(key) : find(table_name, name);
    if (!entry) {
      double value = 0;
      const auto read = std::from_chars(key.fallback.data(), key.fallback.data() + key.fallback.size(), value);
      return read.ec == std::errc() ? std::optional(Number{value, nullptr}) : std::nullopt;
    }
    const auto value = number_of(key, *entry, note);
    return value ? std::optional(Number{*value, &entry->value}) : std::nullopt;
  }

  std::optional<double> number_of(const Key& key, const Entry& entry, const std::string& note = "") {
    const auto value = number_in(entry.value, label_of(key));
    return value && check_range(key, *value, entry.value, note) ? value : std::nullopt;
  }

  /// The parameters of a named formula, all of them if nothing was complained about.
  Arguments arguments(const Key& kind, const NamedFormula& formula, const Value& written) {
    if (dimension_ && (dimension_ < formula.least_dimension || dimension_ > formula.most_dimension))
      diagnostics_.error(written.place, fmt::format("\"{}\" exists only in {}D; the domain has {} dimensions",
                                                    formula.name, formula.least_dimension, dimension_));
    Arguments given;
    for (const NamedParameter& parameter : formula.parameters) {
      const Key& key = find_key(kind.table, parameter.name, formula.name);
      const Entry* entry = key.required ? require(key) : find(key.table, key.name);
      if (!entry) continue;
      if (key.type == Type::point) {
        if (const auto values = point_of(key, *entry)) given.emplace_back(key.name, *values);
      } else if (const auto value = number_of(key, *entry)) {
        given.emplace_back(key.name, std::vector{*value});
      }
    }
    if (diagnostics_.errors() > 0) return given;
    const Arguments all = complete(formula, given, box_);
    const std::string problem = formula.problem ? formula.problem(dimension_, all) : "";
    if (!problem.empty()) diagnostics_.error(written.place, fmt::format("{}: {}", formula.name, problem));
    return all;
  }

  bool check_range(const Key& key, double value, const Value& written, const std::string& note = "") {
    std::string rule;
    if (key.type == Type::whole && value != std::floor(value)) rule = "a whole number";
    if (!key.range.contains(value)) rule = range_text(key.range);
    if (rule.empty()) return true;
    diagnostics_.error(written.place,
                       fmt::format("{} must be {}, found {}", label_of(key), rule, found_number(value, written)),
                       note.empty() ? meaning_note(key) : note);
    return false;
  }

  /// A list of numbers; nothing if one of them was complained about.
  std::optional<std::vector<double>> numbers(const Entry& entry, const Key& key) {
    if (entry.value.kind != Kind::list) {
      wrong_type(entry.value, label_of(key), type_text(key));
      return std::nullopt;
    }
    std::vector<double> list;
    bool valid = true;
    for (std::size_t k = 0; k < entry.value.items.size(); ++k) {
      const auto value = number_in(entry.value.items[k], fmt::format("entry {} of {}", k + 1, label_of(key)));
      valid = valid && value;
      list.push_back(value.value_or(0));
    }
    return valid ? std::optional(list) : std::nullopt;
  }

  /// A list of as many numbers as there are dimensions, each in the key's range.
  std::optional<std::vector<double>> point_of(const Key& key, const Entry& entry) {
    const auto list = numbers(entry, key);
    if (!list || (dimension_ && !has_entries(entry.value, key, "number"))) return std::nullopt;
    for (std::size_t k = 0; k < list->size(); ++k)
      if (!check_range(key, (*list)[k], entry.value.items[k])) return std::nullopt;
    return list;
  }

  /// As many entries as the domain has dimensions?
  bool has_entries(const Value& value, const Key& key, std::string_view what) {
    if (value.items.size() == static_cast<std::size_t>(dimension_)) return true;
    diagnostics_.error(value.place, fmt::format("{} needs {} {}s, one for each axis of the domain, found {}",
                                                label_of(key), dimension_, what, value.items.size()));
    return false;
  }

  /// One of the key's choices; the index, or nothing after a complaint.
  std::optional<std::size_t> choice_in(const Value& value, const Key& key, const std::string& label) {
    const std::string note = fmt::format("known values: {}", quoted_list(key.choices));
    if (value.kind != Kind::text) {
      diagnostics_.error(value.place, fmt::format("{} must be a string, found {}", label, value.description()), note);
      return std::nullopt;
    }
    const auto found = std::find(key.choices.begin(), key.choices.end(), value.text);
    if (found != key.choices.end()) return static_cast<std::size_t>(found - key.choices.begin());
    const auto near = base::suggest(value.text, {key.choices.begin(), key.choices.end()});
    diagnostics_.error(value.place,
                       fmt::format("unknown value \"{}\" for {}{}", value.text, label,
                                   near ? fmt::format("; did you mean \"{}\"?", *near) : ""),
                       find_foreign_key(value.text) ? answer_to(value.text, "") + "; " + note : note);
    return std::nullopt;
  }

  std::string choice(std::string_view table_name, std::string_view name) {
    const Key& key = find_key(table_name, name);
    const Entry* entry = find(table_name, name);
    const auto index = entry ? choice_in(entry->value, key, label_of(key)) : std::nullopt;
    return std::string(index ? key.choices[*index] : key.fallback);
  }

  /// Those of the key's choices that are in the list of the file, as indices; the default ones if it has none.
  std::vector<std::size_t> choices(std::string_view table_name, std::string_view name) {
    const Key& key = find_key(table_name, name);
    const Entry* entry = find(table_name, name);
    std::vector<std::size_t> result;
    if (!entry) {  // the default: those choices that the registry names
      const auto named = [&](std::string_view word) {
        const auto words = ", " + std::string(key.fallback) + ",";
        return words.find(fmt::format(", {},", word)) != std::string::npos;
      };
      for (std::size_t k = 0; k < key.choices.size(); ++k)
        if (named(key.choices[k])) result.push_back(k);
      return result;
    }
    if (entry->value.kind != Kind::list) {
      wrong_type(entry->value, label_of(key), type_text(key));
      return result;
    }
    for (std::size_t k = 0; k < entry->value.items.size(); ++k) {
      const Value& item = entry->value.items[k];
      if (const auto index = choice_in(item, key, fmt::format("entry {} of {}", k + 1, label_of(key)))) {
        if (std::find(result.begin(), result.end(), *index) != result.end())
          diagnostics_.error(item.place, fmt::format("\"{}\" appears twice in {}", item.text, label_of(key)));
        result.push_back(*index);
      }
    }
    return result;
  }

  /// An expression of position, perhaps time; compiled here to find its errors. A plain number is one too.
  std::string field_expression(const Value& value, const std::string& label, bool with_time) {
    if (value.kind == Kind::whole || value.kind == Kind::number) {
      if (!std::isfinite(value.number))
        diagnostics_.error(value.place, fmt::format("{} must be finite, found {}", label, value.number));
      return value.kind == Kind::whole ? fmt::format("{}", value.whole) : fmt::format("{}", value.number);
    }
    if (value.kind != Kind::text) {
      wrong_type(value, label, "an expression in a string");
      return "";
    }
    std::vector<std::string> variables{"x", "y"};
    if (dimension_ != 2) variables.emplace_back("z");
    if (with_time) variables.emplace_back("t");
    try {
      use(Expression(value.text, variables, constants()).used_names());
    } catch (const ExpressionError& error) {
      const std::string token = value.text.substr(std::min(error.position(), value.text.size()), error.length());
      std::string message = error.what();
      if (token == "z" && dimension_ == 2) message = "z exists only in 3D; the domain has 2 dimensions";
      if (token == "t" && !with_time) message = "the density at the start cannot depend on t";
      expression_error(value, error, message, "");
    }
    return value.text;
  }

  // --- tables, in the order of the registry -----------------------------------------------------------------------

  void read_params(Params& params) {
    const Value* home = table("params");
    if (!home) return;
    for (const Entry& entry : home->entries) later_params_.push_back(entry.name);
    for (const Entry& entry : home->entries) {
      const bool named = check_param_name(entry);
      const auto value = number_in(entry.value, fmt::format("params.{}", entry.name));
      std::erase(later_params_, entry.name);
      if (!named) continue;
      params_.push_back({entry.name, value.value_or(1), entry.place, value.has_value(), false});
      params.emplace_back(entry.name, value.value_or(1));
    }
  }

  bool check_param_name(const Entry& entry) {
    const std::string& name = entry.name;
    std::string why;
    if (!is_name(name) || name.size() > 100)
      why = fmt::format(
          "\"{}\" cannot be a parameter's name: at most 100 letters, digits and _, beginning with a letter or _", name);
    else if (name == "x" || name == "y" || name == "z")
      why = fmt::format("\"{}\" cannot be a parameter's name: it is a coordinate", name);
    else if (name == "t")
      why = "\"t\" cannot be a parameter's name: it is the time";
    else if (is_reserved_name(name))
      why = fmt::format("\"{}\" cannot be a parameter's name: it is a {}", name,
                        name == "pi" || name == "e" ? "constant" : "function");
    if (!why.empty()) diagnostics_.error(entry.place, why, "reserved names: x, y, z, t, pi, e and the functions");
    return why.empty();
  }

  void warn_unused_params() {
    for (const Parameter& parameter : params_)
      if (!parameter.used)
        diagnostics_.warning(parameter.place, fmt::format("the parameter \"{}\" is not used", parameter.name),
                             "no expression of the case mentions it");
  }

  void read_domain(Domain& domain) {
    const Key &min_key = find_key("domain", "min"), &max_key = find_key("domain", "max");
    const Entry *min_entry = require(min_key), *max_entry = require(max_key);
    const auto min = min_entry ? numbers(*min_entry, min_key) : std::nullopt;
    const auto max = max_entry ? numbers(*max_entry, max_key) : std::nullopt;
    const bool min_fits = min && is_corner(min_entry->value, min_key),
               max_fits = max && is_corner(max_entry->value, max_key);
    if (min_fits && max_fits && min->size() != max->size()) {
      diagnostics_.error(max_entry->value.place,
                         fmt::format("domain.min has {} numbers, domain.max has {}", min->size(), max->size()),
                         "2 numbers each in 2D, 3 in 3D");
      return;
    }
    if (min_fits || max_fits) dimension_ = static_cast<int>(min_fits ? min->size() : max->size());
    if (!min_fits || !max_fits) return;
    domain.dimension = dimension_;
    bool valid = true;
    for (std::size_t k = 0; k < min->size(); ++k) {
      const double lower = (*min)[k], upper = (*max)[k];
      domain.min[k] = lower, domain.max[k] = upper;
      if (lower < upper && std::isfinite(upper - lower)) continue;
      valid = false;
      diagnostics_.error(max_entry->value.items[k].place,
                         lower < upper
                             ? fmt::format("the domain is too wide along {} for double precision", "xyz"[k])
                             : fmt::format("the domain is empty along {}: min = {}, max = {}", "xyz"[k], lower, upper),
                         "min must be less than max on every axis");
    }
    domain_valid_ = valid;
    box_ = {domain.dimension, domain.min, domain.max};
  }

  bool is_corner(const Value& value, const Key& key) {
    if (value.items.size() == 2 || value.items.size() == 3) return true;
    diagnostics_.error(value.place, fmt::format("{} needs 2 numbers (2D) or 3 numbers (3D), found {}", label_of(key),
                                                value.items.size()));
    return false;
  }

  void read_velocity(std::vector<VelocitySpec>& velocity) {
    each_part("velocity", [&](std::string_view kind, const Value& value) {
      if (kind == "u") velocity.emplace_back(expression_velocity(value));
      if (kind == "file") velocity.emplace_back(grid_file<FileVelocity>("velocity", value, dimension_, 3));
      if (kind == "gaussians") velocity.emplace_back(gaussians(value));
      if (kind == "streamfunction") velocity.emplace_back(streamfunction(value));
      if (kind == "field")
        velocity.emplace_back(NamedVelocity{
            value.text, arguments(find_key("velocity", kind), find_named_field(value.text).about, value)});
    });
  }

  /// Data on a grid, read at once so that everything wrong with it has its place in the case file.
  template <class FileSpec>
  FileSpec grid_file(std::string_view table_name, const Value& value, int least_components, int most_components) {
    FileSpec spec;
    spec.arrays = array_names(table_name, most_components);
    spec.interpolation = choice(table_name, "interpolation");
    spec.outside = choice(table_name, "outside");
    spec.missing = choice(table_name, "missing");
    if (const auto mark = number(table_name, "missing_value")) spec.missing_value = mark->number;
    if (value.kind != Kind::text) {
      wrong_type(value, label_of(find_key(table_name, "file")), "the name of a file in a string");
      return spec;
    }
    if (!dimension_) return spec;
    spec.file = std::filesystem::absolute(folder_ / value.text).lexically_normal();
    try {
      const auto missing = std::find(read::missing_names.begin(), read::missing_names.end(), spec.missing);
      spec.data =
          read::read_grid(spec.file, {.arrays = spec.arrays,
                                      .dimension = dimension_,
                                      .least_components = static_cast<std::size_t>(least_components),
                                      .most_components = static_cast<std::size_t>(most_components),
                                      .missing = static_cast<read::Missing>(missing - read::missing_names.begin()),
                                      .missing_value = spec.missing_value,
                                      .decays = most_components == 1});
      grid_files_.push_back({value.place, spec.data});
      if (spec.outside == "error" && most_components == 1) check_covers_domain(*spec.data, value.place);
    } catch (const read::GridFileError& error) {
      diagnostics_.error(value.place, error.what(), error.remedy());
    }
    return spec;
  }

  /// Particles start in the whole domain, so a density must be known there.
  void check_covers_domain(const GridData& data, const Place& place) {
    for (int k = 0; domain_valid_ && k < dimension_; ++k) {
      const double least = data.axis[k].front(), most = data.axis[k].back();
      const double rounding = std::max(data.rounding[k], 1e-12 * (most - least));
      const auto axis = static_cast<std::size_t>(k);
      if (box_.min[axis] >= least - rounding && box_.max[axis] <= most + rounding) continue;
      diagnostics_.error(
          place,
          fmt::format("{} reaches from {} to {} along {}, the domain from {} to {}", data.name,
                      base::told_apart(least, box_.min[axis]), base::told_apart(most, box_.max[axis]), "xyz"[k],
                      base::told_apart(box_.min[axis], least), base::told_apart(box_.max[axis], most)),
          "outside = \"zero\" or \"clamp\" says what stands beyond the data; or make the domain smaller");
      return;
    }
  }

  /// "array", or "arrays" where several have one component each.
  std::vector<std::string> array_names(std::string_view table_name, int most_components) {
    const Entry* single = find(table_name, "array");
    const Entry* several = most_components > 1 ? find(table_name, "arrays") : nullptr;
    if (single && several) {
      diagnostics_.error(comes_before(single->place, several->place) ? several->place : single->place,
                         fmt::format("[{}] has both \"array\" and \"arrays\"", table_name),
                         "\"array\" names one array with all components, \"arrays\" one for each");
      return {};
    }
    if (!several) {
      const std::string name = text(table_name, "array");
      return name.empty() ? std::vector<std::string>{} : std::vector{name};
    }
    const Key& key = find_key(table_name, "arrays");
    std::vector<std::string> names;
    for (const Value& item : several->value.items) names.push_back(item.kind == Kind::text ? item.text : "");
    if (several->value.kind != Kind::list || std::find(names.begin(), names.end(), "") != names.end()) {
      wrong_type(several->value, label_of(key), "a list of names in strings");
      return {};
    }
    if (dimension_) has_entries(several->value, key, "name");
    return names;
  }

  /// Divergence-free Gaussians, read and fitted at once so that everything wrong with them has its place in the case
  /// file.
  GaussianVelocitySpec gaussians(const Value& value) {
    const int errors_before = diagnostics_.errors();
    GaussianVelocitySpec spec;
    spec.kind = choice("velocity", "kind");
    const auto named = std::find(gaussian_kind_names.begin(), gaussian_kind_names.end(), spec.kind);
    GaussianModelOptions options;
    options.kind = static_cast<GaussianKind>(named - gaussian_kind_names.begin());
    options.fit.threads = threads_;
    if (const auto width = number("velocity", "width")) options.width = width->number;
    if (const auto tolerance = number("velocity", "tolerance")) spec.tolerance = options.tolerance = tolerance->number;
    if (is_fitted(options.kind)) {
      if (const auto residual = number("velocity", "residual")) spec.residual = options.fit.residual = residual->number;
      if (const auto lambda = number("velocity", "regularisation"))
        options.fit.regularisation = lambda->number;
      else
        options.regularise = true;
    } else {
      for (const char* key : {"residual", "regularisation"})
        if (const Entry* entry = find("velocity", key))
          diagnostics_.error(entry->place,
                             fmt::format("\"{}\" is for fits to samples; kind = \"{}\" takes coefficients as "
                                         "they are",
                                         key, spec.kind));
    }
    if (value.kind != Kind::text)
      wrong_type(value, label_of(find_key("velocity", "gaussians")), "the name of a file in a string");
    if (!dimension_ || diagnostics_.errors() > errors_before) return spec;
    spec.file = std::filesystem::absolute(folder_ / value.text).lexically_normal();
    try {
      const GaussianTable table = read_gaussian_table(spec.file, options.kind, dimension_);
      spec.model = std::make_shared<const GaussianModel>(
          make_gaussian_model(dimension_, table.positions, table.values, options));
      spec.regularisation = spec.model->regularisation;
    } catch (const Error& error) {
      diagnostics_.error(value.place, error.what());
    }
    return spec;
  }

  /// Data at several times must cover the run.
  void check_times_of_files() {
    if (!end_) return;
    for (const auto& [place, data] : grid_files_) {
      const double first = data->times.front(), last = data->times.back();
      if (data->times.size() > 1 && (first > same_time * *end_ || last < *end_ * (1 - same_time)))
        diagnostics_.error(
            place,
            fmt::format("{} covers the times {} to {}, but the run goes from 0 to {}", data->name, first, last, *end_),
            "shorten time.end, or let the data cover the run");
    }
  }

  StreamfunctionVelocity streamfunction(const Value& value) {
    const std::string label = label_of(find_key("velocity", "streamfunction"));
    if (dimension_ == 3)
      diagnostics_.error(value.place, fmt::format("{} exists only in 2D; the domain has 3 dimensions", label),
                         "in 3D write u = [...]");
    const int errors_before = diagnostics_.errors();
    const std::string psi = field_expression(value, label, true);
    if (diagnostics_.errors() > errors_before || dimension_ != 2) return {psi};
    for (const RoughSpot& spot : Expression(psi, {"x", "y", "t"}, constants()).rough_spots()) {
      const std::size_t at = spot.name.empty() ? std::string::npos : psi.find(spot.name);
      diagnostics_.warning(at == std::string::npos ? value.place : place_in_text(value, source_, at, spot.name.size()),
                           fmt::format("the streamfunction has no derivative everywhere: {}", spot.taken),
                           "the velocity is its derivative; it is right where particles do not meet such a place");
    }
    return {psi};
  }

  ExpressionVelocity expression_velocity(const Value& value) {
    const Key& key = find_key("velocity", "u");
    const std::string label = label_of(key);
    ExpressionVelocity field;
    if (value.kind != Kind::list) {
      wrong_type(value, label, type_text(key));
      return field;
    }
    if (dimension_) has_entries(value, key, "expression");
    for (std::size_t k = 0; k < value.items.size(); ++k)
      field.components.push_back(field_expression(value.items[k], fmt::format("entry {} of {}", k + 1, label), true));
    return field;
  }

  void read_density(std::vector<DensitySpec>& density) {
    each_part("density", [&](std::string_view kind, const Value& value) {
      const Key& key = find_key("density", kind);
      if (kind == "expression") density.emplace_back(ExpressionDensity{field_expression(value, label_of(key), false)});
      if (kind == "file") density.emplace_back(grid_file<FileDensity>("density", value, 1, 1));
      if (kind == "shape")
        density.emplace_back(ShapeDensity{value.text, arguments(key, find_named_shape(value.text).about, value)});
    });
  }

  void read_particles(ParticleSpec& particles, const Domain& domain) {
    if (const auto count = per_axis("particles", "one particle an axis has no spacing")) {
      if (const auto lattice = make_checked_lattice("particle lattice", domain, *count)) warn_thin(*lattice, *count);
      particles.per_axis = to_int(*count);
    }
    particles.cutoff = choice("particles", "cutoff");
    // Where weights can grow, those that are next to nothing at the start count.
    const bool grow = std::any_of(effects().begin(), effects().end(), [&](const NamedEffect& effect) {
      return !effect.traits.grows_weights.words.empty() && table(table_of(effect));
    });
    if (const auto threshold = number("particles", "threshold"))
      particles.threshold = threshold->written || !grow ? threshold->number : 0;
    const bool valid = read_cutoff_arguments(particles);
    if (const auto overlap = number("particles", "overlap")) {
      particles.overlap = overlap->number;
      if (overlap->written && valid) warn_small_overlap(particles, *overlap);
    }
  }

  /// False if the cutoff cannot be made from them.
  bool read_cutoff_arguments(ParticleSpec& particles) {
    const NamedCutoff& chosen = find_cutoff(particles.cutoff);
    for (const NamedCutoff& other : cutoffs())
      for (const NamedParameter& parameter : other.parameters)
        if (const Entry* entry = find("particles", parameter.name); entry && &other != &chosen)
          diagnostics_.error(entry->place, fmt::format("\"{}\" goes with cutoff = \"{}\", not with \"{}\"",
                                                       parameter.name, other.name, particles.cutoff));
    for (const NamedParameter& parameter : chosen.parameters)
      if (const auto value = number("particles", parameter.name))
        particles.cutoff_arguments.emplace_back(parameter.name, std::vector{value->number});
    if (!chosen.problems) return true;
    const auto problems = chosen.problems(complete(chosen.name, chosen.parameters, particles.cutoff_arguments, {}));
    for (const Complaint& problem : problems)
      diagnostics_.error(find("particles", problem.key)->value.place, problem.message, problem.remedy);
    return problems.empty();
  }

  /// The density of equal blobs on a lattice ripples by 2 d zeta^(2 pi c), zeta^ the Fourier transform of the cutoff
  /// (Poisson's sum).
  void warn_small_overlap(const ParticleSpec& particles, const Number& overlap) {
    const Cutoff cutoff = make_cutoff(particles.cutoff, 1, 1, particles.cutoff_arguments);
    if (narrowest_width(cutoff) * particles.overlap >= 1) return;
    const double ripple =
        2 * (dimension_ ? dimension_ : 2) * std::abs(fourier(cutoff, 1, 2 * std::numbers::pi * particles.overlap));
    diagnostics_.warning(overlap.written->place,
                         fmt::format("overlap = {} leaves gaps between the blobs: a constant density ripples by {:.1g}",
                                     particles.overlap, ripple),
                         "2 is usual; 1 ripples by about 2e-4");
  }

  void warn_thin(const Lattice& lattice, const Number& count) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(lattice.dimension); ++k)
      if ((one_particle_across_[k] = lattice.points[k] == 1))
        diagnostics_.warning(count.written->place,
                             fmt::format("the domain is narrower along {} than the spacing {:.3g}: one particle across",
                                         "xyz"[k], lattice.spacing),
                             "raise per_axis or widen the domain");
  }

  std::optional<Number> per_axis(std::string_view table_name, std::string_view why_not_one) {
    const Entry* entry = find(table_name, "per_axis");
    const Key& key = find_key(table_name, "per_axis");
    return number(table_name, "per_axis", entry ? fmt::format("{}; {}", meaning_note(key), why_not_one) : "");
  }

  /// Only for numbers that passed their range; larger ones have been complained about.
  static int to_int(const Number& count) {
    return static_cast<int>(std::min<double>(count.number, std::numeric_limits<int>::max()));
  }

  /// The lattice, or nothing (with a complaint) if it has too many points; it is not allocated.
  std::optional<Lattice> make_checked_lattice(const std::string& what, const Domain& domain, const Number& count) {
    if (!domain_valid_) return std::nullopt;
    const Place place = count.written ? count.written->place : source_.end();
    const auto limit = static_cast<long long>(largest_lattice);
    if (count.number > largest_lattice - 1) {
      diagnostics_.error(place,
                         fmt::format("the {} would have {} points on one axis; at most {} in all are possible", what,
                                     count.number, limit),
                         "lower per_axis");
      return std::nullopt;
    }
    const Lattice lattice = make_lattice(domain.dimension, domain.min, domain.max, to_int(count));
    double size = 1;
    std::vector<std::size_t> points;
    for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k) {
      points.push_back(lattice.points[k]);
      size *= static_cast<double>(lattice.points[k]);
    }
    if (size > largest_lattice) {
      diagnostics_.error(place,
                         fmt::format("the {} would have {:.3g} points ({}); at most {} are possible", what, size,
                                     fmt::join(points, " x "), limit),
                         "lower per_axis");
      return std::nullopt;
    }
    if (lost_to_rounding(what, domain, lattice.spacing, place, "lower per_axis")) return std::nullopt;
    return lattice;
  }

  /// Complains about a spacing that coordinates of the domain cannot show.
  bool lost_to_rounding(const std::string& what, const Domain& domain, double spacing, const Place& place,
                        const std::string& remedy) {
    double farthest = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k)
      farthest = std::max({farthest, std::abs(domain.min[k]), std::abs(domain.max[k])});
    if (farthest + spacing / 8 != farthest) return false;
    diagnostics_.error(
        place,
        fmt::format("the spacing {:.3g} of the {} is lost to rounding at coordinates like {}", spacing, what, farthest),
        "move the domain towards the origin, or " + remedy);
    return true;
  }

  void read_time(TimeSpec& time) {
    const auto end = number("time", "end");
    time.method = choice("time", "method");
    const bool adaptive = time::is_adaptive(time::find_tableau(time.method));
    if (!adaptive) require(find_key("time", "step"));
    if (const Entry* tolerance = find("time", "tolerance"); tolerance && !adaptive)
      diagnostics_.error(
          tolerance->place,
          fmt::format("\"tolerance\" goes with method = {}, not with \"{}\"", time::adaptive_names(), time.method),
          "a method with fixed steps takes them as time.step says");
    const auto step = number("time", "step");
    if (const auto tolerance = number("time", "tolerance")) time.tolerance = tolerance->number;
    if (end) time.end = end->number, end_ = end->number;
    if (step) time.step = step->number;
    if (end && step && time.end / time.step > most_steps)
      diagnostics_.error(step->written->place,
                         fmt::format("time.end / time.step is {:.3g} steps; at most {} are possible",
                                     time.end / time.step, static_cast<long long>(most_steps)),
                         "raise time.step");
  }

  void read_evaluate(EvaluateSpec& evaluate, const Domain& domain) {
    const Entry *spacing = find("evaluate", "spacing"), *points = find("evaluate", "per_axis");
    if (spacing && points &&
        spacing->place.override_index != points->place.override_index)  // the later one replaces the other
      (spacing->place.override_index > points->place.override_index ? points : spacing) = nullptr;
    if (spacing && points)
      exactly_one("evaluate", {"per_axis", "spacing"});
    else if (spacing)
      read_spacing(evaluate, domain);
    else if (const auto count = per_axis("evaluate", "a lattice has at least two points an axis")) {
      if (const auto lattice = make_checked_lattice("evaluation lattice", domain, *count))
        warn_narrow(*lattice, domain, count->written ? count->written->place : source_.end());
      evaluate.per_axis = to_int(*count);
    }
    if (const auto tolerance = number("evaluate", "tolerance")) evaluate.tolerance = tolerance->number;
    evaluate.method = choice("evaluate", "method");
  }

  void read_spacing(EvaluateSpec& evaluate, const Domain& domain) {
    const auto spacing = number("evaluate", "spacing");
    if (!spacing || !domain_valid_) return;
    const Place& place = spacing->written->place;
    double longest = 0, size = 1;
    for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k) {
      longest = std::max(longest, domain.max[k] - domain.min[k]);
      size *= std::floor((domain.max[k] - domain.min[k]) / spacing->number) + 1;
    }
    if (spacing->number > longest)
      diagnostics_.error(place,
                         fmt::format("evaluate.spacing = {} is longer than the domain, {}", spacing->number, longest),
                         "a lattice has at least two points on the longest axis");
    else if (!(size <= largest_lattice))
      diagnostics_.error(place,
                         fmt::format("the evaluation lattice would have {:.3g} points; at most {} are possible", size,
                                     static_cast<long long>(largest_lattice)),
                         "raise evaluate.spacing");
    else if (lost_to_rounding("evaluation lattice", domain, spacing->number, place, "raise evaluate.spacing"))
      return;
    else
      evaluate.spacing = spacing->number;
  }

  /// A handful of points across a long domain shows nothing of what is there.
  void warn_narrow(const Lattice& lattice, const Domain& domain, const Place& place) {
    const auto dimension = static_cast<std::size_t>(lattice.dimension);
    const auto begin = lattice.points.begin(), end = begin + lattice.dimension;
    const auto fewest = static_cast<std::size_t>(std::min_element(begin, end) - begin);
    const std::size_t most = *std::max_element(begin, end);
    if (lattice.points[fewest] >= 8 || most < 10 * lattice.points[fewest]) return;
    if (one_particle_across_[fewest]) return;  // then there is nothing to show
    const double spacing = (domain.max[fewest] - domain.min[fewest]) / 20;
    std::vector<std::size_t> now, then;
    double size = 1;
    for (std::size_t k = 0; k < dimension; ++k) {
      now.push_back(lattice.points[k]);
      then.push_back(static_cast<std::size_t>((domain.max[k] - domain.min[k]) / spacing * (1 + 1e-12)) + 1);
      size *= static_cast<double>(then.back());
    }
    diagnostics_.warning(place,
                         fmt::format("the evaluation lattice has {} points, only {} along {}", fmt::join(now, " x "),
                                     lattice.points[fewest], "xyz"[fewest]),
                         size <= 1e7 ? fmt::format("[evaluate] spacing = {:.3g} instead of per_axis has {} points",
                                                   spacing, fmt::join(then, " x "))
                                     : "raise evaluate.per_axis, or give evaluate.spacing instead");
  }

  void read_output(OutputSpec& output, const TimeSpec& time) {
    const Entry *times = find("output", "times"), *frames = find("output", "frames");
    if (times && frames &&
        times->place.override_index != frames->place.override_index)  // the later one replaces the other
      (times->place.override_index > frames->place.override_index ? frames : times) = nullptr;
    if (times && frames)
      exactly_one("output", {"times", "frames"});
    else if (times)
      read_times(*times, output.times);
    else if (const auto count = number("output", "frames"); count && end_)
      spread_frames(*count, time.end, output.times);

    for (const std::size_t k : choices("output", "vtk")) output.files.push_back(write::output_files()[k].about);
    for (const std::size_t k : choices("output", "images")) output.images.push_back(render::styles()[k].about);
    output.report = choice("output", "report") == "html";
    if (dimension_) check_images(output.images);
  }

  /// Complains about styles of the other dimension; of the defaults only those of this one are kept.
  void check_images(std::vector<PictureStyle>& images) {
    if (const Entry* entry = find("output", "images")) {
      std::vector<std::string_view> possible;
      for (const render::Style& style : render::styles())
        if (style.about.shows(dimension_)) possible.push_back(style.about.name);
      for (const Value& item : entry->value.items) {
        if (item.kind != Kind::text) continue;  // complained about
        const render::Style* style = base::find_or_null(render::styles(), item.text);
        if (style && !style->about.shows(dimension_))
          diagnostics_.error(item.place,
                             fmt::format("\"{}\" shows scenes in {}D; the domain has {} dimensions", item.text,
                                         5 - dimension_, dimension_),
                             fmt::format("pictures in {}D: {}", dimension_, quoted_list(possible)));
      }
    }
    std::erase_if(images, [&](const PictureStyle& style) { return !style.shows(dimension_); });
  }

  void read_reference(Case& scene) {
    ReferenceSpec& reference = scene.reference;
    const Key& key = find_key("reference", "kind");
    const Entry *kind = find("reference", "kind"), *rho = find("reference", "rho");
    std::string chosen = choice("reference", "kind");
    // With these no path knows the density.
    std::string without;
    for (const auto& [effect, spec] : effects_of(scene.effects))
      if (without.empty() && !effect->keeps_paths()) without = spec.name;
    if (!without.empty() && kind && chosen == "characteristics")
      diagnostics_.error(kind->value.place,
                         fmt::format("with [effects.{}] the exact density cannot be traced along paths", without),
                         "kind = \"exact\" and a formula as rho, or kind = \"none\"");
    if (!without.empty() && !kind && !rho) {
      chosen = "none";
      diagnostics_.warning(
          table("effects." + without)->place,
          fmt::format("with [effects.{}] there is no exact density to compare with, so no errors are measured",
                      without),
          "[reference] kind = \"exact\" compares with a formula, kind = \"none\" says that this is meant");
    }
    const auto index = std::find(key.choices.begin(), key.choices.end(), chosen) - key.choices.begin();
    reference.kind = static_cast<ReferenceSpec::Kind>(index);
    if (reference.kind == ReferenceSpec::Kind::exact && !rho && !is_meant("reference.rho"))
      diagnostics_.error(kind->value.place, "kind = \"exact\" needs the exact density as \"rho\"",
                         "rho = \"...\": an expression in x, y, z, t and the params");
    if (rho && reference.kind != ReferenceSpec::Kind::exact)
      diagnostics_.error(rho->place, fmt::format("\"rho\" goes with kind = \"exact\", not with \"{}\"", chosen));
    if (rho) reference.rho = field_expression(rho->value, "reference.rho", true);
    const Entry *points = find("reference", "points"), *images = find("output", "images");
    if (const auto most = number("reference", "points")) reference.points = to_int(*most);
    const bool none = reference.kind == ReferenceSpec::Kind::none;
    if (points && none) diagnostics_.error(points->place, "\"points\" has no meaning where reference.kind is \"none\"");
    if (!images || (!none && !points)) return;
    for (const Value& item : images->value.items)
      if (item.kind == Kind::text && item.text == "error")
        diagnostics_.error(
            item.place,
            none ? "the picture \"error\" needs an exact density, but reference.kind is \"none\""
                 : "the picture \"error\" needs the whole grid, but reference.points takes a sample",
            none ? "leave out reference.kind, or the picture" : "leave out reference.points, or the picture");
  }

  void read_accuracy(Case& scene) {
    const auto& budgets = find_key("accuracy", "budget").choices;
    scene.accuracy.budget = static_cast<AccuracySpec::Budget>(
        std::find(budgets.begin(), budgets.end(), choice("accuracy", "budget")) - budgets.begin());
    const auto target = number("accuracy", "target");
    if (!target) return;
    scene.accuracy.target = target->number;
    std::string without;
    for (const auto& [effect, spec] : effects_of(scene.effects))
      if (without.empty() && effect->decay_rate.empty()) without = spec.name;
    if (const Entry* written = find("accuracy", "target"); written && !without.empty())
      diagnostics_.error(written->value.place,
                         fmt::format("no settings can be chosen for a target with [effects.{}]", without),
                         "the error is predicted for transport and reaction; leave out accuracy.target");
  }

  void read_checks(Case& scene) {
    each_part("check", [&](std::string_view, const Value& value) {
      CheckSpec check;
      const auto& names = find_key("check", "what").choices;
      check.what = static_cast<CheckSpec::Quantity>(std::find(names.begin(), names.end(), value.text) - names.begin());
      if (const auto max = number("check", "max")) check.max = max->number;
      if (const auto min = number("check", "min")) check.min = min->number;
      const Entry *max = find("check", "max"), *min = find("check", "min");
      if (!max && !min)
        diagnostics_.error(value.place, "a check needs \"max\" or \"min\", or both", "max = 0.03: at most 0.03");
      if (check.max && check.min && *check.min > *check.max)
        diagnostics_.error(min->value.place,
                           fmt::format("no number is at least {} and at most {}", *check.min, *check.max));
      if (check.what != CheckSpec::Quantity::mass && scene.reference.kind == ReferenceSpec::Kind::none)
        diagnostics_.error(value.place,
                           fmt::format("{} needs an exact density, but reference.kind is \"none\"", value.text));
      if (const auto at = number("check", "at")) check.at = output_time(*at, scene);
      scene.checks.push_back(check);
    });
  }

  /// The output time that a number means, exactly as the outputs have it; a complaint if there is none.
  double output_time(const Number& at, const Case& scene) {
    const auto& times = scene.output.times;
    for (const double time : times)
      if (std::abs(time - at.number) <= same_time * scene.time.end) return time;
    if (!times.empty() && end_)
      diagnostics_.error(at.written->place,
                         fmt::format("check.at = {} is none of the output times", found_number(at.number, *at.written)),
                         times.size() <= 10 ? fmt::format("output times: {:.6g}", fmt::join(times, ", "))
                                            : "give one of output.times");
    return at.number;
  }

  void spread_frames(const Number& count, double end, std::vector<double>& times) {
    const int frames = static_cast<int>(count.number);
    if (end == 0) {
      if (count.written && frames > 1)
        diagnostics_.error(count.written->place,
                           fmt::format("output.frames = {}, but time.end = 0 leaves one time", frames),
                           "give frames = 1");
      times = {0.0};
      return;
    }
    for (int k = 0; k < frames; ++k) times.push_back(k == frames - 1 ? end : end * (double(k) / (frames - 1)));
    if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
      diagnostics_.error(count.written ? count.written->place : source_.end(),
                         fmt::format("{} times between 0 and {} cannot be told apart", frames, end),
                         "lower output.frames");
  }

  void read_times(const Entry& entry, std::vector<double>& times) {
    const Key& key = find_key("output", "times");
    const auto list = numbers(entry, key);
    if (!list || !end_) return;
    if (list->empty())
      diagnostics_.error(entry.value.place, "output.times is empty; give at least one time",
                         "output.frames = 5 spreads 5 times evenly");
    const double end = *end_;
    for (std::size_t k = 0; k < list->size(); ++k) {
      double time = (*list)[k];
      if (std::abs(time - end) <= same_time * end) time = end;
      const Value& written = entry.value.items[k];
      const std::string found = found_number(time, written);
      if (time < 0)
        diagnostics_.error(written.place,
                           fmt::format("entry {} of output.times is {}; the run begins at 0", k + 1, found));
      else if (time > end)
        diagnostics_.error(written.place,
                           fmt::format("entry {} of output.times is {}, after time.end = {}", k + 1, found, end));
      else if (!times.empty() && time <= times.back())
        diagnostics_.error(written.place,
                           fmt::format("entry {} of output.times is {}, not after the entry before it, {}", k + 1,
                                       found, times.back()),
                           "output.times must ascend");
      times.push_back(time);
    }
  }

  void read_effects(Case& scene) {
    std::vector<std::pair<const NamedEffect*, EffectSpec>> read;
    for (const NamedEffect& effect : effects())
      if (table(table_of(effect))) read.emplace_back(&effect, effect_values(effect));
    for (const auto& [effect, spec] : read) scene.effects.list.push_back(spec);
    refuse_effects(read, scene);
  }

  static bool is_complete(const NamedEffect& effect, const EffectSpec& spec) {
    return std::all_of(effect.about.parameters.begin(), effect.about.parameters.end(),
                       [&](const NamedParameter& parameter) {
                         return parameter.optional || spec.has(parameter.name) || !applies(parameter, spec);
                       });
  }

  /// What its keys say, with defaults.
  EffectSpec effect_values(const NamedEffect& effect) {
    const std::string home = table_of(effect);
    EffectSpec given{.name = std::string(effect.about.name)};
    for (const NamedParameter& parameter : effect.about.parameters) {
      const Key& key = find_key(home, parameter.name);
      const Entry* entry = key.required ? require(key) : find(home, key.name);
      if (!entry) continue;
      read_value(parameter, key, *entry, given);
      if (!parameter.replaced_by.empty())
        refuse_both(home, parameter);
      else if (!applies(parameter, complete_effect(effect, given)))
        diagnostics_.error(entry->value.place, fmt::format("\"{}\" goes with {} = \"{}\"", parameter.name,
                                                           parameter.with, parameter.value));
    }
    return complete_effect(effect, given);
  }

  void read_value(const NamedParameter& parameter, const Key& key, const Entry& entry, EffectSpec& given) {
    const auto take_number = [&] {
      if (const auto value = number_of(key, entry)) given.numbers.emplace_back(key.name, std::vector{*value});
    };
    switch (parameter.kind) {
      case NamedParameter::Kind::number:
      case NamedParameter::Kind::whole:
        return take_number();
      case NamedParameter::Kind::point:
        if (const auto values = point_of(key, entry)) given.numbers.emplace_back(key.name, *values);
        return;
      case NamedParameter::Kind::choice:
        given.texts.emplace_back(key.name, choice(key.table, key.name));
        return;
      case NamedParameter::Kind::expression:
      case NamedParameter::Kind::expression_in_time:
        given.texts.emplace_back(
            key.name,
            field_expression(entry.value, label_of(key), parameter.kind == NamedParameter::Kind::expression_in_time));
        return;
    }
  }

  /// A parameter that another one replaces.
  void refuse_both(const std::string& home, const NamedParameter& parameter) {
    const Entry *one = find(home, parameter.replaced_by), *two = find(home, parameter.name);
    if (!one || !two) return;
    diagnostics_.error(
        comes_before(one->place, two->place) ? two->place : one->place,
        fmt::format("[{}] has both \"{}\" and \"{}\"", home, one->name, two->name),
        fmt::format("{}; {}", meaning_note(find_key(home, one->name)), meaning_note(find_key(home, two->name))));
  }

  /// What does not go with the scene, or with another effect.
  void refuse_effects(const std::vector<std::pair<const NamedEffect*, EffectSpec>>& read, const Case& scene) {
    const auto refuse = [&](const std::string& name, const std::string& what, const std::string& remedy) {
      diagnostics_.error(table("effects." + name)->place, fmt::format("[effects.{}] {}", name, what), remedy);
    };
    for (const auto& [effect, spec] : read) {
      const NamedFormula& about = effect->about;
      if (dimension_ && (dimension_ < about.least_dimension || dimension_ > about.most_dimension))
        refuse(spec.name,
               dimension_ == 3 ? "is for two dimensions, the domain has three"
                               : "is for three dimensions, the domain has two",
               "");
      check_steps(*effect, spec, scene);
      if (!effect->problems || !is_complete(*effect, spec)) continue;
      for (const Complaint& problem : effect->problems(spec, scene)) {
        const Entry* entry = find(table_of(*effect), problem.key);
        if (entry)
          diagnostics_.error(entry->value.place, problem.message, problem.remedy);
        else
          refuse(spec.name, problem.message, problem.remedy);
      }
    }
    for (const EffectRule& rule : effect_rules()) {
      const EffectSpec *one = scene.effects.find(rule.effect), *two = scene.effects.find(rule.other);
      if (!one || !two || !rule.apart(*one, *two, dimension_)) continue;
      const std::string unless =
          rule.unless().empty() ? "" : fmt::format(" unless {}", without_backticks(rule.unless()));
      refuse(rule.effect, fmt::format("does not go with [effects.{}]{}: {}", rule.other, unless, rule.reason),
             fmt::format("{}; {}", rule.remedy, goes_with(rule.effect)));
    }
  }

  /// Effects that need to know their steps do not go with a method that chooses them.
  void check_steps(const NamedEffect& effect, const EffectSpec& spec, const Case& scene) {
    const Trait& fixed = effect.traits.needs_fixed_steps;
    const Entry* method = find("time", "method");
    if (!method || !fixed.of(spec, dimension_) || !time::is_adaptive(time::find_tableau(scene.time.method))) return;
    diagnostics_.error(
        method->value.place,
        fmt::format("steps that are chosen by their error do not go with [{}] {}", table_of(effect), fixed.words),
        fmt::format("method = \"{}\"{}{}", time::tableaux().front().name, fixed.remedy.empty() ? "" : " with ",
                    fixed.remedy));
  }

  const Value& root_;
  const Source& source_;
  Diagnostics& diagnostics_;
  std::vector<Parameter> params_;
  std::vector<std::string> later_params_;  // not read yet
  int dimension_ = 0;                      // 0: not known because of an error
  bool domain_valid_ = false;
  Box box_;  // the domain, if it is valid
  std::array<bool, max_dimension> one_particle_across_{};
  std::string_view part_table_;  // of a table that may be repeated: the part that is being read
  std::string part_label_;
  const Value* part_ = nullptr;
  const std::filesystem::path folder_;  // of the case file
  const int threads_;
  std::vector<std::pair<Place, std::shared_ptr<const GridData>>> grid_files_;
  std::optional<double> end_;
  std::vector<std::string> meant_;  // tables and keys that a misspelt name was taken for: not missing, then
};

}  // namespace

ReadResult parse_case(const std::string& text, const std::filesystem::path& file,
                      const std::vector<std::string>& overrides, int threads) {
  const Source source(file.string(), text, overrides);
  Diagnostics diagnostics(source);
  const auto root = read_document(text, source, diagnostics);
  ReadResult result;
  if (root) result.scene = Reader(*root, source, diagnostics, file.parent_path(), threads).read();
  if (diagnostics.errors() > 0) throw CaseError(diagnostics.error_text(), diagnostics.errors());
  result.scene.name = file.stem().string();
  result.scene.file = file;
  result.scene.source = text;
  result.warnings = diagnostics.warnings();
  return result;
}

ReadResult read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides, int threads) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw FileError(fmt::format("the case file {} cannot be read: there is no such file", file.string()));
  const std::string kind = file.extension().string();
  if (kind == ".vti" || kind == ".vtr" || kind == ".pvd")
    throw InputError(
        fmt::format("{0} is data on a grid, not a case; a case reads it by file = \"{0}\" in [velocity] or "
                    "[density] (gaussdrift new gridded_wind writes one)",
                    file.string()));
  if (const std::string way = read::way_to_read(file); !way.empty() && kind != ".txt" && kind != ".dat")
    throw InputError(
        fmt::format("{} is not a case but data; {}, which a case reads by file = \"...\"", file.string(), way));
  const std::string text = base::read_text_file(file, "a case file", largest_case_file);
  return parse_case(text, file, overrides, threads);
}

}  // namespace gaussdrift::input
