#include "input/document.hpp"

#include <fmt/format.h>

// toml++ asserts, and in release builds of clang assumes, what files decide: that a key begins behind "[ ". The check
// behind that answers as it should.
#define TOML_ASSERT(expr) static_assert(true)
#ifdef NDEBUG
#undef NDEBUG
#include <toml++/toml.h>
#define NDEBUG
#else
#include <toml++/toml.h>
#endif

#include <algorithm>
#include <charconv>
#include <sstream>
#include <tuple>

#include "base/printable.hpp"

namespace gaussdrift::input {
namespace {

/// Where a TOML node stands in the text that was parsed.
class Locator {
 public:
  virtual ~Locator() = default;
  virtual Place place(const toml::source_region& region) const = 0;
};

class FileLocator : public Locator {
 public:
  explicit FileLocator(const Source& source) : source_(source) {}

  Place place(const toml::source_region& region) const override {
    if (!region.begin) return source_.end();
    Place place{-1, region.begin.line, source_.byte_column(region.begin.line, region.begin.column), 1};
    const std::size_t line_length = source_.line(place).size();
    std::size_t end =
        region.end.line == region.begin.line ? source_.byte_column(region.end.line, region.end.column) : line_length;
    end = std::min(end, line_length);
    while (end > place.column + 1 && (source_.line(place)[end - 1] == ' ' || source_.line(place)[end - 1] == '\t'))
      --end;
    place.length = end > place.column ? end - place.column : 1;
    return place;
  }

 private:
  const Source& source_;
};

/// The value of an override is parsed as "v = value".
class OverrideLocator : public Locator {
 public:
  static constexpr std::size_t prefix = 4;

  OverrideLocator(int index, std::size_t value_column, std::size_t value_length)
      : index_(index), value_column_(value_column), value_length_(value_length) {}

  Place whole() const { return {index_, 1, value_column_, std::max<std::size_t>(1, value_length_)}; }

  Place place(const toml::source_region& region) const override {
    if (region.begin.line != 1 || region.end.line != 1 || region.begin.column <= prefix) return whole();
    const std::size_t from = region.begin.column - 1 - prefix;
    const std::size_t to =
        std::min<std::size_t>(region.end.column > prefix ? region.end.column - 1 - prefix : 0, value_length_);
    if (from >= value_length_) return whole();
    return whole().part(from, to > from ? to - from : 1);
  }

 private:
  int index_;
  std::size_t value_column_, value_length_;
};

/// A date or time, as TOML writes it.
std::string written(const toml::node& node) {
  std::ostringstream text;
  if (const auto* date = node.as_date()) text << *date;
  if (const auto* moment = node.as_date_time()) text << *moment;
  return text.str();
}

Value convert(const toml::node& node, const Locator& locator) {
  Value value;
  value.place = locator.place(node.source());
  switch (node.type()) {
    case toml::node_type::table:
      value.kind = Value::Kind::table;
      for (const auto& [key, child] : *node.as_table())
        value.entries.push_back({std::string(key.str()), locator.place(key.source()), convert(child, locator)});
      std::stable_sort(value.entries.begin(), value.entries.end(), [](const Entry& a, const Entry& b) {
        return std::tuple(a.place.line, a.place.column) < std::tuple(b.place.line, b.place.column);
      });
      break;
    case toml::node_type::array:
      value.kind = Value::Kind::list;
      for (const auto& child : *node.as_array()) value.items.push_back(convert(child, locator));
      break;
    case toml::node_type::string:
      value.kind = Value::Kind::text;
      value.text = node.as_string()->get();
      break;
    case toml::node_type::integer:
      value.kind = Value::Kind::whole;
      value.whole = node.as_integer()->get();
      value.number = static_cast<double>(value.whole);
      break;
    case toml::node_type::floating_point:
      value.kind = Value::Kind::number;
      value.number = node.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      value.kind = Value::Kind::boolean;
      value.boolean = node.as_boolean()->get();
      break;
    default:
      value.kind = Value::Kind::date;
      value.text = written(node);
      break;
  }
  return value;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// toml++ begins with "Error while parsing table header: ", which would read "error: Error ...".
std::string plain_description(const toml::parse_error& error) {
  constexpr std::string_view opening = "Error while parsing ";
  const std::string_view description = error.description();
  if (description.substr(0, opening.size()) != opening) return std::string(description);
  return fmt::format("cannot read this {}", description.substr(opening.size()));
}

/// The text after the "=" of an override: a TOML value, or else bare words, which are taken as a string.
std::optional<Value> override_value(const std::string& text, const OverrideLocator& locator, Diagnostics& diagnostics) {
  try {
    const toml::table parsed = toml::parse("v = " + text + "\n");
    if (parsed.size() == 1 && parsed.contains("v")) return convert(*parsed.get("v"), locator);
  } catch (const toml::parse_error& error) {
    if (text.find_first_of("[{\"'") == 0) {
      diagnostics.error(locator.place(error.source()), plain_description(error),
                        "the value is read as in the file: a number, \"a string\", [a, list]; bare words are a string");
      return std::nullopt;
    }
  }
  Value value;
  value.kind = Value::Kind::text;
  value.text = text;
  value.place = locator.whole();
  return value;
}

/// The table that "velocity[2]" names: the second of several [[velocity]], or a single [velocity] as the first.
Value* part_of(Value& table, const std::string& name) {
  const std::size_t open = name.find('[');
  if (open == std::string::npos || name.back() != ']') return nullptr;
  std::size_t index = 0;
  const char *begin = name.data() + open + 1, *end = name.data() + name.size() - 1;
  const auto read = std::from_chars(begin, end, index);
  Entry* entry = table.find(name.substr(0, open));
  if (read.ec != std::errc() || read.ptr != end || index == 0 || !entry) return nullptr;
  Value& value = entry->value;
  if (value.kind == Value::Kind::table) return index == 1 ? &value : nullptr;
  if (value.kind != Value::Kind::list || index > value.items.size()) return nullptr;
  Value& item = value.items[index - 1];
  return item.kind == Value::Kind::table ? &item : nullptr;
}

void apply_override(Value& root, int index, const std::string& text, Diagnostics& diagnostics) {
  const std::size_t equals = text.find('=');
  const Place whole{index, 1, 0, std::max<std::size_t>(1, text.size())};
  if (equals == std::string::npos) {
    diagnostics.error(whole, "an override needs a value",
                      "write --set table.key=value, for example --set time.step=0.01");
    return;
  }
  const std::string key(trimmed(std::string_view(text).substr(0, equals)));
  const std::string value_text(trimmed(std::string_view(text).substr(equals + 1)));
  const Place key_place{index, 1, 0, std::max<std::size_t>(1, equals)};
  const std::size_t value_column = value_text.empty() ? equals + 1 : text.find(value_text, equals + 1);
  const OverrideLocator locator(index, value_column, value_text.size());
  if (value_text.empty()) {
    diagnostics.error(locator.whole(), fmt::format("no value for \"{}\"", key),
                      "write --set table.key=value; \"\" is the empty string");
    return;
  }
  Value* table = &root;
  std::size_t first = 0;
  for (std::size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', first)) {
    const std::string name = key.substr(first, dot - first);
    if (Value* part = part_of(*table, name)) {
      table = part;
      first = dot + 1;
      continue;
    }
    Entry* entry = table->find(name);
    if (!entry) {
      Value made;
      made.place = key_place.part(first, std::max<std::size_t>(1, dot - first));
      table->entries.push_back({name, made.place, made});
      entry = &table->entries.back();
    }
    if (entry->value.kind != Value::Kind::table) {
      const bool parts = !entry->value.items.empty() && entry->value.items[0].kind == Value::Kind::table;
      diagnostics.error(
          key_place,
          fmt::format("\"{}\" is {} and has no keys of its own", key.substr(0, dot), entry->value.description()),
          parts ? fmt::format("there are several [[{0}]]; name one: {0}[1]{1}", name, key.substr(dot)) : "");
      return;
    }
    table = &entry->value;
    first = dot + 1;
  }
  const auto value = override_value(value_text, locator, diagnostics);
  if (!value) return;
  const std::string name = key.substr(first);
  const Entry made{name, key_place, *value};
  if (Entry* entry = table->find(name))
    *entry = made;
  else
    table->entries.push_back(made);
}

}  // namespace

Entry* Value::find(const std::string& name) {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

const Entry* Value::find(const std::string& name) const { return const_cast<Value*>(this)->find(name); }

std::string Value::description() const {
  switch (kind) {
    case Kind::table:
      return "a table";
    case Kind::list:
      return "a list";
    case Kind::text:
      return "the string " + base::in_quotes(text, 40);
    case Kind::whole:
      return fmt::format("the number {}", whole);
    case Kind::number:
      return fmt::format("the number {}", number);
    case Kind::boolean:
      return boolean ? "true" : "false";
    case Kind::date:
      return "a date or time";
  }
  return "";
}

std::optional<Value> read_document(const std::string& text, const Source& source, Diagnostics& diagnostics) {
  const FileLocator locator(source);
  try {
    Value root = convert(toml::parse(text), locator);
    for (std::size_t k = 0; k < source.overrides().size(); ++k)
      apply_override(root, static_cast<int>(k), source.overrides()[k], diagnostics);
    return root;
  } catch (const toml::parse_error& error) {
    const std::string why = plain_description(error);
    diagnostics.error(locator.place(error.source()), why,
                      why.find("redefine") != std::string::npos
                          ? "each table stands once; of several tables of one name, as velocities, each has double "
                            "brackets: [[velocity]]"
                          : "the file is not TOML here; the rest is checked once this is mended");
    return std::nullopt;
  }
}

Place place_in_text(const Value& value, const Source& source, std::size_t position, std::size_t length) {
  const std::string_view written = source.text(value.place);
  if (written == value.text) return value.place.part(position, length);  // bare words of an override
  if (written.size() == value.text.size() + 2 && written.substr(1, value.text.size()) == value.text)
    return value.place.part(1 + position, length);
  return value.place;
}

}  // namespace gaussdrift::input
