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

/// Calls work(std::integral_constant<int, dimension>). A dimension beyond `highest` counts as `highest`.
template <int lowest, int highest, class Work>
void in_dimension(int dimension, const Work& work) {
  if constexpr (lowest < highest)
    if (dimension != lowest) return in_dimension<lowest + 1, highest>(dimension, work);
  work(std::integral_constant<int, lowest>{});
}

}  // namespace gaussdrift::sum
