// The generated parts of docs/cases.md.
#include "input/markdown.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <vector>

#include "expression/expression.hpp"
#include "field/density/shapes.hpp"
#include "field/named/named_fields.hpp"
#include "input/registry.hpp"
#include "render/styles.hpp"
#include "sim/grid_fields.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::input {

namespace {

std::string capital(std::string_view text) {
  return text.empty() ? "" : fmt::format("{}{}", static_cast<char>(std::toupper(text[0])), text.substr(1));
}

/// The keys of a table that go with a kind and a value (both empty: those of no named formula).
std::string keys_markdown(std::string_view table, std::string_view with, std::string_view value) {
  std::string text;
  for (const Key& key : keys()) {
    if (key.table != table || key.value != value || (!value.empty() && key.with != with)) continue;
    if (text.empty())
      text = "\n| key | what | type and range | default | unit | symbol |\n| --- | --- | --- | --- | --- | --- |\n";
    const std::string range = range_text(key.range);
    std::string fallback = key.required ? "required" : std::string(key.fallback);
    if ((key.type == Type::choice || key.type == Type::ends) && !key.fallback.empty())
      fallback = fmt::format("\"{}\"", fallback);
    if (key.type == Type::choices && !key.fallback.empty()) fallback = fmt::format("[{}]", fallback);
    const std::string with_text = value.empty() && !key.with.empty()
                                      ? fmt::format(". It goes with `{}`{}", key.with,
                                                    key.or_with.empty() ? "" : fmt::format(" or `{}`", key.or_with))
                                      : "";
    text += fmt::format("| `{}` | {}{} | {}{}{} | {} | {} | {} |\n", key.name, key.meaning, with_text, type_text(key),
                        range.empty() ? "" : ", ", range, fallback, key.unit, key.symbol);
  }
  return text;
}

std::string formula_markdown(std::string_view with, const NamedFormula& formula) {
  const std::string where = formula.least_dimension == 3 ? " (3D)" : formula.most_dimension == 2 ? " (2D)" : "";
  return fmt::format("\n#### `{} = \"{}\"`{}\n\n{}.\n\n* value: {}\n", with, formula.name, where,
                     capital(formula.meaning), formula.formula);
}

/// What a run can write and draw.
std::string outputs_markdown() {
  std::string text = "\n| file | what |\n| --- | --- |\n";
  for (const write::FileKind& kind : write::output_files())
    text += fmt::format("| `{}` | {} |\n", kind.about.name, kind.about.meaning);
  text += "\n| field | in the plane | in space | what |\n| --- | --- | --- | --- |\n";
  for (const GridFieldKind& kind : grid_fields()) {
    const auto word = [&](std::size_t at) { return kind.about.is_vector[at] ? "vector" : "number"; };
    text += fmt::format("| `{}` | {} | {} | {} |\n", kind.about.name, word(0), word(1), kind.about.meaning);
  }
  text += "\n| picture | dimensions | what |\n| --- | --- | --- |\n";
  for (const render::Style& style : render::styles()) {
    const PictureStyle& about = style.about;
    const std::string_view dimensions = !about.shows(3) ? "2" : !about.shows(2) ? "3" : "2 and 3";
    text += fmt::format("| `{}` | {} | {} |\n", about.name, dimensions, about.meaning);
  }
  return text;
}

}  // namespace

std::string registry_markdown() {
  const Key& version = find_key("", "gaussdrift");
  std::string text = fmt::format("`{}` at the top of the file, required: {}.\n", version.name, version.meaning);
  for (const Table& table : tables()) {
    text += fmt::format("\n### `[{}]`\n\n{}.\n", table.name, capital(table.meaning));
    if (table.kinds.size() > 1) {
      std::vector<std::string> kinds;
      for (const auto kind : table.kinds) kinds.push_back(fmt::format("`{}`", kind));
      text += fmt::format("\nEach has exactly one of {}.\n", fmt::join(kinds, ", "));
    }
    text += keys_markdown(table.name, "", "");
    if (table.name == "output") text += outputs_markdown();
    if (table.name == "velocity")
      for (const NamedField& field : named_fields())
        text += formula_markdown("field", field.about) +
                fmt::format("* divergence: {}\n* exact flow: {}\n", field.divergence, field.exact_flow) +
                keys_markdown("velocity", "field", field.about.name);
    if (table.name == "density")
      for (const NamedShape& shape : named_shapes())
        text += formula_markdown("shape", shape.about) + keys_markdown("density", "shape", shape.about.name);
  }
  text +=
      "\n### What follows from the keys\n\nThese symbols of the thesis are no keys. The keys set them.\n\n"
      "| symbol | what | formula | unit | set by |\n| --- | --- | --- | --- | --- |\n";
  for (const Quantity& quantity : quantities())
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", quantity.symbol, quantity.meaning,
                        quantity.formula.empty() ? "" : fmt::format("`{}`", quantity.formula), quantity.unit,
                        quantity.set_by);
  return text;
}

std::string functions_markdown() {
  std::string text = "| function | value |\n| --- | --- |\n";
  for (const FunctionInfo& function : expression_functions()) {
    const char* arguments = function.arguments == 1 ? "a" : function.arguments < 0 ? "a, b, ..." : "a, b";
    text += fmt::format("| `{}({})` | {} |\n", function.name, arguments, function.meaning);
  }
  return text;
}

}  // namespace gaussdrift::input
