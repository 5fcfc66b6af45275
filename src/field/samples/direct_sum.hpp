// The interpolant of a fit as a sum over all pairs, at points within its box.
#pragma once

#include "field/samples/sample_fit.hpp"

namespace gaussdrift {

/// What rbf has to be asked for, so that all of the box lies within the range.
template <int d>
double range_of_box(const SampleFit& fit, const rbf::Points<d>& samples) {
  rbf::Points<d> corners(d, 2);
  for (int k = 0; k < d; ++k) {
    corners(k, 0) = fit.low[static_cast<std::size_t>(k)];
    corners(k, 1) = fit.high[static_cast<std::size_t>(k)];
  }
  constexpr double rounding = 1 + 1e-12;
  return rounding * rbf::range_of<d>(samples, corners);
}

template <int d>
rbf::Evaluator<d> direct_sum(const SampleFit& fit, int derivative_order) {
  const auto& function = std::get<rbf::Interpolant<d>>(fit.function);
  return function.evaluator(range_of_box<d>(fit, function.points()), derivative_order, 0, rbf::Method::direct);
}

template <int d>
rbf::Points<d> points_of(const SampleBox::Placed& placed) {
  const auto count = static_cast<Eigen::Index>(placed.index.size());
  rbf::Points<d> points(d, count);
  for (int k = 0; k < d; ++k)
    points.row(k) = Eigen::Map<const Eigen::RowVectorXd>(placed.axis[static_cast<std::size_t>(k)].data(), count);
  return points;
}

/// In values of a formula with a sine or two.
inline double cost_of_pairs(const SampleFit& fit) {
  return std::max(1.0, 0.04 * static_cast<double>(fit.report.points));
}

}  // namespace gaussdrift
