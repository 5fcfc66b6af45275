// Dense matrices of a kernel.
#pragma once

#include "rbf/rbf.hpp"

namespace rbf::detail {

/// phi(r) of every r^2, in place. Right to a few roundings.
void to_kernel_values(const Function& function, Eigen::Ref<Eigen::MatrixXd> squared_distances);

/// phi(|y_i - x_j|).
template <int d>
Eigen::MatrixXd kernel_matrix(const Function& function, const Points<d>& y, const Points<d>& x);

/// The sign by which the kernel is positive definite on weights that are orthogonal to the polynomials of its order.
double sign_of(Kernel kernel);

}  // namespace rbf::detail
