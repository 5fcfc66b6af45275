#include "rbf/fit/fitted.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "rbf/check.hpp"
#include "rbf/derivatives.hpp"
#include "rbf/fit/check_fit.hpp"
#include "rbf/fit/kernel_matrix.hpp"
#include "rbf/fit/krylov.hpp"
#include "rbf/fit/schwarz.hpp"
#include "rbf/fit/shape.hpp"

namespace rbf::detail {
namespace {

using Index = Eigen::Index;

// Beyond this condition the digits of a solution mean nothing.
constexpr double smallest_reciprocal = 100 * std::numeric_limits<double>::epsilon();
// A shape is chosen such that the condition is far from that. By dimension: the iteration converges in a few steps while
// kernels reach over few points, and in more dimensions more points are near.
constexpr double comfortable_dense = 1e-12, comfortable_krylov[] = {1e-13, 1e-10, 1e-8};
constexpr double rough = 0.1;  // times that for Matern kernels: measured, they still converge

// A cycle of the iteration goes this far. Sums in it are right to a tolerance that is lowered if a cycle gains little: close
// points have large weights that cancel.
constexpr double cycle_factor = 1e-3;
constexpr int cycle_iterations = 50;
constexpr double cycle_tolerance = 1e-7, lowered_by = 1e-2;
constexpr double part_of_sums = 0.25;  // of the accuracy, for the sum that measures the residual

SchwarzParameters parameters_of(int dimension) {
  SchwarzParameters how;
  how.dense = static_cast<Index>(Interpolant<1>::dense_points);
  if (dimension == 3) how.around = 350;
  return how;
}

/// What an iteration has reached.
struct Solved {
  Coefficients coefficients;
  double residual = 0;  // largest |error| of an equation
  int iterations = 0;
};

/// The iteration, in cycles: from the residual a correction by flexible GMRES, then the residual anew.
template <int d>
class Cycles {
 public:
  Cycles(const Function& function, const Points<d>& points, const Frame<d>& frame, const Schwarz<d>& preconditioner,
         const FitOptions& options)
      : function_(function),
        points_(points),
        polynomials_(frame.values(points)),
        options_(options),
        in_cycles_(plan(cycle_tolerance)),
        operators_{[&](const Eigen::VectorXd& of) { return preconditioner.solve(of); },
                   [this](const Coefficients& of) { return product(in_cycles_, of); }} {}
  Cycles(const Cycles&) = delete;
  Cycles& operator=(const Cycles&) = delete;

  /// Coefficients with errors of at most `allowed`, or the best that were found.
  Solved solve(const Eigen::VectorXd& values, double allowed) {
    Solved best{{Eigen::VectorXd::Zero(values.size()), Eigen::VectorXd::Zero(polynomials_.cols())}};
    best.residual = values.cwiseAbs().maxCoeff();
    Eigen::VectorXd left = values;
    for (;;) {
      const bool last = best.residual * cycle_factor <= allowed;
      const double factor = last ? std::min(0.5, 0.3 * allowed / best.residual) : cycle_factor;
      const int most = std::min(cycle_iterations, options_.most_iterations - best.iterations);
      Coefficients sum = flexible_gmres(operators_, left, factor, most, best.iterations);
      sum.weights += best.coefficients.weights;
      sum.polynomial += best.coefficients.polynomial;
      if (!sum.weights.allFinite()) return best;
      const double wanted = last ? part_of_sums * allowed : 0.01 * factor * best.residual;
      Plan<d> exact = plan(wanted / (in_cycles_.choice().largest * sum.weights.cwiseAbs().sum()));
      const Eigen::VectorXd now_left = values - product(exact, sum);
      const double before = best.residual, after = now_left.cwiseAbs().maxCoeff();
      if (after < before) {
        best.coefficients = std::move(sum);
        best.residual = after;
        left = now_left;
      }
      if ((last && after <= allowed) || best.iterations >= options_.most_iterations) return best;
      if (after <= 0.3 * before) continue;
      if (in_cycles_.choice().tolerance <= smallest_tolerance) return best;
      in_cycles_ = plan(in_cycles_.choice().tolerance * lowered_by);
    }
  }

 private:
  /// The sum, for weights that are set later.
  Plan<d> plan(double tolerance) const {
    return Plan<d>(function_, points_, Eigen::VectorXd::Zero(points_.cols()),
                   {.tolerance = std::min(cycle_tolerance, std::max(smallest_tolerance, tolerance)),
                    .threads = options_.threads,
                    .memory_limit = options_.memory_limit});
  }
  Eigen::VectorXd product(Plan<d>& sum, const Coefficients& coefficients) const {
    sum.set_weights(coefficients.weights);
    return sum.evaluate(points_).col(0) + polynomials_ * coefficients.polynomial.col(0) +
           sign_of(function_.kernel) * options_.regularisation * coefficients.weights.col(0);
  }

  Function function_;
  const Points<d>& points_;
  Eigen::MatrixXd polynomials_;
  FitOptions options_;
  Plan<d> in_cycles_;
  Operators operators_;
};

}  // namespace

template <int d>
Fitted<d>::Fitted(const Function& function, const Points<d>& points, const Eigen::MatrixXd& values,
                  const FitOptions& options)
    : options_(options), points_(points), frame_(points, positive_order(function.kernel)) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begun = Clock::now();
  report_.function = function;
  report_.points = static_cast<std::size_t>(points.cols());
  report_.solver = options.solver;
  if (options.solver == Solver::automatic)
    report_.solver = report_.points <= Interpolant<d>::dense_points ? Solver::dense : Solver::krylov;
  largest_ = values.cwiseAbs().colwise().maxCoeff();
  report_.spacing = typical_spacing<d>(points_);
  report_.shape_was_chosen = takes_shape(function.kernel) && function.shape == 0;
  if (!report_.shape_was_chosen) {
    solve(values);
  } else if (!(report_.spacing > 0)) {  // one point, or points many times
    report_.function.shape = unit_length<d>(points_);
    solve(values);
  } else {
    const bool is_rough = function.kernel == Kernel::matern32 || function.kernel == Kernel::matern52;
    const double comfortable = report_.solver == Solver::dense
                                   ? comfortable_dense
                                   : std::max(smallest_reciprocal, comfortable_krylov[d - 1] * (is_rough ? rough : 1));
    std::vector<TriedShape> tried =
        tried_shapes<d>(function.kernel, points_, values, report_.spacing, comfortable, options);
    // What is tried are parts of the points. If all of them together are too ill-conditioned, a smaller shape is taken.
    for (;;) {
      report_.function.shape = tried.empty() ? report_.spacing / 2 : tried.front().shape;
      try {
        solve(values);
        break;
      } catch (const IllConditioned&) {
        std::erase_if(tried, [&](const TriedShape& one) { return one.shape >= report_.function.shape; });
        if (tried.empty()) throw;
      }
    }
  }
  for (Index k = 0; k < values.cols(); ++k) {
    const double count = static_cast<double>(values.rows());
    report_.left_out.push_back(std::sqrt(left_out_.col(k).squaredNorm() / count));
    report_.values.push_back(std::sqrt(values.col(k).squaredNorm() / count));
  }
  report_.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
}

template <int d>
void Fitted<d>::refuse(const std::string& what) const {
  refuse_condition<d>(report_, points_, options_, what);
}

template <int d>
void Fitted<d>::solve(const Eigen::MatrixXd& values) {
  if (report_.solver == Solver::dense)
    solve_densely(values);
  else
    solve_by_krylov(values);
}

template <int d>
Eigen::MatrixXd Fitted<d>::product(const Coefficients& coefficients) const {
  Eigen::MatrixXd found = frame_.values(points_) * coefficients.polynomial +
                          sign_of(report_.function.kernel) * options_.regularisation * coefficients.weights;
  constexpr Index piece = 128;
  const Index count = points_.cols(), pieces = (count + piece - 1) / piece;
  gaussdrift::base::parallel_for(
      {static_cast<std::size_t>(pieces), 1e-8 * static_cast<double>(count) * static_cast<double>(count)},
      options_.threads, [&](std::size_t i) {
        const Index begin = static_cast<Index>(i) * piece, size = std::min(piece, count - begin);
        const Points<d> some = points_.middleCols(begin, size);
        found.middleRows(begin, size) += kernel_matrix<d>(report_.function, some, points_) * coefficients.weights;
      });
  return found;
}

template <int d>
void Fitted<d>::solve_densely(const Eigen::MatrixXd& values) {
  const double count = static_cast<double>(points_.cols());
  check_memory("a dense fit", 8 * count * (3 * count + 6 * static_cast<double>(values.cols())), options_.memory_limit);
  const DenseSystem system = DenseSystem::of<d>(report_.function, points_, frame_, options_.regularisation);
  const double reciprocal = system.reciprocal_condition();
  report_.condition = 1 / reciprocal;
  if (reciprocal < smallest_reciprocal)
    refuse(reciprocal > 0 ? "the matrix has a condition of about " + text(1 / reciprocal)
                          : std::string("the matrix is not definite to rounding"));
  coefficients_ = system.solve(values);
  Eigen::MatrixXd left = values - product(coefficients_);
  const Coefficients more = system.solve(left);
  coefficients_.weights += more.weights;
  coefficients_.polynomial += more.polynomial;
  left = values - product(coefficients_);
  report_.residual = 0;
  for (Index k = 0; k < values.cols(); ++k)
    if (largest_[k] > 0) report_.residual = std::max(report_.residual, left.col(k).cwiseAbs().maxCoeff() / largest_[k]);
  if (!(report_.residual <= options_.accuracy))
    refuse("the equations are met to " + text(report_.residual) + " only, FitOptions::accuracy is " +
           text(options_.accuracy));
  const Coefficients solution = system.solve(values);
  const DenseSystem::Gaussian gaussian = system.gaussian(values, solution);
  for (Index k = 0; k < values.cols(); ++k)
    if (largest_[k] > 0) report_.log_likelihood.push_back(gaussian.log_likelihood(k));
  left_out_ = solution.weights;
  const Eigen::VectorXd diagonal = system.weight_diagonal();
  left_out_ = diagonal.cwiseInverse().asDiagonal() * left_out_;
}

template <int d>
void Fitted<d>::solve_by_krylov(const Eigen::MatrixXd& values) {
  const Function& function = report_.function;
  const Index count = points_.cols();
  const SchwarzParameters how = parameters_of(d);
  check_memory("the fit",
               Schwarz<d>::bytes(count, how) + 8.0 * static_cast<double>(count) *
                                                   (2.0 * cycle_iterations + 4.0 * static_cast<double>(values.cols())),
               options_.memory_limit);
  const Schwarz<d> preconditioner(function, points_, positive_order(function.kernel), options_.regularisation, how,
                                  options_.threads, options_.memory_limit);
  const double reciprocal = preconditioner.reciprocal_condition();
  report_.condition = 1 / reciprocal;
  if (reciprocal < smallest_reciprocal)
    refuse(reciprocal > 0 ? "parts of the matrix have a condition of about " + text(1 / reciprocal)
                          : std::string("parts of the matrix are not definite to rounding"));
  Cycles<d> cycles(function, points_, frame_, preconditioner, options_);
  coefficients_.weights.setZero(count, values.cols());
  coefficients_.polynomial.setZero(frame_.size(), values.cols());
  left_out_.setZero(count, values.cols());
  report_.residual = 0;
  report_.iterations = 0;
  for (Index k = 0; k < values.cols(); ++k) {
    if (!(largest_[k] > 0)) continue;
    left_out_.col(k) = preconditioner.left_out(values.col(k));
    const Solved found = cycles.solve(values.col(k), options_.accuracy * largest_[k]);
    const double residual = found.residual / largest_[k];
    if (!(residual <= options_.accuracy))
      refuse("after " + std::to_string(found.iterations) + " iterations the equations are met to " + text(residual) +
             " only, FitOptions::accuracy is " + text(options_.accuracy) +
             "; parts of the matrix have a condition of about " + text(1 / reciprocal));
    report_.residual = std::max(report_.residual, residual);
    report_.iterations += found.iterations;
    coefficients_.weights.col(k) = found.coefficients.weights;
    coefficients_.polynomial.col(k) = found.coefficients.polynomial;
  }
}

template <int d>
Options Fitted<d>::evaluation(double range, int derivative_order, std::size_t expected_targets) const {
  Options plan{.derivative_order = derivative_order,
               .threads = options_.threads,
               .memory_limit = options_.memory_limit,
               .range = range,
               .expected_targets = expected_targets};
  const double distance = range > 0 ? range : (points_.rowwise().maxCoeff() - points_.rowwise().minCoeff()).norm();
  const double largest = largest_value(report_.function, distance);
  double tolerance = 0.5;
  for (Index k = 0; k < largest_.size(); ++k)
    if (largest_[k] > 0)
      tolerance = std::min(tolerance,
                           options_.accuracy * largest_[k] / (largest * coefficients_.weights.col(k).cwiseAbs().sum()));
  plan.tolerance = std::max(tolerance, smallest_tolerance);
  return plan;
}

template <int d>
void Fitted<d>::add_polynomial(const Points<d>& targets, const std::vector<Combination<d>>& combinations,
                               Eigen::MatrixXd& values) const {
  if (frame_.size() == 0) return;
  const Index columns = coefficients_.polynomial.cols();
  const Eigen::MatrixXd polynomials = frame_.values(targets);
  for (std::size_t q = 0; q < combinations.size(); ++q) {
    auto block = values.middleCols(static_cast<Index>(q) * columns, columns);
    for (const fgtd::Term<d>& term : combinations[q]) {
      const int order = order_of<d>(term.derivative);
      if (order == 0) block += term.coefficient * polynomials * coefficients_.polynomial;
      if (order != 1 || frame_.size() == 1) continue;
      const Index axis = std::find(term.derivative.begin(), term.derivative.end(), 1) - term.derivative.begin();
      block.rowwise() += term.coefficient / frame_.unit() * coefficients_.polynomial.row(1 + axis);
    }
  }
}

template class Fitted<1>;
template class Fitted<2>;
template class Fitted<3>;

}  // namespace rbf::detail
