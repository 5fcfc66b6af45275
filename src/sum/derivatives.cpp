#include "sum/derivatives.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string_view>

#include "base/number.hpp"
#include "gaussdrift/error.hpp"
#include "sum/points_request.hpp"

namespace gaussdrift::sum {

std::vector<int> parse_derivative(const std::string& text) {
  std::vector<int> derivative;
  for (const std::string_view part : split(text, ',')) {
    const auto order = base::read_number<int>(part);
    if (!order || *order < 0)
      throw CommandLineError(
          fmt::format("--derivative: \"{}\" in \"{}\" is not an order; write one number for every coordinate, as in "
                      "--derivative 0,1,2",
                      part, text));
    derivative.push_back(*order);
  }
  return derivative;
}

double order_of(const std::vector<int>& derivative) {
  double order = 0;
  for (const int part : derivative) order += part;
  return order;
}

int highest_order_of(const std::vector<std::vector<int>>& derivatives) {
  double highest = 0;
  for (const auto& derivative : derivatives) highest = std::max(highest, order_of(derivative));
  return static_cast<int>(std::min(highest, 1e6));
}

void check_derivatives(const std::vector<std::vector<int>>& derivatives, const input::PointsTable& sources, int highest,
                       const std::string& why) {
  for (const auto& derivative : derivatives) {
    if (derivative.size() != sources.coordinates.size())
      throw CommandLineError(fmt::format("--derivative {} has {} {}, but the sources have {} ({})",
                                         fmt::join(derivative, ","), derivative.size(),
                                         derivative.size() == 1 ? "number" : "numbers", sources.coordinates.size(),
                                         fmt::join(sources.coordinates, ", ")));
    if (order_of(derivative) > highest)
      throw CommandLineError(fmt::format("--derivative {}: the orders add up to {:g}, at most {} is possible{}",
                                         fmt::join(derivative, ","), order_of(derivative), highest, why));
    if (std::count(derivatives.begin(), derivatives.end(), derivative) > 1)
      throw CommandLineError(fmt::format("--derivative {} is there twice", fmt::join(derivative, ",")));
  }
}

std::string column_name(const std::vector<int>& derivative) { return fmt::format("d_{}", fmt::join(derivative, "_")); }

void check_values(const std::vector<std::string>& columns, const Eigen::MatrixXd& values, const char* remedy) {
  for (Eigen::Index k = 0; k < values.cols(); ++k)
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      if (!std::isfinite(values(i, k)))
        throw NumericalError(fmt::format("{} at target {} (counted from 1) is {}; {}",
                                         columns[static_cast<std::size_t>(k)], i + 1, values(i, k), remedy));
}

}  // namespace gaussdrift::sum
