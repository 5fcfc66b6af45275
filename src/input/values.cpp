// Values of keys: of their type, in their range, or a complaint.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/duration_text.hpp"
#include "base/suggest.hpp"
#include "field/gridded/grid_data.hpp"
#include "input/foreign_keys.hpp"
#include "input/reader.hpp"

namespace gaussdrift::input {

using Kind = Value::Kind;

std::string Reader::text(std::string_view table_name, std::string_view name) {
  const Key& key = find_key(table_name, name);
  const Entry* entry = find(table_name, name);
  if (!entry) return std::string(key.fallback);
  if (entry->value.kind != Kind::text) wrong_type(entry->value, label_of(key), type_text(key));
  return entry->value.text;
}

std::vector<std::pair<std::string, double>> Reader::constants() const {
  std::vector<std::pair<std::string, double>> list;
  for (const Parameter& parameter : params) list.emplace_back(parameter.name, parameter.value);
  return list;
}

bool Reader::use(const std::vector<std::string>& names) {
  bool valid = true;
  for (Parameter& parameter : params)
    if (std::find(names.begin(), names.end(), parameter.name) != names.end()) {
      parameter.used = true;
      valid = valid && parameter.valid;
    }
  return valid;
}

void Reader::expression_error(const Value& value, const ExpressionError& error, const std::string& message,
                              const std::string& note) {
  diagnostics.error(place_in_text(value, source, error.position(), error.length()), message, note);
}

namespace {

constexpr std::string_view unit_of_times = "time";  // the keys that may be dates

/// "2020-01-03 12:30"; as an expression it would be a difference.
bool looks_like_date(std::string_view text) {
  const auto digits = [&](std::size_t most) {
    std::size_t count = 0;
    while (count < most && !text.empty() && text.front() >= '0' && text.front() <= '9') text.remove_prefix(1), ++count;
    return count;
  };
  const auto dash = [&] { return !text.empty() && text.front() == '-' && (text.remove_prefix(1), true); };
  return digits(6) >= 4 && dash() && digits(2) > 0 && dash() && digits(2) > 0;
}

}  // namespace

std::optional<double> Reader::time_of_date(const Value& value, const std::string& label) {
  for (const auto& [place, data] : facts.grid_files) {
    if (!data->dates) continue;
    if (const auto time = data->dates->time(value.text)) return time;
    diagnostics.error(value.place,
                      fmt::format("{} is no date of the calendar of {}: \"{}\"", label, data->name, value.text),
                      "a date is written as in \"2020-01-03\" or \"2020-01-03 12:30\"");
    return std::nullopt;
  }
  if (diagnostics.errors() == 0)  // else the data may not have been read
    diagnostics.error(value.place, fmt::format("{} is a date, and no data of the case have dates", label),
                      "give a number; NetCDF files with several times have dates");
  return std::nullopt;
}

std::optional<double> Reader::number_in(const Value& value, const std::string& label, bool is_time) {
  double number = value.number;
  if ((value.kind == Kind::text || value.kind == Kind::date) && is_time && looks_like_date(value.text))
    return time_of_date(value, label);
  if (value.kind == Kind::text) {
    try {
      const Expression expression(value.text, {}, constants());
      if (!use(expression.used_names())) return std::nullopt;
      number = expression.evaluate();
    } catch (const ExpressionError& error) {
      const std::string token = value.text.substr(std::min(error.position(), value.text.size()), error.length());
      std::string message = error.what();
      if (token == "x" || token == "y" || token == "z" || token == "t")
        message = fmt::format("\"{}\" has no value here: {} is one number for the whole run", token, label);
      else if (std::find(later_params.begin(), later_params.end(), token) != later_params.end())
        message = fmt::format("\"{}\" is not defined yet; a parameter may use those before it", token);
      expression_error(value, error, message, fmt::format("{} may be an expression of the params, pi and e", label));
      return std::nullopt;
    }
  } else if (value.kind != Kind::whole && value.kind != Kind::number) {
    wrong_type(value, label, "a number or an expression");
    return std::nullopt;
  }
  if (!std::isfinite(number)) {
    diagnostics.error(value.place, fmt::format("{} must be finite, found {}", label, found_number(number, value)));
    return std::nullopt;
  }
  return number;
}

std::optional<Number> Reader::number(std::string_view table_name, std::string_view name, const std::string& note) {
  const Key& key = find_key(table_name, name);
  const Entry* entry = key.required ? require(key) : find(table_name, name);
  if (!entry) {
    double value = 0;
    const auto read = std::from_chars(key.fallback.data(), key.fallback.data() + key.fallback.size(), value);
    return read.ec == std::errc() ? std::optional(Number{value, nullptr}) : std::nullopt;
  }
  const auto value = number_of(key, *entry, note);
  return value ? std::optional(Number{*value, &entry->value}) : std::nullopt;
}

std::optional<double> Reader::number_of(const Key& key, const Entry& entry, const std::string& note) {
  const auto value = number_in(entry.value, label_of(key), key.unit == unit_of_times);
  return value && check_range(key, *value, entry.value, note) ? value : std::nullopt;
}

std::optional<double> Reader::duration(std::string_view table_name, std::string_view name) {
  const Key& key = find_key(table_name, name);
  const Entry* entry = find(table_name, name);
  if (!entry) return std::nullopt;
  if (entry->value.kind != Value::Kind::text) return number_of(key, *entry);
  if (const auto seconds = base::read_duration(entry->value.text)) return seconds;
  diagnostics.error(entry->value.place,
                    fmt::format("{} is no length of time: \"{}\"", label_of(key), entry->value.text),
                    fmt::format("give {}", base::duration_form));
  return std::nullopt;
}

Arguments Reader::arguments(const Key& kind, const NamedFormula& formula, const Value& written) {
  if (facts.dimension && (facts.dimension < formula.least_dimension || facts.dimension > formula.most_dimension))
    diagnostics.error(written.place, fmt::format("\"{}\" exists only in {}D; the domain has {} dimensions",
                                                 formula.name, formula.least_dimension, facts.dimension));
  Arguments given;
  for (const NamedParameter& parameter : formula.parameters) {
    const Key& key = find_key(kind.table, parameter.name, formula.name);
    const Entry* entry = key.required ? require(key) : find(key.table, key.name);
    if (!entry) continue;
    if (key.type == Type::point) {
      if (const auto values = point_of(key, *entry)) given.emplace_back(key.name, *values);
    } else if (const auto value = number_of(key, *entry)) {
      given.emplace_back(key.name, std::vector{*value});
    }
  }
  if (diagnostics.errors() > 0) return given;
  const Arguments all = complete(formula, given, facts.box);
  const std::string problem = formula.problem ? formula.problem(facts.dimension, all) : "";
  if (!problem.empty()) diagnostics.error(written.place, fmt::format("{}: {}", formula.name, problem));
  return all;
}

bool Reader::check_range(const Key& key, double value, const Value& written, const std::string& note) {
  std::string rule;
  if (key.type == Type::whole && value != std::floor(value)) rule = "a whole number";
  if (!key.range.contains(value)) rule = range_text(key.range);
  if (rule.empty()) return true;
  diagnostics.error(written.place,
                    fmt::format("{} must be {}, found {}", label_of(key), rule, found_number(value, written)),
                    note.empty() ? meaning_note(key) : note);
  return false;
}

std::optional<std::vector<double>> Reader::numbers(const Entry& entry, const Key& key) {
  if (entry.value.kind != Kind::list) {
    wrong_type(entry.value, label_of(key), type_text(key));
    return std::nullopt;
  }
  std::vector<double> list;
  bool valid = true;
  for (std::size_t k = 0; k < entry.value.items.size(); ++k) {
    const auto value =
        number_in(entry.value.items[k], fmt::format("entry {} of {}", k + 1, label_of(key)), key.unit == unit_of_times);
    valid = valid && value;
    list.push_back(value.value_or(0));
  }
  return valid ? std::optional(list) : std::nullopt;
}

std::optional<std::vector<double>> Reader::point_of(const Key& key, const Entry& entry) {
  const auto list = numbers(entry, key);
  if (!list || (facts.dimension && !has_entries(entry.value, key, "number"))) return std::nullopt;
  for (std::size_t k = 0; k < list->size(); ++k)
    if (!check_range(key, (*list)[k], entry.value.items[k])) return std::nullopt;
  return list;
}

bool Reader::has_entries(const Value& value, const Key& key, std::string_view what) {
  if (value.items.size() == static_cast<std::size_t>(facts.dimension)) return true;
  diagnostics.error(value.place, fmt::format("{} needs {} {}s, one for each axis of the domain, found {}",
                                             label_of(key), facts.dimension, what, value.items.size()));
  return false;
}

std::optional<std::size_t> Reader::choice_in(const Value& value, const Key& key, const std::string& label) {
  const std::string note = fmt::format("known values: {}", quoted_list(key.choices));
  if (value.kind != Kind::text) {
    diagnostics.error(value.place, fmt::format("{} must be a string, found {}", label, value.description()), note);
    return std::nullopt;
  }
  const auto found = std::find(key.choices.begin(), key.choices.end(), value.text);
  if (found != key.choices.end()) return static_cast<std::size_t>(found - key.choices.begin());
  const auto near = base::suggest(value.text, {key.choices.begin(), key.choices.end()});
  diagnostics.error(value.place,
                    fmt::format("unknown value \"{}\" for {}{}", value.text, label,
                                near ? fmt::format("; did you mean \"{}\"?", *near) : ""),
                    find_foreign_key(value.text) ? answer_to(value.text, "") + "; " + note : note);
  return std::nullopt;
}

std::string Reader::choice(std::string_view table_name, std::string_view name) {
  const Key& key = find_key(table_name, name);
  const Entry* entry = find(table_name, name);
  const auto index = entry ? choice_in(entry->value, key, label_of(key)) : std::nullopt;
  return std::string(index ? key.choices[*index] : key.fallback);
}

bool Reader::flag(std::string_view table_name, std::string_view name) {
  const Entry* entry = find(table_name, name);
  if (!entry) return false;
  if (entry->value.kind == Kind::boolean) return entry->value.boolean;
  const Key& key = find_key(table_name, name);
  wrong_type(entry->value, label_of(key), type_text(key));
  return false;
}

std::vector<std::size_t> Reader::choices(std::string_view table_name, std::string_view name) {
  const Key& key = find_key(table_name, name);
  const Entry* entry = find(table_name, name);
  std::vector<std::size_t> result;
  if (!entry) {  // the default: those choices that the registry names
    const auto named = [&](std::string_view word) {
      const auto words = ", " + std::string(key.fallback) + ",";
      return words.find(fmt::format(", {},", word)) != std::string::npos;
    };
    for (std::size_t k = 0; k < key.choices.size(); ++k)
      if (named(key.choices[k])) result.push_back(k);
    return result;
  }
  if (entry->value.kind != Kind::list) {
    wrong_type(entry->value, label_of(key), type_text(key));
    return result;
  }
  for (std::size_t k = 0; k < entry->value.items.size(); ++k) {
    const Value& item = entry->value.items[k];
    if (const auto index = choice_in(item, key, fmt::format("entry {} of {}", k + 1, label_of(key)))) {
      if (std::find(result.begin(), result.end(), *index) != result.end())
        diagnostics.error(item.place, fmt::format("\"{}\" appears twice in {}", item.text, label_of(key)));
      result.push_back(*index);
    }
  }
  return result;
}

std::string Reader::field_expression(const Value& value, const std::string& label, bool with_time) {
  std::vector<std::string> variables{"x", "y"};
  if (facts.dimension != 2) variables.emplace_back("z");
  if (with_time) variables.emplace_back("t");
  return expression_of(value, label, variables, [&](const std::string& token) -> std::string {
    if (token == "z" && facts.dimension == 2) return "z exists only in 3D; the domain has 2 dimensions";
    if (token == "t" && !with_time) return "the density at the start cannot depend on t";
    return "";
  });
}

std::string Reader::tracer_expression(const Value& value, const std::string& label,
                                      const std::vector<std::string>& tracers) {
  std::vector<std::string> variables = tracers;
  variables.insert(variables.end(), {"x", "y"});
  if (facts.dimension != 2) variables.emplace_back("z");
  variables.emplace_back("t");
  return expression_of(value, label, variables, [](const std::string&) { return ""; });
}

std::string Reader::time_expression(const Value& value, const std::string& label) {
  return expression_of(value, label, {"t"}, [&](const std::string& token) {
    const bool place = token == "x" || token == "y" || token == "z";
    return place ? fmt::format("{} depends on the time t alone, not on {}", label, token) : "";
  });
}

std::string Reader::expression_of(const Value& value, const std::string& label,
                                  const std::vector<std::string>& variables,
                                  const std::function<std::string(const std::string& token)>& explain) {
  if (value.kind == Kind::whole || value.kind == Kind::number) {
    if (!std::isfinite(value.number))
      diagnostics.error(value.place, fmt::format("{} must be finite, found {}", label, value.number));
    return value.kind == Kind::whole ? fmt::format("{}", value.whole) : fmt::format("{}", value.number);
  }
  if (value.kind != Kind::text) {
    wrong_type(value, label, "an expression in a string");
    return "";
  }
  try {
    use(Expression(value.text, variables, constants()).used_names());
  } catch (const ExpressionError& error) {
    const std::string token = value.text.substr(std::min(error.position(), value.text.size()), error.length());
    const std::string reason = explain(token);
    expression_error(value, error, reason.empty() ? error.what() : reason, "");
  }
  return value.text;
}

}  // namespace gaussdrift::input
