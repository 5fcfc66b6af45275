#include "field/velocity/expression_field.hpp"

#include <algorithm>
#include <array>

#include "field/velocity/in_blocks.hpp"

namespace gaussdrift {

ExpressionField::ExpressionField(const std::vector<std::string>& components,
                                 const std::vector<std::pair<std::string, double>>& params) {
  std::vector<std::string> variables{"x", "y"};
  if (components.size() == 3) variables.push_back("z");
  variables.push_back("t");
  for (const auto& text : components) components_.emplace_back(text, variables, params);
}

void ExpressionField::add(double t, const PointsView& x, const VectorsView& u) const {
  std::array<double, block_length> values;
  for_blocks(t, x, [&](std::size_t first, const double* const* arguments, std::size_t length) {
    for (int k = 0; k < x.dimension; ++k) {
      components_[k].evaluate(arguments, length, values.data());
      add_block(values.data(), length, u.axis[k] + first);
    }
  });
}

void ExpressionField::add_divergence(double t, const PointsView& x, double* values) const {
  std::array<double, block_length> slope;
  for_blocks(t, x, [&](std::size_t first, const double* const* arguments, std::size_t length) {
    for (int k = 0; k < x.dimension; ++k) {
      double* const slopes[] = {slope.data()};
      components_[k].differentiate(arguments, length, {static_cast<std::size_t>(k)}, nullptr, slopes);
      add_block(slope.data(), length, values + first);
    }
  });
}

void ExpressionField::add_gradient(double t, const PointsView& x, const GradientsView& gradients) const {
  std::array<std::array<double, block_length>, max_dimension> slope;
  const std::vector<std::size_t> axes =
      x.dimension == 3 ? std::vector<std::size_t>{0, 1, 2} : std::vector<std::size_t>{0, 1};
  double* const slopes[] = {slope[0].data(), slope[1].data(), slope[2].data()};
  for_blocks(t, x, [&](std::size_t first, const double* const* arguments, std::size_t length) {
    for (int k = 0; k < x.dimension; ++k) {
      components_[k].differentiate(arguments, length, axes, nullptr, slopes);
      for (int i = 0; i < x.dimension; ++i) add_block(slopes[i], length, gradients.slope[k][i] + first);
    }
  });
}

bool ExpressionField::is_steady() const {
  return std::none_of(components_.begin(), components_.end(), [](const Expression& part) { return part.uses("t"); });
}

bool ExpressionField::is_smooth() const {
  return std::all_of(components_.begin(), components_.end(),
                     [](const Expression& part) { return part.rough_spots().empty(); });
}

double ExpressionField::cost() const {
  double sum = 0;
  for (const Expression& part : components_) sum += part.cost();
  return std::max(1.0, sum);
}

bool ExpressionField::is_solenoidal() const {
  constexpr std::array coordinates{"x", "y", "z"};
  for (std::size_t k = 0; k < components_.size(); ++k)
    if (components_[k].uses(coordinates[k])) return false;
  return true;
}

std::string ExpressionField::describe() const {
  std::string text = "u = (";
  for (std::size_t k = 0; k < components_.size(); ++k) text += (k ? ", " : "") + components_[k].text();
  return text + ")";
}

}  // namespace gaussdrift
