/// @file
/// Interpolation and fitting of scattered data by radial basis functions: part of the library rbf.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "rbf/rbf.hpp"

namespace rbf {

/// The data do not determine an interpolant in doubles: the matrix is too near to a singular one, or the iteration does
/// not converge. The message says what helps.
class IllConditioned : public Error {
  using Error::Error;
};

/// How the equations are solved; docs/rbf.md, "Interpolation".
enum class Solver {
  automatic,  ///< `dense` up to Interpolant::dense_points points, else `krylov`
  dense,      ///< a Cholesky factorisation; memory grows with the square of the number of points, time with the cube
  krylov      ///< flexible GMRES over fast sums, preconditioned by overlapping domains; memory is linear
};
/// The name as it is written in files: "auto", "dense", "krylov".
std::string to_string(Solver solver);

/// By what a shape is chosen, where none is given; docs/rbf.md, "Interpolation".
enum class ShapeBy {
  left_out,   ///< the smallest errors of values that are left out [Rip99]
  likelihood  ///< the largest likelihood of the values, as those of a Gaussian process whose covariance is the kernel
};
/// All of them.
const std::vector<ShapeBy>& ways_to_choose_a_shape();
/// The name as it is written in files: "left-out", "likelihood".
std::string to_string(ShapeBy by);

/// What an Interpolant is asked for. The defaults are valid.
struct FitOptions {
  /// Allowed: the largest |equation's error| relative to the largest |value|, in each column. And the error of
  /// evaluation, in the same units, as far as it can be promised: see Interpolant::evaluate.
  double accuracy = 1e-7;
  /// Added to the diagonal of the kernel's matrix, with the sign that makes it more definite; in units of the kernel's
  /// values. 0: the interpolant takes the values. More: it is smoother, and stays near them.
  double regularisation = 0;
  Solver solver = Solver::automatic;                ///< how
  ShapeBy shape_by = ShapeBy::left_out;             ///< where no shape is given
  int most_iterations = 300;                        ///< of `krylov`, for each column
  int threads = 0;                                  ///< 0: all
  std::size_t memory_limit = std::size_t{8} << 30;  ///< bytes that a fit or an evaluation may hold
};

/// What a fit has done, and how good it is.
struct FitReport {
  Function function;              ///< with the shape that was given or chosen
  bool shape_was_chosen = false;  ///< by FitOptions::shape_by
  double spacing = 0;             ///< typical distance of neighbouring points
  std::size_t points = 0;         ///< N
  Solver solver = Solver::dense;  ///< never `automatic`
  double residual = 0;            ///< of the equations, as FitOptions::accuracy; measured
  double condition = 0;           ///< an estimate; dense: of the matrix; krylov: of the worst of its parts
  int iterations = 0;             ///< krylov, all columns
  double seconds = 0;             ///< by the clock
  std::vector<double> left_out;   ///< for each column: the root mean square of Interpolant::left_out_errors()
  /// dense: for each column that is not 0 its ln likelihood as a Gaussian process of covariance tau^2 (|phi| +
  /// regularisation), with the tau that makes it largest; what the polynomial explains is left out (restricted likelihood)
  std::vector<double> log_likelihood;
  std::vector<double> values;  ///< for each column: the root mean square of the values, to compare with
};
/// One line: kernel, solver, residual, condition, and the error of left-out values.
std::ostream& operator<<(std::ostream& out, const FitReport& report);

namespace detail {
template <int d>
class Fitted;
}

/// s prepared to be evaluated often, at targets in a given range. Const, and several threads may call it at a time.
template <int d>
class Evaluator {
 public:
  /// As Interpolant::evaluate, of targets within the range.
  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha = {}) const;
  /// The same on a tensor grid, the first axis fastest.
  Eigen::MatrixXd evaluate(const TensorGrid& grid, const Derivative<d>& alpha = {}) const;
  /// As Plan::evaluate_combinations.
  Eigen::MatrixXd evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                        const std::vector<Combination<d>>& combinations) const;
  /// As Plan::evaluate_combinations.
  Eigen::MatrixXd evaluate_combinations(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;
  /// How the sum is computed.
  const Choice& choice() const { return plan_.choice(); }

 private:
  template <int>
  friend class Interpolant;
  Evaluator(std::shared_ptr<const detail::Fitted<d>> fitted, const Options& options);
  std::shared_ptr<const detail::Fitted<d>> fitted_;
  Plan<d> plan_;
};

/// A function that takes given values at given points, or stays near them:
///
///     s(y) = sum_j lambda_j phi(|y - x_j|) + p(y),    s(x_i) + regularisation lambda_i = f_i,    sum_j lambda_j q(x_j) = 0
///
/// for all polynomials q of degree below the kernel's positive_order(), of which p is one: none for order 0, a constant
/// for multiquadric, a linear polynomial for thin_plate. (For multiquadric the sign of the regularisation is turned.)
/// Polynomials of these degrees are reproduced.
template <int d>
class Interpolant {
  static_assert(1 <= d && d <= 3, "rbf: dimensions 1 to 3");

 public:
  /// `automatic` factorises up to so many points.
  static constexpr std::size_t dense_points = 1500;

  /// Fits.
  /// @param function  the kernel; a shape of 0 is chosen, where the kernel takes one
  /// @param points    d x N, finite, N >= 1; distinct, unless there is regularisation
  /// @param values    N x c: c columns of values, finite
  /// @param options   what is asked for
  /// @throws InvalidArgument   an argument breaks one of these rules, or the points do not determine the polynomial
  /// @throws IllConditioned    there is no solution in doubles
  /// @throws MemoryLimitError  the fit would need more than FitOptions::memory_limit
  Interpolant(const Function& function, const Eigen::Ref<const Points<d>>& points,
              const Eigen::Ref<const Eigen::MatrixXd>& values, const FitOptions& options = {});

  /// D^alpha s at scattered targets, anywhere.
  ///
  /// The error is at most FitOptions::accuracy times the largest |value| for alpha = 0, unless the weights are so large
  /// that this is less than Plan can promise; then the best that it promises.
  /// @returns M x c
  /// @throws InvalidArgument   a target is not finite, or |alpha| is above highest_derivative(kernel)
  /// @throws MemoryLimitError  the evaluation would need more than FitOptions::memory_limit
  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha = {}) const;
  /// The same on a tensor grid, the first axis fastest.
  Eigen::MatrixXd evaluate(const TensorGrid& grid, const Derivative<d>& alpha = {}) const;
  /// Several linear combinations of derivatives in one pass, as Plan::evaluate_combinations.
  Eigen::MatrixXd evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                        const std::vector<Combination<d>>& combinations) const;
  /// The same on a tensor grid.
  Eigen::MatrixXd evaluate_combinations(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;

  /// For many evaluations.
  /// @param range             as Options::range: range_of() tells it; 0: targets inside the box around the points
  /// @param derivative_order  as Options::derivative_order
  /// @param expected_targets  as Options::expected_targets
  /// @param method            as Options::method; with `direct` a value does not depend on what other targets there are
  Evaluator<d> evaluator(double range = 0, int derivative_order = 0, std::size_t expected_targets = 0,
                         Method method = Method::automatic) const;

  /// The points: d x N.
  const Points<d>& points() const;
  /// lambda: N x c.
  const Eigen::MatrixXd& weights() const;
  /// Coefficients of p: 1, then (y_l - middle_l) / unit, with the middle of the box around the points and half of its
  /// longest side. A column for each column of values.
  const Eigen::MatrixXd& polynomial() const;
  /// The error of each value, if the others predict it [Rip99]: N x c. `dense`: from all others. `krylov`: from those
  /// around it, some 200. The errors between random points are of this size, between even ones less.
  const Eigen::MatrixXd& left_out_errors() const;
  /// What was done.
  const FitReport& report() const;

 private:
  std::shared_ptr<const detail::Fitted<d>> fitted_;
};

/// The error at points that the fit does not see: the points are dealt out into `folds` groups, and each group is
/// predicted by a fit to the others.
/// @returns N x c: prediction minus value
/// @throws  as Interpolant; InvalidArgument if folds < 2 or folds > N
template <int d>
Eigen::MatrixXd cross_validation_errors(const Function& function, const Eigen::Ref<const Points<d>>& points,
                                        const Eigen::Ref<const Eigen::MatrixXd>& values, int folds,
                                        const FitOptions& options = {});

extern template class Evaluator<1>;
extern template class Evaluator<2>;
extern template class Evaluator<3>;
extern template class Interpolant<1>;
extern template class Interpolant<2>;
extern template class Interpolant<3>;

}  // namespace rbf
