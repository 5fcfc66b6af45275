// The registry as a JSON schema. Each table is an object, closed against unknown keys. A table of several kinds is one
// of several objects, so that a parameter is only accepted beside the value that it goes with.
#include <cmath>
#include <nlohmann/json.hpp>

#include "input/explain.hpp"
#include "input/registry.hpp"

namespace gaussdrift::input {

namespace {

using Json = nlohmann::ordered_json;

void add_range(Json& schema, const Range& range) {
  if (std::isfinite(range.least)) schema[range.least_open ? "exclusiveMinimum" : "minimum"] = range.least;
  if (std::isfinite(range.most)) schema[range.most_open ? "exclusiveMaximum" : "maximum"] = range.most;
}

/// A number in the range, or an expression in a string.
Json number_schema(const char* type, const Range& range) {
  Json number = {{"type", type}};
  add_range(number, range);
  return {{"anyOf", Json::array({number, {{"type", "string"}}})}};
}

Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}, {"minItems", 1}}; }

Json value_schema(const Key& key) {
  switch (key.type) {
    case Type::text:
    case Type::expression:
      return {{"type", "string"}};
    case Type::texts:
      return list_of({{"type", "string"}});
    case Type::number:
      return number_schema("number", key.range);
    case Type::whole:
      return number_schema("integer", key.range);
    case Type::boolean:
      return {{"type", "boolean"}};
    case Type::duration:
      return {{"anyOf", Json::array({number_schema("number", key.range), Json{{"type", "string"}}})}};
    case Type::numbers:
      return list_of(number_schema("number", key.range));
    case Type::point: {
      Json list = list_of(number_schema("number", key.range));
      list["minItems"] = 2;
      list["maxItems"] = 3;
      return list;
    }
    case Type::expressions: {
      Json list = list_of({{"type", Json::array({"string", "number"})}});
      list["minItems"] = 2;
      list["maxItems"] = 3;
      return list;
    }
    case Type::choice:
      if (key.or_flag) return {{"anyOf", Json::array({Json{{"enum", key.choices}}, Json{{"type", "boolean"}}})}};
      return {{"enum", key.choices}};
    case Type::choices: {
      Json list = list_of({{"enum", key.choices}});
      list.erase("minItems");
      return list;
    }
    case Type::ends: {
      const Json word = {{"enum", key.choices}};
      Json pair = list_of(word);
      pair["minItems"] = 2;
      pair["maxItems"] = 2;
      Json list = list_of({{"anyOf", Json::array({word, pair})}});
      list["minItems"] = 2;
      list["maxItems"] = 3;
      return list;
    }
    case Type::clock: {
      Range above_zero;
      above_zero.least = 0, above_zero.least_open = true;
      Json properties = {{"start", number_schema("number", {})}, {"unit", number_schema("number", above_zero)}};
      return {{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
    }
  }
  return true;
}

Json described(const Key& key) {
  Json schema = value_schema(key);
  std::string text(key.meaning);
  if (!key.unit.empty()) text += " [" + std::string(key.unit) + "]";
  if (!key.symbol.empty()) text += " (" + std::string(key.symbol) + ")";
  schema["description"] = text;
  return schema;
}

/// The keys of a table that go with a kind and a value, and no others.
Json closed_object(std::string_view table, std::string_view kind, std::string_view value) {
  Json schema = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  Json required = Json::array();
  if (!kind.empty()) required.push_back(kind);
  for (const std::string& name : key_names(table, kind, value))
    for (const Key& key : keys()) {
      if (key.table != table || key.name != name || !key.belongs(kind, value)) continue;
      schema["properties"][name] = described(key);
      if (name == kind && !value.empty()) {
        schema["properties"][name].erase("enum");
        schema["properties"][name]["const"] = value;
      }
      if (key.required && name != kind) required.push_back(name);
    }
  if (!required.empty()) schema["required"] = required;
  return schema;
}

/// The values of `kind` that have parameters of their own.
std::vector<std::string_view> values_with_parameters(std::string_view table, std::string_view kind) {
  for (const Key& key : keys())
    if (key.table == table && key.name == kind && key.type == Type::choice)
      for (const Key& parameter : keys())
        if (parameter.table == table && parameter.with == kind && !parameter.value.empty()) return key.choices;
  return {};
}

Json table_schema(const Table& table) {
  Json schema = Json::object();
  if (table.name == "params") {
    schema = {{"type", "object"},
              {"additionalProperties", number_schema("number", {})},
              {"propertyNames", {{"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}}}};
  } else if (table.kinds.empty()) {
    schema = closed_object(table.name, "", "");
  } else {
    Json variants = Json::array();
    for (const auto kind : table.kinds) {
      const auto values = values_with_parameters(table.name, kind);
      if (values.empty()) variants.push_back(closed_object(table.name, kind, ""));
      for (const auto value : values) variants.push_back(closed_object(table.name, kind, value));
    }
    const Json one = {{"oneOf", variants}};
    schema = {{"anyOf", Json::array({one, list_of(one)})}};
  }
  schema["description"] = table.meaning;
  return schema;
}

}  // namespace

std::string schema_json() {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "A case of gaussdrift"},
                 {"type", "object"},
                 {"additionalProperties", false},
                 {"properties", Json::object()},
                 {"required", Json::array()}};
  for (const Key& key : keys()) {
    if (!key.table.empty()) continue;
    schema["properties"][std::string(key.name)] = described(key);
    if (key.required) schema["required"].push_back(key.name);
  }
  for (const Table& table : tables()) {
    // "effects.reaction" is the table reaction in the table effects.
    Json* place = &schema;
    std::string_view rest = table.name;
    for (std::size_t dot = rest.find('.'); dot != std::string_view::npos; dot = rest.find('.')) {
      Json& outer = (*place)["properties"][std::string(rest.substr(0, dot))];
      if (outer.is_null())
        outer = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
      place = &outer;
      rest.remove_prefix(dot + 1);
    }
    (*place)["properties"][std::string(rest)] = table_schema(table);
    if (table.required && table.unless.empty()) (*place)["required"].push_back(rest);
    if (!table.unless.empty()) (*place)["anyOf"] = {{{"required", {rest}}}, {{"required", {table.unless}}}};
  }
  return schema.dump(2) + "\n";
}

}  // namespace gaussdrift::input
