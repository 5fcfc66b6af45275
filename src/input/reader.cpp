// Finds tables, their parts and their keys.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "input/reader.hpp"

namespace gaussdrift::input {

using Kind = Value::Kind;

std::string without_backticks(std::string_view text) {
  std::string plain(text);
  std::erase(plain, '`');
  return plain;
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

std::string found_number(double value, const Value& written) {
  return written.kind == Kind::text ? fmt::format("{} (from \"{}\")", value, written.text) : fmt::format("{}", value);
}

const Value* Reader::table(std::string_view name) const {
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

const Entry* Reader::find(std::string_view table_name, std::string_view name) const {
  const Value* home = table(table_name);
  return home ? home->find(std::string(name)) : nullptr;
}

std::string Reader::label_of(std::string_view table_name) const {
  return part_ && table_name == part_table_ ? part_label_ : std::string(table_name);
}

std::string Reader::label_of(const Key& key) const {
  return key.table.empty() ? std::string(key.name) : fmt::format("{}.{}", label_of(key.table), key.name);
}

const Entry* Reader::require(const Key& key) {
  const Entry* entry = find(key.table, key.name);
  const Value* home = table(key.table);
  if (!entry && home && !is_meant(label_of(key)))
    diagnostics.error(home->place, fmt::format("{} is missing", label_of(key)), meaning_note(key));
  return entry;
}

void Reader::wrong_type(const Value& value, const std::string& label, const std::string& wanted) {
  diagnostics.error(value.place, fmt::format("{} must be {}, found {}", label, wanted, value.description()));
}

std::optional<std::string_view> Reader::exactly_one(std::string_view table_name,
                                                    const std::vector<std::string_view>& names) {
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
    diagnostics.error(found[1]->place,
                      fmt::format("[{}] has both \"{}\" and \"{}\"", table_name, found[0]->name, found[1]->name), rule);
  else if (home && !misspelt)
    diagnostics.error(home->place, fmt::format("[{}] has none of {}", table_name, quoted_list(names)), rule);
  return std::nullopt;
}

std::string_view Reader::kind_of_part(const Table& home) const {
  for (const auto kind : home.kinds)
    if (part_->find(std::string(kind))) return kind;
  return {};
}

void Reader::check_companions(const Key& kind, const Entry& chosen) {
  const std::string named = kind.type == Type::choice ? chosen.value.text : "";
  const auto known = key_names(kind.table, kind.name, named);
  for (const Entry& entry : part_->entries) {
    if (&entry == &chosen || std::find(known.begin(), known.end(), entry.name) != known.end()) continue;
    std::vector<std::string> homes;
    for (const Key& key : keys()) {
      if (key.table != kind.table || key.name != entry.name) continue;
      if (key.value.empty()) {
        homes.push_back(fmt::format("\"{}\"", key.with));
        if (!key.or_with.empty()) homes.push_back(fmt::format("\"{}\"", key.or_with));
      } else if (homes.empty()) {
        homes.push_back(fmt::format("{} = \"{}\"", key.with, key.value));
      } else {
        homes.push_back(fmt::format("\"{}\"", key.value));
      }
    }
    if (homes.empty()) continue;  // unknown: complained about already
    const std::string chosen_text =
        named.empty() ? fmt::format("\"{}\"", kind.name) : fmt::format("{} = \"{}\"", kind.name, named);
    diagnostics.error(
        entry.place, fmt::format("\"{}\" goes with {}, not with {}", entry.name, fmt::join(homes, " or "), chosen_text),
        fmt::format("known keys with {}: {}", chosen_text, fmt::join(known, ", ")));
  }
}

void Reader::each_part(std::string_view table_name, const ReadPart& read) {
  const Entry* entry = root_.find(std::string(table_name));
  if (!entry) return;
  const Value& value = entry->value;
  const bool several = value.kind == Value::Kind::list;
  const std::size_t count = several ? value.items.size() : 1;
  for (std::size_t k = 0; k < count; ++k) {
    part_ = several ? &value.items[k] : &value;
    if (part_->kind != Value::Kind::table) continue;
    part_table_ = table_name;
    part_label_ = count > 1 ? fmt::format("{}[{}]", table_name, k + 1) : std::string(table_name);
    check_part(find_table(table_name), read);
  }
  part_ = nullptr;
}

void Reader::check_part(const Table& home, const ReadPart& read) {
  const std::vector<std::string> all = key_names(home.name);
  for (const Entry& entry : part_->entries) {
    if (std::find(all.begin(), all.end(), entry.name) != all.end()) continue;
    const auto kind = kind_of_part(home);
    const std::vector<std::string> known =
        kind.empty() ? all : key_names(home.name, kind, part_->find(std::string(kind))->value.text);
    const std::string remedy = remedy_for(entry.name, known, label_of(home.name));
    diagnostics.error(entry.place, fmt::format("unknown key \"{}\" in [{}]{}", entry.name, home.name, remedy),
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

}  // namespace gaussdrift::input
