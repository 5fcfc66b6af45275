// Least squares for the weights of Gaussians, and for their exponents.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rbf/catalogue.hpp"

namespace rbf::detail {

constexpr int polynomial_terms = 3;  // 1, r^2, r^4

/// The kernel at samples of [near R, R], as rows: values, and derivatives up to `order`, each relative to its scale.
class Fit {
 public:
  /// @param finest  the largest exponent that will be asked for, in units of 1/R^2: samples lie closer at 0
  Fit(const Function& function, double range, double near, int order, const Scales& scales, double finest);

  /// Logarithms of exponents in units of 1/R^2, ascending, and weights of 1, r^2 / R^2, r^4 / R^4 and the Gaussians, in
  /// this order, in units of scales.of[0].
  struct Result {
    Eigen::VectorXd exponents;
    Eigen::VectorXd weights;
    double error = 0;  // the largest of a row
  };
  /// Weights for given exponents.
  Result weights_for(const Eigen::VectorXd& exponents) const;
  /// Moves exponents too, and brings the largest error down, until it is at most `wanted` or does not fall any more.
  Result improved(const Eigen::VectorXd& exponents, double wanted) const;

 private:
  /// Rows of the terms; and, if they are asked for, of the derivatives of the Gaussians by their exponents.
  void fill(const Eigen::VectorXd& exponents, Eigen::MatrixXd& terms, Eigen::MatrixXd* slopes) const;
  Result result(const Eigen::VectorXd& exponents, const Eigen::VectorXd& weights, const Eigen::VectorXd& errors) const;

  std::vector<double> samples_;  // r^2 / R^2
  int order_;
  double slope_, curvature_;  // value scale / scale of the derivative, for R = 1
  Eigen::VectorXd wanted_;
};

/// r^2/R^2 of samples of r/R in [near, 1]: the first, then in geometric progression from at least `first` to 1 with
/// `a_decade` of them, and `even` more, even in the angle of r/R.
std::vector<double> samples_of_range(double near, double first, int a_decade, int even);

}  // namespace rbf::detail
