#include "field/velocity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace gaussdrift {

namespace {
constexpr std::size_t block_length =
    512;  // points an expression sees at once: its arrays stay in the first-level cache
}

namespace {

bool mentions(const Expression& expression, std::string_view variable) {
  const auto& names = expression.used_names();
  return std::find(names.begin(), names.end(), variable) != names.end();
}

}  // namespace

ExpressionField::ExpressionField(const std::vector<std::string>& components,
                                 const std::vector<std::pair<std::string, double>>& params) {
  std::vector<std::string> variables{"x", "y"};
  if (components.size() == 3) variables.push_back("z");
  variables.push_back("t");
  for (const auto& text : components) components_.emplace_back(text, variables, params);
}

void ExpressionField::add(double t, const PointsView& x, const VectorsView& u) const {
  std::array<double, block_length> times, values;
  times.fill(t);
  for (std::size_t first = 0; first < x.count; first += block_length) {
    const std::size_t length = std::min(block_length, x.count - first);
    const PointsView points = x.block(first, length);
    std::array<const double*, max_dimension + 1> arguments{};
    for (int k = 0; k < x.dimension; ++k) arguments[k] = points.axis[k];
    arguments[x.dimension] = times.data();
    for (int k = 0; k < x.dimension; ++k) {
      components_[k].evaluate(arguments.data(), length, values.data());
      double* out = u.axis[k] + first;
      for (std::size_t i = 0; i < length; ++i) out[i] += values[i];
    }
  }
}

bool ExpressionField::is_solenoidal() const {
  constexpr std::array coordinates{"x", "y", "z"};
  for (std::size_t k = 0; k < components_.size(); ++k)
    if (mentions(components_[k], coordinates[k])) return false;
  return true;
}

bool ExpressionField::is_steady() const {
  return std::none_of(components_.begin(), components_.end(),
                      [](const Expression& component) { return mentions(component, "t"); });
}

std::string ExpressionField::describe() const {
  std::string text = "u = (";
  for (std::size_t k = 0; k < components_.size(); ++k) text += (k ? ", " : "") + components_[k].text();
  return text + ")";
}

void SumField::add(double t, const PointsView& x, const VectorsView& u) const {
  for (const auto& field : fields_) field->add(t, x, u);
}

bool SumField::is_solenoidal() const {
  return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_solenoidal(); });
}

bool SumField::is_steady() const {
  return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_steady(); });
}

std::string SumField::describe() const {
  std::string text;
  for (const auto& field : fields_) text += (text.empty() ? "" : " + ") + field->describe();
  return text.empty() ? "u = 0" : text;
}

}  // namespace gaussdrift
