// [params]: names for numbers.
#include <fmt/format.h>

#include <algorithm>

#include "input/tables/tables.hpp"

namespace gaussdrift::input {

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

}  // namespace gaussdrift::input
