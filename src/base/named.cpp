#include "base/named.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace gaussdrift {

namespace {

const std::vector<double>* find(const Arguments& arguments, std::string_view name) {
  for (const auto& [key, values] : arguments)
    if (key == name) return &values;
  return nullptr;
}

const std::vector<double>& get(const Arguments& arguments, std::string_view name) {
  if (const auto* values = find(arguments, name)) return *values;
  throw std::out_of_range("no argument " + std::string(name));
}

std::size_t length_of(const NamedParameter& parameter, const Box& domain) {
  return parameter.kind == NamedParameter::Kind::point ? static_cast<std::size_t>(domain.dimension) : 1;
}

}  // namespace

std::vector<double> default_value(const NamedParameter& parameter, const Box& domain) {
  const std::size_t length = length_of(parameter, domain);
  const std::string_view text = parameter.fallback;
  std::vector<double> values(length, 0.0);
  if (text == "origin") return values;
  if (text == "none") return {std::numeric_limits<double>::infinity()};
  if (text.substr(0, 7) == "domain.") {
    for (std::size_t k = 0; k < length; ++k) {
      if (text == "domain.min") values[k] = domain.min[k];
      if (text == "domain.max") values[k] = domain.max[k];
      if (text == "domain.center") values[k] = domain.min[k] + (domain.max[k] - domain.min[k]) / 2;
    }
    return values;
  }
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size())
    throw std::logic_error("the default \"" + std::string(text) + "\" of " + std::string(parameter.name) +
                           " means nothing");
  std::fill(values.begin(), values.end(), value);
  return values;
}

Arguments complete(const NamedFormula& formula, const Arguments& given, const Box& domain) {
  return complete(formula.name, formula.parameters, given, domain);
}

Arguments complete(std::string_view thing, const std::vector<NamedParameter>& parameters, const Arguments& given,
                   const Box& domain) {
  Arguments result;
  for (const NamedParameter& parameter : parameters) {
    const auto* values = find(given, parameter.name);
    if (!values && parameter.fallback.empty())
      throw std::invalid_argument(std::string(thing) + " needs " + std::string(parameter.name));
    result.emplace_back(parameter.name, values ? *values : default_value(parameter, domain));
    if (result.back().second.size() != length_of(parameter, domain))
      throw std::invalid_argument(std::string(parameter.name) + " of " + std::string(thing) + " has " +
                                  std::to_string(result.back().second.size()) + " numbers");
  }
  for (const auto& argument : given)
    if (!find(result, argument.first))
      throw std::invalid_argument(std::string(thing) + " has no parameter " + argument.first);
  return result;
}

double number(const Arguments& arguments, std::string_view name) { return get(arguments, name).at(0); }

std::array<double, 3> point(const Arguments& arguments, std::string_view name) {
  std::array<double, 3> result{};
  const auto& values = get(arguments, name);
  std::copy_n(values.begin(), std::min<std::size_t>(3, values.size()), result.begin());
  return result;
}

}  // namespace gaussdrift
