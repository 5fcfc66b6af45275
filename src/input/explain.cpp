#include "input/explain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/suggest.hpp"
#include "expression/expression.hpp"
#include "field/density/shapes.hpp"
#include "field/named/named_fields.hpp"
#include "input/effect_rules.hpp"
#include "input/pair_methods.hpp"
#include "input/registry.hpp"
#include "input/thesis_symbols.hpp"
#include "render/styles.hpp"
#include "sim/grid_fields.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::input {

namespace {

/// "\alpha_{j}", "α_j" and "alpha_j" are the same symbol.
std::string plain_symbol(std::string_view word) {
  static constexpr std::pair<std::string_view, std::string_view> letters[] = {
      {"α", "alpha"}, {"β", "beta"}, {"Ω", "Omega"}, {"γ", "gamma"},  {"δ", "delta"}, {"ε", "eps"},      {"ϵ", "eps"},
      {"ζ", "zeta"},  {"η", "eta"},  {"κ", "kappa"}, {"λ", "lambda"}, {"ν", "nu"},    {"π", "pi"},       {"ρ", "rho"},
      {"σ", "sigma"}, {"τ", "tau"},  {"ω", "omega"}, {"₀", "_0"},     {"Γ", "Gamma"}, {"epsilon", "eps"}};
  std::string text;
  for (const char letter : word)
    if (letter != '\\' && letter != '{' && letter != '}' && letter != '$') text += letter;
  for (const auto& [from, to] : letters)
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  if (text.rfind("var", 0) == 0 && text.size() > 3) text.erase(0, 3);  // \varepsilon
  return text;
}

std::string full_name(const Key& key) {
  return key.table.empty() ? std::string(key.name) : fmt::format("{}.{}", key.table, key.name);
}

void add(std::vector<Fact>& facts, std::string label, std::string value) {
  if (!value.empty()) facts.push_back({std::move(label), std::move(value)});
}

std::string default_text(const Key& key) {
  if (key.required) return "none: the key is required";
  if (key.fallback.empty()) return "none: the key may be left out";
  if (key.type == Type::choice || key.type == Type::ends) return fmt::format("\"{}\"", key.fallback);
  if (key.type == Type::choices) return fmt::format("[{}]", key.fallback);
  return std::string(key.fallback);
}

std::string dimensions_text(int least, int most) { return least == most ? fmt::format("{}", least) : "2 and 3"; }

Explanation about(const Key& key) {
  Explanation result{"key", full_name(key), std::string(key.meaning), {}};
  if (!key.value.empty())
    add(result.facts, "goes with", fmt::format("{} = \"{}\"", key.with, key.value));
  else if (!key.with.empty())
    add(result.facts, "goes with",
        key.or_with.empty() ? std::string(key.with) : fmt::format("{}, {}", key.with, key.or_with));
  add(result.facts, "type", type_text(key));
  add(result.facts, "range", range_text(key.range));
  add(result.facts, "default", default_text(key));
  add(result.facts, "unit", std::string(key.unit));
  add(result.facts, "symbol", std::string(key.symbol));
  return result;
}

Explanation about(const Table& table) {
  Explanation result{"table", fmt::format("[{}]", table.name), std::string(table.meaning), {}};
  add(result.facts, "required",
      !table.required        ? "no"
      : table.unless.empty() ? "yes"
                             : fmt::format("yes, unless there is [[{}]]", table.unless));
  if (!table.kinds.empty()) add(result.facts, "one of", fmt::format("{}", fmt::join(table.kinds, ", ")));
  for (const Key& key : keys())
    if (key.table == table.name && key.value.empty())
      add(result.facts, std::string(key.name), std::string(key.meaning));
  return result;
}

Explanation about(std::string_view kind, std::string_view table, const NamedFormula& formula) {
  Explanation result{
      std::string(kind), fmt::format("{}.{} = \"{}\"", table, kind, formula.name), std::string(formula.meaning), {}};
  add(result.facts, "value", std::string(formula.formula));
  add(result.facts, "dimensions", dimensions_text(formula.least_dimension, formula.most_dimension));
  return result;
}

/// The parameters of a named formula follow its facts.
void add_parameters(Explanation& result, std::string_view table, std::string_view with, std::string_view value) {
  for (const Key& key : keys()) {
    if (key.table != table || key.with != with || key.value != value) continue;
    const std::string range = range_text(key.range);
    add(result.facts, std::string(key.name),
        fmt::format("{}; {}{}{}", key.meaning, type_text(key), range.empty() ? "" : ", " + range,
                    key.required ? "; required" : fmt::format("; default {}", key.fallback)));
  }
}

Explanation about(const NamedField& field) {
  Explanation result = about("field", "velocity", field.about);
  add(result.facts, "divergence", std::string(field.divergence));
  add(result.facts, "exact flow", std::string(field.exact_flow));
  add_parameters(result, "velocity", "field", field.about.name);
  return result;
}

Explanation about(const NamedShape& shape) {
  Explanation result = about("shape", "density", shape.about);
  add_parameters(result, "density", "shape", shape.about.name);
  return result;
}

Explanation about(const OutputFile& file) {
  Explanation result{"file", fmt::format("output.vtk = [\"{}\"]", file.name), std::string(file.meaning), {}};
  add(result.facts, "written by default", file.by_default ? "yes" : "no");
  return result;
}

Explanation about(const GridField& field) {
  Explanation result{
      "field of the grid", fmt::format("output.fields = [\"{}\"]", field.name), std::string(field.meaning), {}};
  const auto word = [&](std::size_t at) { return field.is_vector[at] ? "a vector" : "a number"; };
  add(result.facts, "value",
      field.is_vector[0] == field.is_vector[1] ? std::string(word(0))
                                               : fmt::format("{} in the plane, {} in space", word(0), word(1)));
  add(result.facts, "follows from", field.is_of_flow ? "the prescribed velocity" : "the particles");
  return result;
}

Explanation about(const PictureStyle& style) {
  Explanation result{"picture", fmt::format("output.images = [\"{}\"]", style.name), std::string(style.meaning), {}};
  add(result.facts, "dimensions", dimensions_text(style.least_dimension, style.most_dimension));
  add(result.facts, "needs",
      style.shows_error            ? "a reference"
      : !style.needs_field.empty() ? fmt::format("\"{}\" in output.fields", style.needs_field)
                                   : "");
  add(result.facts, "drawn by default", style.by_default ? "yes" : "no");
  return result;
}

Explanation about(const FunctionInfo& function) {
  return {"function", fmt::format("{}(...)", function.name), std::string(function.meaning), {}};
}

Explanation about(const Quantity& quantity) {
  Explanation result{"quantity", std::string(quantity.symbol), std::string(quantity.meaning), {}};
  add(result.facts, "formula", std::string(quantity.formula));
  add(result.facts, "unit", std::string(quantity.unit));
  add(result.facts, "set by", std::string(quantity.set_by));
  return result;
}

Explanation about(const ThesisSymbol& symbol) {
  Explanation result{"symbol", std::string(symbol.symbol), std::string(symbol.meaning), {}};
  add(result.facts, "thesis", fmt::format("[Sch06, Table {}]", symbol.table));
  add(result.facts, "here", std::string(symbol.here));
  return result;
}

Explanation about(const PairMethod& method) {
  return {"method", fmt::format("gaussdrift sum --method {}", method.name), method.meaning, {{"sums", method.sums}}};
}

Explanation about_effects() {
  Explanation result{"tables", "[effects.*]", "what happens beside transport. Which effects go together:", {}};
  for (const std::string& effect : effect_names()) add(result.facts, effect, goes_with(effect));
  return result;
}

bool chooses(const Key& key, std::string_view value) {
  return std::find(key.choices.begin(), key.choices.end(), value) != key.choices.end();
}

std::string_view without_brackets(std::string_view word) {
  while (word.size() > 2 && word.front() == '[' && word.back() == ']') word = word.substr(1, word.size() - 2);
  return word;
}

std::vector<std::string> known_words() {
  std::vector<std::string> words;
  for (const Key& key : keys()) {
    words.push_back(full_name(key));
    words.emplace_back(key.name);
    if (!key.symbol.empty()) words.emplace_back(key.symbol);
    words.insert(words.end(), key.choices.begin(), key.choices.end());
  }
  for (const std::string& table : table_names()) words.push_back(table);
  for (const Quantity& quantity : quantities()) words.emplace_back(quantity.symbol);
  for (const ThesisSymbol& known : thesis_symbols())
    if (known.symbol.size() > 2) words.emplace_back(known.symbol);  // one letter is near to any other
  for (const FunctionInfo& function : expression_functions()) words.emplace_back(function.name);
  for (const PairMethod& method : pair_methods()) words.push_back(method.name);
  return words;
}

/// A key of several fields is told once, with all that it goes with.
std::vector<Explanation> together(const std::vector<Explanation>& all) {
  constexpr const char* label = "goes with";
  const auto rest_of = [&](Explanation one) {
    std::erase_if(one.facts, [&](const Fact& fact) { return fact.label == label; });
    return one;
  };
  const auto same = [&](const Explanation& a, const Explanation& b) {
    const Explanation x = rest_of(a), y = rest_of(b);
    return x.kind == y.kind && x.name == y.name && x.title == y.title &&
           std::equal(x.facts.begin(), x.facts.end(), y.facts.begin(), y.facts.end(),
                      [](const Fact& f, const Fact& g) { return f.label == g.label && f.value == g.value; });
  };
  const auto with = [&](Explanation& one) {
    return std::find_if(one.facts.begin(), one.facts.end(), [&](const Fact& fact) { return fact.label == label; });
  };
  std::vector<Explanation> found;
  for (Explanation next : all) {
    const auto before = std::find_if(found.begin(), found.end(), [&](const auto& one) { return same(one, next); });
    const auto added = with(next);
    if (before != found.end() && added != next.facts.end() && with(*before) != before->facts.end())
      with(*before)->value += ", " + added->value;
    else
      found.push_back(std::move(next));
  }
  return found;
}

std::vector<Explanation> meanings_of(std::string_view word) {
  const std::string_view bare = without_brackets(word);
  std::vector<Explanation> found;
  if (bare == "effects") found.push_back(about_effects());
  for (const Table& table : tables())
    if (table.name == bare || table.name == fmt::format("effects.{}", bare)) found.push_back(about(table));
  if (bare != word) return found;  // [particles] is nothing else
  const std::string symbol = plain_symbol(word);
  for (const Key& key : keys())
    if (key.name == word || full_name(key) == word || (!key.symbol.empty() && plain_symbol(key.symbol) == symbol))
      found.push_back(about(key));
  for (const Quantity& quantity : quantities())
    if (plain_symbol(quantity.symbol) == symbol) found.push_back(about(quantity));
  for (const ThesisSymbol& known : thesis_symbols())
    if (plain_symbol(known.symbol) == symbol) found.push_back(about(known));
  for (const NamedField& field : named_fields())
    if (field.about.name == word) found.push_back(about(field));
  for (const NamedShape& shape : named_shapes())
    if (shape.about.name == word) found.push_back(about(shape));
  for (const write::FileKind& kind : write::output_files())
    if (kind.about.name == word) found.push_back(about(kind.about));
  for (const render::Style& style : render::styles())
    if (style.about.name == word) found.push_back(about(style.about));
  for (const GridFieldKind& field : grid_fields())
    if (field.about.name == word) found.push_back(about(field.about));
  for (const FunctionInfo& function : expression_functions())
    if (function.name == word) found.push_back(about(function));
  for (const Key& key : keys())  // "gauss4" is explained by the key that may have this value
    if (chooses(key, word) && !(key.table == "velocity" && key.name == "field") &&
        !(key.table == "density" && key.name == "shape"))
      found.push_back(about(key));
  for (const PairMethod& method : pair_methods())
    if (method.name == word) found.push_back(about(method));
  return found;
}

}  // namespace

std::vector<std::string> key_paths() {
  std::vector<std::string> paths;
  for (const std::string& table : table_names())
    for (const std::string& key : key_names(table)) paths.push_back(table + "." + key);
  return paths;
}

std::vector<std::string> table_paths() { return table_names(); }

std::vector<Explanation> explain(std::string_view word) { return together(meanings_of(word)); }

std::optional<std::string> suggest_word(std::string_view word) { return base::suggest(word, known_words()); }

std::string to_json(std::string_view word, const std::vector<Explanation>& explanations) {
  nlohmann::ordered_json document = {{"word", word}, {"meanings", nlohmann::ordered_json::array()}};
  for (const Explanation& one : explanations) {
    nlohmann::ordered_json entry = {{"kind", one.kind}, {"name", one.name}, {"meaning", one.title}};
    if (!one.facts.empty()) entry["facts"] = nlohmann::ordered_json::object();
    for (const Fact& fact : one.facts) entry["facts"][fact.label] = fact.value;
    document["meanings"].push_back(std::move(entry));
  }
  return document.dump(2) + "\n";
}

std::string keys_json() {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Key& key : keys()) {
    nlohmann::ordered_json entry = {{"key", full_name(key)}, {"meaning", key.meaning}};
    for (const Fact& fact : about(key).facts) entry[fact.label] = fact.value;
    list.push_back(std::move(entry));
  }
  return list.dump(2) + "\n";
}

}  // namespace gaussdrift::input
