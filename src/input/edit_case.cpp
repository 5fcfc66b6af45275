#include "input/edit_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "gaussdrift/error.hpp"
#include "input/document.hpp"

namespace gaussdrift::input {
namespace {

std::optional<Value> parsed(const std::string& text) {
  const Source source("", text, {});
  Diagnostics diagnostics(source);
  return read_document(text, source, diagnostics);
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Bare words become a string, as in an override.
std::string literal(const std::string& value) { return parsed("v = " + value) ? value : "\"" + value + "\""; }

std::size_t line_start(const std::string& text, std::size_t line) {
  std::size_t at = 0;
  for (std::size_t k = 1; k < line; ++k) at = text.find('\n', at) + 1;
  return at;
}

std::size_t position(const std::string& text, const Place& place) {
  return line_start(text, place.line) + place.column;
}

/// Past the string that begins at `at`, with one quote or three.
std::size_t end_of_string(const std::string& text, std::size_t at) {
  const std::string quote =
      text.compare(at, 3, std::string(3, text[at])) == 0 ? std::string(3, text[at]) : text.substr(at, 1);
  for (std::size_t k = at + quote.size(); k < text.size(); ++k) {
    if (quote[0] == '"' && text[k] == '\\')
      ++k;
    else if (text.compare(k, quote.size(), quote) == 0)
      return k + quote.size();
  }
  return text.size();
}

/// Past the value that begins at `at`. The text is TOML.
std::size_t end_of_value(const std::string& text, std::size_t at) {
  int depth = 0;
  std::size_t end = at;  // past what was seen of the value
  for (std::size_t k = at; k < text.size();) {
    const char c = text[k];
    if (c == '"' || c == '\'') {
      end = k = end_of_string(text, k);
      continue;
    }
    if (c == '#') {
      if (depth == 0) return end;
      k = std::min(text.find('\n', k), text.size());
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if (depth == 0 && std::string_view("\n,]}").find(c) != std::string_view::npos) return end;
    if (c == ']' || c == '}') --depth;
    ++k;
    if (std::string_view(" \t\r\n").find(c) == std::string_view::npos) end = k;
  }
  return end;
}

/// The new value in place of the old one. A comment behind it stays in its column where there is room.
std::string replaced(const std::string& text, std::size_t from, const std::string& value) {
  const std::size_t to = end_of_value(text, from), comment = text.find_first_not_of(' ', to);
  std::string result = text.substr(0, from) + value;
  if (comment == std::string::npos || text[comment] != '#') return result + text.substr(to);
  const std::size_t old_width = text.find('\n', from) < to ? 0 : comment - from;  // several lines have none
  return result + std::string(old_width > value.size() ? old_width - value.size() : 1, ' ') + text.substr(comment);
}

/// Past the line that `at` is in.
std::size_t end_of_line(const std::string& text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  return end == std::string::npos ? text.size() : end + 1;
}

/// Where another key of the table goes: behind its last one.
std::size_t end_of_table(const std::string& text, const Value& table, const std::string& path) {
  const std::size_t head = position(text, table.place);
  if (text.find_first_not_of(" \t", text.rfind('\n', head) + 1) != head || text[head] != '[')
    throw InputError(
        fmt::format("\"{}\" is written within a line, where no key is added; edit the file by hand", path));
  std::size_t end = end_of_line(text, head);
  for (const Entry& entry : table.entries)
    if (entry.value.kind != Value::Kind::table)
      end = std::max(end, end_of_line(text, end_of_value(text, position(text, entry.value.place))));
  return end;
}

/// The table, or part of a list of tables, that "velocity" or "velocity[2]" names.
const Value* inner(const Value& table, const std::string& name) {
  const std::size_t open = name.find('[');
  const Entry* entry = table.find(name.substr(0, open));
  if (!entry) return nullptr;
  const std::size_t index = open == std::string::npos ? 1 : std::stoul(name.substr(open + 1));
  const std::vector<Value>& items = entry->value.items;
  if (entry->value.kind == Value::Kind::list) return index <= items.size() ? &items[index - 1] : nullptr;
  return &entry->value;
}

std::string with_setting(const std::string& text, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const std::string path = trimmed(setting.substr(0, equals)), value = literal(trimmed(setting.substr(equals + 1)));
  const std::optional<Value> root = parsed(text);
  if (!root) throw InputError("the case is not TOML");
  const Value* table = &*root;
  std::size_t first = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', first)) {
    table = inner(*table, path.substr(first, dot - first));
    if (!table) break;
    first = dot + 1;
  }
  const std::size_t last = path.rfind('.');
  const std::string key = path.substr(last + 1), header = path.substr(0, std::min(last, path.size()));
  if (!table) return fmt::format("{}\n[{}]\n{} = {}\n", text, header, key, value);
  if (const Entry* entry = table->find(key)) return replaced(text, position(text, entry->value.place), value);
  if (table == &*root) return fmt::format("{} = {}\n{}", key, value, text);
  std::string result = text;
  return result.insert(end_of_table(text, *table, header), fmt::format("{} = {}\n", key, value));
}

}  // namespace

std::string with_settings(std::string text, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) text = with_setting(text, setting);
  return text;
}

}  // namespace gaussdrift::input
