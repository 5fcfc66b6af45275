// The points and weights of a request as matrices of Eigen, and the dimension as a constant.
#pragma once

#include <Eigen/Core>
#include <type_traits>

#include "sum/points_request.hpp"

namespace gaussdrift::sum {

/// [d x size]; lives as long as the table.
template <int d>
Eigen::Map<const Eigen::Matrix<double, d, Eigen::Dynamic>> points_of(const input::PointsTable& table) {
  return {table.positions.data(), d, static_cast<Eigen::Index>(table.size())};
}

/// Of the sources; lives as long as the request.
inline Eigen::Map<const Eigen::VectorXd> weights_of(const PointsRequest& request) {
  return {request.sources.weights.data(), static_cast<Eigen::Index>(request.sources.weights.size())};
}

/// The nodes of a grid, its first axis running fastest.
template <int d>
Eigen::Matrix<double, d, Eigen::Dynamic> nodes_as_points(const std::vector<GridAxis>& grid) {
  const auto nodes = nodes_of(grid);
  std::size_t count = 1;
  for (const auto& axis : nodes) count *= axis.size();
  Eigen::Matrix<double, d, Eigen::Dynamic> points(d, static_cast<Eigen::Index>(count));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    std::size_t rest = static_cast<std::size_t>(i);
    for (int l = 0; l < d; ++l) {
      const auto& axis = nodes[static_cast<std::size_t>(l)];
      points(l, i) = axis[rest % axis.size()];
      rest /= axis.size();
    }
  }
  return points;
}

/// Calls work(std::integral_constant<int, dimension>). A dimension beyond `highest` counts as `highest`.
template <int lowest, int highest, class Work>
void in_dimension(int dimension, const Work& work) {
  if constexpr (lowest < highest)
    if (dimension != lowest) return in_dimension<lowest + 1, highest>(dimension, work);
  work(std::integral_constant<int, lowest>{});
}

}  // namespace gaussdrift::sum
