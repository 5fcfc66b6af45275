// The implementation of Interpolant: what a fit leaves, and how it is made.
#pragma once

#include <optional>
#include <vector>

#include "rbf/fit/dense_system.hpp"
#include "rbf/interpolant.hpp"

namespace rbf::detail {

template <int d>
class Fitted {
 public:
  /// Arguments are checked; the shape may be 0: it is chosen.
  Fitted(const Function& function, const Points<d>& points, const Eigen::MatrixXd& values, const FitOptions& options);

  /// What a plan of the sum has to be asked for, so that its error is the accuracy.
  Options evaluation(double range, int derivative_order, std::size_t expected_targets) const;
  /// Adds the polynomial under a combination of derivatives to columns of values at points.
  void add_polynomial(const Points<d>& targets, const std::vector<Combination<d>>& combinations,
                      Eigen::MatrixXd& values) const;

  const FitOptions& options() const { return options_; }
  const Points<d>& points() const { return points_; }
  const Frame<d>& frame() const { return frame_; }
  const Coefficients& coefficients() const { return coefficients_; }
  const Eigen::MatrixXd& left_out_errors() const { return left_out_; }
  const FitReport& report() const { return report_; }

 private:
  /// With the shape that report_ has. Throws IllConditioned.
  void solve(const Eigen::MatrixXd& values);
  void solve_densely(const Eigen::MatrixXd& values);
  void solve_by_krylov(const Eigen::MatrixXd& values);
  /// The left-hand side of the equations, from all pairs.
  Eigen::MatrixXd product(const Coefficients& coefficients) const;
  [[noreturn]] void refuse(const std::string& what) const;

  FitOptions options_;
  Points<d> points_;
  Frame<d> frame_;
  Coefficients coefficients_;
  Eigen::MatrixXd left_out_;
  Eigen::VectorXd largest_;  // |value| of each column
  FitReport report_;
};

}  // namespace rbf::detail
