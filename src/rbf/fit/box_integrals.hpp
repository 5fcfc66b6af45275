// Integrals of a kernel over a box: every Gaussian of its expansion is a product of error functions, and r^2 and r^4 are
// polynomials.
#pragma once

#include "rbf/rbf.hpp"

namespace rbf::detail {

template <int d>
struct Box {
  Eigen::Matrix<double, d, 1> low, high;
  double volume() const { return (high - low).prod(); }
  /// The farthest that a point of the box can be from one of `points`.
  double range(const Points<d>& points) const;
};

struct BoxIntegrals {
  Eigen::VectorXd values;  // of phi(|y - x_j|) over the box, for each centre x_j
  double error = 0;        // of each, at most: the kernel's error on the range times the volume
};

/// @throws ToleranceError  the kernel has no expansion to 1e-6
template <int d>
BoxIntegrals box_integrals(const Function& function, const Points<d>& centres, const Box<d>& box, int threads);

}  // namespace rbf::detail
