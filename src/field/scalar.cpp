#include "field/scalar.hpp"

#include <algorithm>
#include <array>

namespace gaussdrift {

namespace {

std::vector<std::string> variables_of(int dimension) {
  return dimension == 3 ? std::vector<std::string>{"x", "y", "z", "t"} : std::vector<std::string>{"x", "y", "t"};
}

}  // namespace

WrittenScalar::WrittenScalar(const std::string& text, int dimension,
                             const std::vector<std::pair<std::string, double>>& params)
    : expression_(text, variables_of(dimension), params) {
  const std::vector<std::string> variables = variables_of(dimension);
  const auto& used = expression_.used_names();
  constant_ = std::none_of(used.begin(), used.end(), [&](const std::string& name) {
    return std::find(variables.begin(), variables.end(), name) != variables.end();
  });
  steady_ = std::find(used.begin(), used.end(), "t") == used.end();
  if (constant_) value_ = expression_.evaluate(std::vector<double>(variables.size(), 0.0));
}

void WrittenScalar::add(double t, const PointsView& x, double* values) const {
  if (constant_) {
    for (std::size_t i = 0; i < x.count; ++i) values[i] += value_;
    return;
  }
  constexpr std::size_t block_length = 512;
  std::array<double, block_length> times, part;
  times.fill(t);
  for (std::size_t first = 0; first < x.count; first += block_length) {
    const std::size_t length = std::min(block_length, x.count - first);
    const PointsView points = x.block(first, length);
    std::array<const double*, max_dimension + 1> arguments{};
    for (int k = 0; k < x.dimension; ++k) arguments[k] = points.axis[k];
    arguments[x.dimension] = times.data();
    expression_.evaluate(arguments.data(), length, part.data());
    for (std::size_t i = 0; i < length; ++i) values[first + i] += part[i];
  }
}

double SumOfScalars::cost() const {
  double sum = 0;
  for (const auto& field : fields_) sum += field->cost();
  return sum;
}

std::string SumOfScalars::describe() const {
  std::string text;
  for (const auto& field : fields_) text += (text.empty() ? "(" : " + (") + field->describe() + ")";
  return text;
}

}  // namespace gaussdrift
