// [params]: names for numbers.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "effect/catalogue.hpp"
#include "expression/expression.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

Section params_section() {
  return {Table{.name = "params",
                .required = false,
                .meaning = "names for numbers, such as `R = 0.25`. A parameter may use those above it"},
          {}};
}

namespace {

bool check_param_name(Reader& in, const Entry& entry) {
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
  if (!why.empty()) in.diagnostics.error(entry.place, why, "reserved names: x, y, z, t, pi, e and the functions");
  return why.empty();
}

}  // namespace

void read_params(Reader& in, Params& params) {
  const Value* home = in.table("params");
  if (!home) return;
  for (const Entry& entry : home->entries) in.later_params.push_back(entry.name);
  for (const Entry& entry : home->entries) {
    const bool named = check_param_name(in, entry);
    const auto value = in.number_in(entry.value, fmt::format("params.{}", entry.name));
    std::erase(in.later_params, entry.name);
    if (!named) continue;
    in.params.push_back({entry.name, value.value_or(1), entry.place, value.has_value(), false});
    params.emplace_back(entry.name, value.value_or(1));
  }
}

void warn_unused_params(Reader& in) {
  for (const Parameter& parameter : in.params)
    if (!parameter.used)
      in.diagnostics.warning(parameter.place, fmt::format("the parameter \"{}\" is not used", parameter.name),
                             "no expression of the case mentions it");
}

namespace {

bool is_expression(const NamedParameter& parameter) {
  return parameter.kind == NamedParameter::Kind::expression ||
         parameter.kind == NamedParameter::Kind::expression_in_time;
}

// Numbers are written as values, so only the parameters that expressions of fields mention are still needed.
Params params_in_use(const Case& spec) {
  std::vector<std::string> texts;
  for (const auto& part : spec.velocity)
    if (const auto* velocity = std::get_if<ExpressionVelocitySpec>(&part))
      texts.insert(texts.end(), velocity->components.begin(), velocity->components.end());
    else if (const auto* stream = std::get_if<StreamfunctionVelocitySpec>(&part))
      texts.push_back(stream->psi);
  for (const auto& part : spec.density)
    if (const auto* density = std::get_if<ExpressionDensitySpec>(&part)) texts.push_back(density->text);
  for (const SourceSpec& source : spec.sources) {
    if (!source.rate.empty()) texts.push_back(source.rate);
    if (const auto* face = std::get_if<FaceSourceSpec>(&source.what)) texts.push_back(face->concentration);
  }
  std::vector<std::string> variables;
  for (const TracerSpec& tracer : spec.tracers) {
    variables.push_back(tracer.name);
    for (const std::string& text : {tracer.gain, tracer.exact})
      if (!text.empty()) texts.push_back(text);
  }
  variables.insert(variables.end(), {"x", "y", "z", "t"});
  if (spec.reference.kind == ReferenceSpec::Kind::exact) texts.push_back(spec.reference.rho);
  for (const auto& [effect, values] : effects_of(spec.effects))
    for (const NamedParameter& parameter : effect->about.parameters)
      if (is_expression(parameter) && values.has(parameter.name)) texts.push_back(values.text(parameter.name));
  std::set<std::string> mentioned;
  for (const std::string& text : texts) {
    const Expression expression(text, variables, spec.params);
    mentioned.insert(expression.used_names().begin(), expression.used_names().end());
  }
  Params params;
  for (const auto& param : spec.params)
    if (mentioned.count(param.first) > 0) params.push_back(param);
  return params;
}

}  // namespace

void write_params(Writer& out, const Case& spec) {
  const Params params = params_in_use(spec);
  if (!params.empty()) out.table("params");
  for (const auto& [name, value] : params) out.entry(name, written(value));
}

}  // namespace gaussdrift::input
