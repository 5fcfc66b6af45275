// Sums of p_0 + p_1 r^2 + p_2 r^4, exactly: few moments of the weights are enough. With y the target, relative to the
// same point as the centres x_j,
//
//     sum_j lambda_j |y - x_j|^2 = |y|^2 A - 2 y.B + C,     A = sum lambda_j, B = sum lambda_j x_j, C = sum lambda_j |x_j|^2
//     sum_j lambda_j |y - x_j|^4 = |y|^2 (|y|^2 A - 4 y.B + 2 C) + 4 y.D y - 4 y.E + F,
//         D = sum lambda_j x_j x_j^T, E = sum lambda_j |x_j|^2 x_j, F = sum lambda_j |x_j|^4
#pragma once

#include <vector>

#include "rbf/expansion/expansion.hpp"

namespace rbf::detail {

template <int d>
class Moments {
 public:
  Moments() = default;
  /// @param centres  relative to a point among them, so that the parts do not cancel
  Moments(const Polynomial& polynomial, const Points<d>& centres, const Eigen::Ref<const Eigen::MatrixXd>& weights);

  /// The sum under a derivative of order 0, 1, 2 for one column of weights.
  double sum(const Derivative<d>& alpha, std::size_t column, const double* target) const;

 private:
  using Vector = Eigen::Matrix<double, d, 1>;
  struct Column {
    double a = 0, c = 0, f = 0;
    Vector b, e;
    Eigen::Matrix<double, d, d> outer;  // D
  };
  Polynomial polynomial_{};
  std::vector<Column> columns_;
};

}  // namespace rbf::detail
