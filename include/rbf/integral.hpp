/// @file
/// Integrals of interpolants over boxes, and quadrature at scattered nodes: part of the library rbf.
#pragma once

#include <Eigen/Core>

#include "rbf/interpolant.hpp"

namespace rbf {

/// Integrals over a box, one for each column of values.
struct Integral {
  Eigen::VectorXd values;  ///< of each column; values times length^d
  /// They are at most so far from the integral of that interpolant; rounding adds about 1e-15 of its terms.
  Eigen::VectorXd errors;
};

/// The integral of an interpolant over the box low <= y <= high, inside or outside the points. The kernel's part is a sum
/// of products of error functions, of the Gaussians that stand for the kernel; the polynomial's part is exact.
/// @throws InvalidArgument  a corner is not finite, or low is above high
/// @throws ToleranceError   the kernel has no such sum on a range that large
template <int d>
Integral integral(const Interpolant<d>& interpolant, const Eigen::Matrix<double, d, 1>& low,
                  const Eigen::Matrix<double, d, 1>& high);

/// Weights w of a quadrature at scattered nodes: sum_i w_i f(x_i) is the integral over the box of the interpolant to the
/// values f(x_i), for every f. They solve the equations of interpolation for the integrals of the kernels.
/// @param function  with its shape, where the kernel takes one: there are no values to choose it by
/// @param nodes     d x N, as the points of an Interpolant
/// @param low       lower corner of the box
/// @param high      its upper corner
/// @param options   as of an Interpolant; the accuracy is relative to the largest integral of a kernel
/// @returns N weights; their sum is the volume for kernels whose polynomials have constants
/// @throws  as Interpolant and integral()
template <int d>
Eigen::VectorXd quadrature_weights(const Function& function, const Eigen::Ref<const Points<d>>& nodes,
                                   const Eigen::Matrix<double, d, 1>& low, const Eigen::Matrix<double, d, 1>& high,
                                   const FitOptions& options = {});

}  // namespace rbf
