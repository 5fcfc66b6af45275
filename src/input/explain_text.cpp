// Explanations as text for people: labels in a column, what they mean beside them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "input/explain.hpp"
#include "input/registry.hpp"

namespace gaussdrift::input {

namespace {

constexpr std::size_t least_room = 20;  // columns for a text beside its label; with less the terminal breaks the line

/// Characters, not bytes.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// A label and a text behind it. Lines are broken between words, and go on below the beginning of the text.
std::string hanging(const std::string& label, std::string_view text, std::size_t columns) {
  const std::size_t indent = width_of(label);
  if (columns < indent + least_room) return fmt::format("{}{}\n", label, text);
  std::string lines = label;
  std::size_t used = indent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    const bool first = used == indent;
    if (!first && used + 1 + width_of(word) > columns) {
      lines += fmt::format("\n{:{}}{}", "", indent, word);
      used = indent + width_of(word);
    } else {
      lines += fmt::format("{}{}", first ? "" : " ", word);
      used += (first ? 0 : 1) + width_of(word);
    }
  }
  return lines + "\n";
}

/// The keys of a table, a line each.
std::string lines_of(const Table* table, std::size_t columns) {
  std::vector<const Key*> shown;
  for (const Key& key : keys())
    if (key.table == (table ? table->name : "") && key.value.empty()) shown.push_back(&key);
  std::size_t name = 0, symbol = 0;
  for (const Key* key : shown) name = std::max(name, key->name.size()), symbol = std::max(symbol, key->symbol.size());
  std::string text;
  for (const Key* key : shown)
    text += hanging(fmt::format("  {:<{}}  {:<{}}{}", key->name, name, key->symbol, symbol, symbol ? "  " : ""),
                    first_sentence(key->meaning), columns);
  return text;
}

}  // namespace

std::string overview_text(std::size_t columns) {
  std::string text = hanging(
      "", "The keys of a case file, table by table. gaussdrift explain KEY tells more about one of them.", columns);
  text += '\n';
  text += lines_of(nullptr, columns);
  for (const Table& table : tables()) {
    text += '\n';
    text += hanging(fmt::format("[{}]  ", table.name), first_sentence(table.meaning), columns);
    text += lines_of(&table, columns);
  }
  std::vector<std::string_view> symbols;
  for (const Quantity& quantity : quantities()) symbols.push_back(quantity.symbol);
  text += '\n';
  text +=
      hanging("",
              fmt::format("It also explains tables, effects, named fields and shapes, functions, every symbol of the "
                          "thesis's Tables A.1 to A.4, and these symbols: {}.",
                          fmt::join(symbols, ", ")),
              columns);
  return text;
}

std::string to_text(const std::vector<Explanation>& explanations, std::size_t columns) {
  std::string text;
  for (const Explanation& one : explanations) {
    if (!text.empty()) text += "\n";
    text += one.name + "\n" + hanging("  ", one.title, columns);
    std::size_t width = 9;
    for (const Fact& fact : one.facts) width = std::max(width, fact.label.size());
    for (const Fact& fact : one.facts)
      text += hanging(fmt::format("  {:<{}}  ", fact.label, width), fact.value, columns);
  }
  return text;
}

}  // namespace gaussdrift::input
