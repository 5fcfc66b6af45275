// A shape by the errors of left-out values [Rip99], or by the likelihood of the values.
#pragma once

#include <vector>

#include "rbf/interpolant.hpp"

namespace rbf::detail {

/// The typical distance h of neighbouring points: about 8 points lie in a ball that has the volume of 8 h^d. The median of
/// a sample. 0 if points coincide.
template <int d>
double typical_spacing(const Points<d>& points);

/// The spacing; if points coincide, the extent of the points; if all do, 1.
template <int d>
double unit_length(const Points<d>& points);

/// A shape that was tried.
struct TriedShape {
  double shape = 0;
  double error = 0;  // the smaller the better: of left-out values, each column relative to its size; or
                     // -2 ln likelihood, the mean of a value
};

/// Shapes from half the spacing to twice the extent of the points, best first, as long as the condition is below
/// 1/smallest_reciprocal. About 1000 values are left out at most, each predicted from the points around it; the likelihood
/// is that of the same parts of the points.
template <int d>
std::vector<TriedShape> tried_shapes(Kernel kernel, const Points<d>& points, const Eigen::MatrixXd& values,
                                     double spacing, double smallest_reciprocal, const FitOptions& options);

}  // namespace rbf::detail
