// What stands in a case file: names that nobody knows, tables that are missing.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/suggest.hpp"
#include "input/effect_rules.hpp"
#include "input/foreign_keys.hpp"
#include "input/reader.hpp"

namespace gaussdrift::input {

using Kind = Value::Kind;

namespace {

bool is_table(const std::string& name) {
  const std::vector<std::string> all = table_names();
  return std::find(all.begin(), all.end(), name) != all.end();
}

}  // namespace

void Reader::read_version() {
  const Key& key = find_key("", "gaussdrift");
  const Entry* entry = root_.find("gaussdrift");
  if (!entry && is_meant("gaussdrift")) return;
  if (!entry) {
    diagnostics.error({-1, 1, 0, 1}, "the file does not say which version of the format it has",
                      "begin the file with: gaussdrift = 1");
    return;
  }
  const Value& value = entry->value;
  if (value.kind != Kind::whole)
    diagnostics.error(value.place,
                      fmt::format("gaussdrift must be the version of the format, found {}", value.description()),
                      "begin the file with: gaussdrift = 1");
  else if (!key.range.contains(value.number))
    diagnostics.error(value.place, fmt::format("this program reads version {} of the format, the file has version {}",
                                               range_text(key.range), value.whole));
}

void Reader::check_names() {
  const std::vector<std::string> known = top_level_tables();
  for (const Entry& entry : root_.entries) {
    if (entry.name == "gaussdrift") continue;
    if (std::find(known.begin(), known.end(), entry.name) == known.end())
      unknown_at_top(entry, known);
    else if (entry.name != "effects" && !find_table(entry.name).kinds.empty())
      check_parts(entry);
    else if (entry.value.kind != Kind::table)
      diagnostics.error(entry.place, fmt::format("{} must be one table [{}], found {}", entry.name, entry.name,
                                                 entry.value.description()));
    else if (entry.name == "effects")
      check_effects(entry);
    else if (entry.name != "params")
      check_keys(entry, entry.name);
  }
}

std::vector<std::string> Reader::top_level_tables() {
  std::vector<std::string> names;
  for (const std::string& name : table_names()) {
    const std::string top = name.substr(0, name.find('.'));
    if (std::find(names.begin(), names.end(), top) == names.end()) names.push_back(top);
  }
  return names;
}

void Reader::check_effects(const Entry& effects) {
  const std::vector<std::string> known = effect_names();
  for (const Entry& entry : effects.value.entries) {
    if (std::find(known.begin(), known.end(), entry.name) == known.end()) {
      const auto near = base::suggest(entry.name, known);
      diagnostics.error(entry.place,
                        fmt::format("unknown effect \"{}\"{}", entry.name,
                                    near ? fmt::format("; did you mean [effects.{}]?", *near) : ""),
                        answer_to(entry.name, fmt::format("known effects: {}", fmt::join(known, ", "))));
    } else if (entry.value.kind != Kind::table) {
      diagnostics.error(entry.place, fmt::format("effects.{0} must be one table [effects.{0}], found {1}", entry.name,
                                                 entry.value.description()));
    } else {
      check_keys(entry, "effects." + entry.name);
    }
  }
}

void Reader::check_parts(const Entry& entry) {
  const Value& value = entry.value;
  const bool several =
      value.kind == Kind::list && !value.items.empty() &&
      std::all_of(value.items.begin(), value.items.end(), [](const Value& item) { return item.kind == Kind::table; });
  if (value.kind != Kind::table && !several)
    diagnostics.error(entry.place, fmt::format("{} must be a table [{}], or several tables [[{}]], found {}",
                                               entry.name, entry.name, entry.name, value.description()));
}

void Reader::check_tables() {
  std::vector<std::string> missing;
  for (const Table& table : tables())
    if (table.required && !root_.find(std::string(table.name)) && !is_meant(table.name) &&
        (table.unless.empty() || !root_.find(std::string(table.unless))))
      missing.push_back(fmt::format("[{}]", table.name));
  if (!missing.empty())
    diagnostics.error(source.end(),
                      fmt::format("missing table{}: {}", missing.size() == 1 ? "" : "s", fmt::join(missing, ", ")),
                      "a case has at least [domain], [velocity], [density], [particles] and [time]");
}

bool Reader::is_meant(std::string_view label) const {
  return std::find(meant_.begin(), meant_.end(), label) != meant_.end();
}

std::string Reader::remedy_for(const std::string& name, const std::vector<std::string>& known,
                               std::string_view table_name) {
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

std::string Reader::answer_to(const std::string& name, const std::string& note) {
  const ForeignKey* foreign = find_foreign_key(name);
  return foreign ? std::string(foreign->answer) : note;
}

void Reader::unknown_at_top(const Entry& entry, const std::vector<std::string>& known) {
  const bool is_table = entry.value.kind == Kind::table;
  std::vector<std::string> candidates = known;
  if (!is_table) candidates.emplace_back("gaussdrift");
  const std::vector<std::string> effects = effect_names();
  const bool is_effect = std::find(effects.begin(), effects.end(), entry.name) != effects.end();
  const std::string remedy =
      is_effect ? fmt::format("; did you mean [effects.{}]?", entry.name) : remedy_for(entry.name, candidates, "");
  diagnostics.error(entry.place,
                    is_table ? fmt::format("unknown table [{}]{}", entry.name, remedy)
                             : fmt::format("unknown key \"{}\" at the top of the file{}", entry.name, remedy),
                    answer_to(entry.name, fmt::format("known tables: {}", fmt::join(known, ", "))));
}

void Reader::check_keys(const Entry& table, const std::string& table_name) {
  std::vector<std::string> known = key_names(table_name);
  const std::string inner_name = table_name + ".";
  for (const std::string& name : table_names())  // tables in this one
    if (name.starts_with(inner_name)) known.push_back(name.substr(inner_name.size()));
  for (const Entry& entry : table.value.entries) {
    const std::string inner = inner_name + entry.name;
    if (std::find(known.begin(), known.end(), entry.name) != known.end() && is_table(inner)) {
      if (entry.value.kind == Kind::table)
        check_keys(entry, inner);
      else
        diagnostics.error(entry.place,
                          fmt::format("{0} must be one table [{0}], found {1}", inner, entry.value.description()));
      continue;
    }
    if (std::find(known.begin(), known.end(), entry.name) != known.end()) continue;
    const std::string remedy = remedy_for(entry.name, known, table_name);
    diagnostics.error(entry.place, fmt::format("unknown key \"{}\" in [{}]{}", entry.name, table_name, remedy),
                      answer_to(entry.name, fmt::format("known keys: {}", fmt::join(known, ", "))));
  }
}

std::string Reader::home_of(const std::string& name) {
  std::vector<std::string> homes;
  for (const Key& key : keys())
    if (key.name == name && !key.table.empty()) homes.push_back(fmt::format("[{}]", key.table));
  return homes.empty() ? "" : fmt::format("; it belongs in {}", fmt::join(homes, " or "));
}

}  // namespace gaussdrift::input
