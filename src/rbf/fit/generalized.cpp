// Dense systems of functionals: values, slopes, vectors. The matrix has functional i applied to the kernel that belongs to
// functional j; it is definite like the kernel's own.
#include "rbf/generalized.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "base/parallel.hpp"
#include "rbf/catalogue.hpp"
#include "rbf/check.hpp"
#include "rbf/fit/check_fit.hpp"
#include "rbf/fit/dense_system.hpp"
#include "rbf/fit/kernel_matrix.hpp"
#include "rbf/fit/shape.hpp"

namespace rbf {
namespace detail {
namespace {

using Index = Eigen::Index;

/// phi and its derivatives up to the second order at y - x.
template <int d>
struct Local {
  double value;
  Eigen::Matrix<double, d, 1> gradient;
  Eigen::Matrix<double, d, d> hessian;
  Local(const Function& function, const Eigen::Matrix<double, d, 1>& apart) {
    const Profile at = entry_of(function.kernel).profile(static_cast<long double>(apart.squaredNorm()), function.shape);
    const double slope = static_cast<double>(at.slope), curvature = static_cast<double>(at.curvature);
    value = static_cast<double>(at.value);
    gradient = 2 * slope * apart;
    hessian = 4 * curvature * apart * apart.transpose();
    hessian.diagonal().array() += 2 * slope;
  }
};

/// The error of what is left out is found from so many groups, evenly spread over all.
constexpr std::size_t most_left_out = 500;

/// What is to be fitted: the matrix for a kernel, the numbers, and which of them are left out together.
struct Problem {
  std::function<Eigen::MatrixXd(const Function&)> matrix;
  Eigen::VectorXd numbers;
  Eigen::MatrixXd polynomials;               // as rows for the numbers
  std::vector<std::vector<Index>> left_out;  // groups
};

struct Solved {
  Coefficients coefficients;
  double reciprocal = 0, residual = 0;
  Eigen::VectorXd left_out_errors;  // of the groups: lengths; NaN where a group was not left out
  double left_out = 0;              // their root mean square
  double minus_likelihood = 0;      // minus ln likelihood of the numbers
};

Solved solve(const Problem& problem, const Function& function, const FitOptions& options, double smallest) {
  const double sign = sign_of(function.kernel);
  const Eigen::MatrixXd matrix = problem.matrix(function);
  Solved found;
  const DenseSystem system(sign * matrix, problem.polynomials, sign, options.regularisation);
  found.reciprocal = system.reciprocal_condition();
  if (found.reciprocal < smallest) return found;
  const auto left = [&]() -> Eigen::VectorXd {
    return problem.numbers - matrix * found.coefficients.weights - problem.polynomials * found.coefficients.polynomial -
           sign * options.regularisation * found.coefficients.weights;
  };
  found.coefficients = system.solve(problem.numbers);
  if (problem.numbers.squaredNorm() > 0)
    found.minus_likelihood = -system.gaussian(problem.numbers, found.coefficients).log_likelihood(0);
  const Coefficients more = system.solve(left());
  found.coefficients.weights += more.weights;
  found.coefficients.polynomial += more.polynomial;
  const double largest = problem.numbers.cwiseAbs().maxCoeff();
  found.residual = largest > 0 ? left().cwiseAbs().maxCoeff() / largest : 0;
  // Without a group g the others predict it with the error G_gg^-1 (weights)_g: changing its numbers by that makes its
  // weights 0.
  // Rows of G for several groups at a time: a product of matrices is quicker than as many of vectors.
  const std::size_t groups = problem.left_out.size(), looked_at = std::min(groups, most_left_out);
  constexpr std::size_t at_a_time = 64;
  double squares = 0;
  found.left_out_errors.setConstant(static_cast<Index>(groups), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t first = 0; first < looked_at; first += at_a_time) {
    const std::size_t last = std::min(looked_at, first + at_a_time);
    std::vector<Index> indices;
    for (std::size_t g = first; g < last; ++g)
      for (const Index k : problem.left_out[g * groups / looked_at]) indices.push_back(k);
    const Eigen::MatrixXd rows = system.weight_rows(indices);
    Index begun = 0;
    for (std::size_t g = first; g < last; ++g) {
      const std::vector<Index>& group = problem.left_out[g * groups / looked_at];
      const auto size = static_cast<Index>(group.size());
      const Eigen::MatrixXd own = rows.middleRows(begun, size)(Eigen::all, group);
      const Eigen::VectorXd weights = found.coefficients.weights.col(0)(group);
      const double squared = (sign * own).ldlt().solve(sign * weights).squaredNorm();
      squares += squared;
      found.left_out_errors[static_cast<Index>(g * groups / looked_at)] = std::sqrt(squared);
      begun += size;
    }
  }
  found.left_out = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, looked_at)));
  return found;
}

/// The solution; fills the report. Tries shapes where none is given, and takes the best one.
template <int d>
Solved fit(const Problem& problem, const Points<d>& points, const FitOptions& options, FitReport& report) {
  constexpr double comfortable = 1e-13, smallest = 100 * std::numeric_limits<double>::epsilon();
  const auto begun = std::chrono::steady_clock::now();
  report.solver = Solver::dense;
  report.spacing = typical_spacing<d>(points);
  report.shape_was_chosen = report.function.shape == 0;
  Solved best;
  if (!report.shape_was_chosen) {
    best = solve(problem, report.function, options, smallest);
  } else {
    const double extent = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
    double shape = report.spacing > 0 ? report.spacing : extent > 0 ? extent : 1;
    for (Function function = report.function; best.reciprocal == 0 || shape <= 2 * extent; shape *= std::sqrt(2.0)) {
      function.shape = shape;
      const Solved tried = solve(problem, function, options, best.reciprocal == 0 ? smallest : comfortable);
      if (tried.coefficients.weights.size() == 0) break;
      const bool is_better = options.shape_by == ShapeBy::likelihood ? tried.minus_likelihood < best.minus_likelihood
                                                                     : tried.left_out < best.left_out;
      if (best.reciprocal == 0 || is_better) {
        best = tried;
        report.function = function;
      }
    }
    if (best.reciprocal == 0) report.function.shape = shape;
  }
  report.condition = 1 / best.reciprocal;
  report.residual = best.residual;
  if (best.coefficients.weights.size() == 0)
    refuse_condition<d>(report, points, options,
                        best.reciprocal > 0 ? "the matrix has a condition of about " + text(1 / best.reciprocal)
                                            : std::string("the matrix is not definite to rounding"),
                        "Remove");
  if (!(best.residual <= options.accuracy))
    refuse_condition<d>(report, points, options, "the equations are met to " + text(best.residual) + " only", "Remove");
  report.left_out = {best.left_out};
  if (problem.numbers.squaredNorm() > 0) report.log_likelihood = {-best.minus_likelihood};
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return best;
}

void check_kernel(const Function& function, const char* what) {
  if (highest_derivative(function.kernel) < 2)
    throw InvalidArgument("rbf: " + to_string(function.kernel) + " has no second derivatives at distance 0, which " +
                          what + " needs; take multiquadric or a Matern kernel");
  if (function.shape != 0) check_function(function);
}

void check_size(Index numbers, const FitOptions& options) {
  if (numbers > most_generalized)
    throw InvalidArgument("rbf: a dense fit to " + std::to_string(numbers) + " numbers was asked for, at most " +
                          std::to_string(most_generalized) + " are possible; fit fewer points");
  const double size = static_cast<double>(numbers);
  check_memory("a dense fit", 32 * size * size, options.memory_limit);
}

}  // namespace

template <int d>
struct FittedHermite {
  Points<d> points, slope_points;
  Eigen::VectorXd values;  // weights a
  Eigen::MatrixXd slopes;  // weights b
  double constant = 0;
  FitReport report;
  int threads = 0;
};

template <int d>
struct FittedDivergenceFree {
  Points<d> points;
  Eigen::MatrixXd weights;
  Eigen::VectorXd left_out_errors;
  FitReport report;
  int threads = 0;
};

}  // namespace detail

using Index = Eigen::Index;

template <int d>
HermiteInterpolant<d>::HermiteInterpolant(const Function& function, const Eigen::Ref<const Points<d>>& points,
                                          const Eigen::Ref<const Eigen::VectorXd>& values,
                                          const Eigen::Ref<const Points<d>>& slope_points,
                                          const Eigen::Ref<const Eigen::MatrixXd>& gradients,
                                          const FitOptions& options) {
  detail::check_fit_options(options);
  detail::check_kernel(function, "interpolation of gradients");
  auto fitted = std::make_shared<detail::FittedHermite<d>>();
  fitted->points = points;
  fitted->slope_points = slope_points;
  fitted->threads = options.threads;
  const Points<d>&x = fitted->points, &z = fitted->slope_points;
  detail::check_data<d>("point", x, "values", values, options);
  detail::check_data<d>("slope point", z, "gradients", gradients, options);
  if (gradients.cols() != d && z.cols() > 0)
    throw InvalidArgument("rbf: gradients have " + std::to_string(gradients.cols()) + " columns, must have " +
                          std::to_string(d));
  const Index n = x.cols(), m = z.cols(), order = positive_order(function.kernel);
  if (n + m == 0 || (order > 0 && n == 0))
    throw InvalidArgument(
        "rbf: there are no values to fit a function to" +
        std::string(n + m > 0 ? ", which determine the constant of " + to_string(function.kernel) : ""));
  detail::check_size(n + d * m, options);
  Points<d> all(d, n + m);
  all << x, z;

  // Slopes are in units of a value over a length: with the spacing for that length, all numbers have one unit.
  const double unit = detail::unit_length<d>(all);
  detail::Problem problem;
  problem.matrix = [&](const Function& of) {
    Eigen::MatrixXd matrix(n + d * m, n + d * m);
    for (Index j = 0; j < n + m; ++j)
      for (Index i = j; i < n + m; ++i) {
        const detail::Local<d> at(of, all.col(i) - all.col(j));
        if (i < n) {
          matrix(i, j) = matrix(j, i) = at.value;
          continue;
        }
        for (Index l = 0; l < d; ++l) {
          const Index row = n + l * m + i - n;
          if (j < n) {
            matrix(row, j) = matrix(j, row) = unit * at.gradient[l];
            continue;
          }
          for (Index k = 0; k < d; ++k) {
            const Index column = n + k * m + j - n;
            matrix(row, column) = matrix(column, row) = -unit * unit * at.hessian(l, k);
          }
        }
      }
    return matrix;
  };
  problem.numbers.resize(n + d * m);
  problem.numbers.head(n) = values;
  for (Index l = 0; l < d && m > 0; ++l) problem.numbers.segment(n + l * m, m) = unit * gradients.col(l);
  problem.polynomials = Eigen::MatrixXd::Zero(n + d * m, order);
  problem.polynomials.topRows(n).setOnes();
  for (Index i = 0; i < n; ++i) problem.left_out.push_back({i});
  fitted->report.function = function;
  fitted->report.points = static_cast<std::size_t>(n + m);
  const detail::Coefficients found = detail::fit<d>(problem, all, options, fitted->report).coefficients;
  fitted->report.values = {n > 0 ? values.norm() / std::sqrt(static_cast<double>(n)) : 0};
  fitted->values = found.weights.col(0).head(n);
  fitted->slopes = unit * found.weights.col(0).tail(d * m).reshaped(m, d);
  if (order > 0) fitted->constant = found.polynomial(0, 0);
  fitted_ = std::move(fitted);
}

template <int d>
Eigen::VectorXd HermiteInterpolant<d>::evaluate(const Eigen::Ref<const Points<d>>& targets,
                                                const Derivative<d>& alpha) const {
  const int order = std::accumulate(alpha.begin(), alpha.end(), 0);
  if (order > 1 || *std::min_element(alpha.begin(), alpha.end()) < 0)
    throw InvalidArgument("rbf: a derivative of order " + std::to_string(order) +
                          " of an interpolant of gradients was asked for, at most 1 is possible");
  const Points<d> packed = targets;
  const auto plan = [&](const Points<d>& centres, const Eigen::MatrixXd& weights, int derivatives) {
    return Plan<d>(fitted_->report.function, centres, weights,
                   {.derivative_order = derivatives,
                    .method = Method::direct,
                    .threads = fitted_->threads,
                    .range = range_of<d>(centres, packed)});
  };
  Eigen::VectorXd found = Eigen::VectorXd::Constant(targets.cols(), order == 0 ? fitted_->constant : 0);
  if (fitted_->points.cols() > 0)
    found += plan(fitted_->points, fitted_->values, order).evaluate(targets, alpha).col(0);
  if (fitted_->slope_points.cols() == 0) return found;
  const Plan<d> slopes = plan(fitted_->slope_points, fitted_->slopes, order + 1);
  std::vector<Combination<d>> along;
  for (std::size_t l = 0; l < d; ++l) {
    Derivative<d> beta = alpha;
    ++beta[l];
    along.push_back({{beta, 1.0}});
  }
  const Eigen::MatrixXd all = slopes.evaluate_combinations(targets, along);
  for (Index l = 0; l < d; ++l) found -= all.col(l * d + l);
  return found;
}

template <int d>
const FitReport& HermiteInterpolant<d>::report() const {
  return fitted_->report;
}

template <int d>
DivergenceFreeInterpolant<d>::DivergenceFreeInterpolant(const Function& function,
                                                        const Eigen::Ref<const Points<d>>& points,
                                                        const Eigen::Ref<const Eigen::MatrixXd>& vectors,
                                                        const FitOptions& options) {
  detail::check_fit_options(options);
  detail::check_kernel(function, "a field without divergence");
  auto fitted = std::make_shared<detail::FittedDivergenceFree<d>>();
  fitted->points = points;
  fitted->threads = options.threads;
  const Points<d>& x = fitted->points;
  if (x.cols() == 0) throw InvalidArgument("rbf: there are no points to fit a field to");
  detail::check_data<d>("point", x, "vectors", vectors, options);
  if (vectors.cols() != d)
    throw InvalidArgument("rbf: vectors have " + std::to_string(vectors.cols()) + " components, must have " +
                          std::to_string(d));
  const Index n = x.cols();
  detail::check_size(d * n, options);
  detail::Problem problem;
  problem.matrix = [&](const Function& of) {
    Eigen::MatrixXd matrix(d * n, d * n);
    for (Index j = 0; j < n; ++j)
      for (Index i = j; i < n; ++i) {
        const detail::Local<d> at(of, x.col(i) - x.col(j));
        const double trace = at.hessian.trace();
        for (Index l = 0; l < d; ++l)
          for (Index k = 0; k < d; ++k)
            matrix(l * n + i, k * n + j) = matrix(k * n + j, l * n + i) = at.hessian(l, k) - (l == k ? trace : 0);
      }
    return matrix;
  };
  problem.numbers = vectors.reshaped();
  problem.polynomials.resize(d * n, 0);
  for (Index i = 0; i < n; ++i) {
    std::vector<Index> group;
    for (Index l = 0; l < d; ++l) group.push_back(l * n + i);
    problem.left_out.push_back(group);
  }
  fitted->report.function = function;
  fitted->report.points = static_cast<std::size_t>(n);
  const detail::Solved found = detail::fit<d>(problem, x, options, fitted->report);
  fitted->report.values = {vectors.norm() / std::sqrt(static_cast<double>(n))};
  fitted->weights = found.coefficients.weights.col(0).reshaped(n, d);
  fitted->left_out_errors = found.left_out_errors;
  fitted_ = std::move(fitted);
}

template <int d>
Eigen::MatrixXd DivergenceFreeInterpolant<d>::evaluate(const Eigen::Ref<const Points<d>>& targets) const {
  const Points<d> packed = targets;
  const Plan<d> plan(fitted_->report.function, fitted_->points, fitted_->weights,
                     {.derivative_order = 2,
                      .method = Method::direct,
                      .threads = fitted_->threads,
                      .range = range_of<d>(fitted_->points, packed)});
  std::vector<Combination<d>> seconds;  // d2/dy_l dy_k, l <= k
  std::vector<std::pair<Index, Index>> places;
  for (Index l = 0; l < d; ++l)
    for (Index k = l; k < d; ++k) {
      Derivative<d> alpha{};
      ++alpha[static_cast<std::size_t>(l)];
      ++alpha[static_cast<std::size_t>(k)];
      seconds.push_back({{alpha, 1.0}});
      places.emplace_back(l, k);
    }
  const Eigen::MatrixXd all = plan.evaluate_combinations(targets, seconds);
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(targets.cols(), d);
  for (std::size_t q = 0; q < places.size(); ++q) {
    const auto [l, k] = places[q];
    const auto of = all.middleCols(static_cast<Index>(q) * d, d);
    if (l != k) {
      found.col(l) += of.col(k);
      found.col(k) += of.col(l);
    } else {
      for (Index other = 0; other < d; ++other)
        if (other != l) found.col(other) -= of.col(other);  // of the Laplacian; its own term cancels
    }
  }
  return found;
}

template <int d>
Eigen::MatrixXd DivergenceFreeInterpolant<d>::gradient(const Eigen::Ref<const Points<d>>& targets) const {
  const Points<d> packed = targets;
  detail::check_points("target", packed.data(), d, static_cast<std::size_t>(packed.cols()), d, fitted_->threads);
  const Function& function = fitted_->report.function;
  const Points<d>& points = fitted_->points;
  const Eigen::MatrixXd& gamma = fitted_->weights;
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(packed.cols(), d * d);
  constexpr double seconds_of_a_pair = 2e-7;
  gaussdrift::base::parallel_for(
      {static_cast<std::size_t>(packed.cols()),
       seconds_of_a_pair * static_cast<double>(packed.cols()) * static_cast<double>(points.cols())},
      fitted_->threads, [&](std::size_t target) {
        const auto i = static_cast<Index>(target);
        for (Index j = 0; j < points.cols(); ++j) {
          const Eigen::Matrix<double, d, 1> x = packed.col(i) - points.col(j);
          const detail::Profile at =
              detail::entry_of(function.kernel).profile(static_cast<long double>(x.squaredNorm()), function.shape);
          // D_klm phi = b (delta_kl x_m + delta_km x_l + delta_lm x_k) + a x_k x_l x_m, and D_m Laplacian phi = e x_m.
          const double a = 8 * static_cast<double>(at.third), b = 4 * static_cast<double>(at.curvature);
          const double e = (d + 2) * b + a * x.squaredNorm(), along = gamma.row(j) * x;
          for (Index l = 0; l < d; ++l)
            for (Index k = 0; k < d; ++k)
              found(i, k + d * l) += b * ((k == l ? along : 0) + gamma(j, l) * x[k] + gamma(j, k) * x[l]) +
                                     a * x[k] * x[l] * along - e * x[l] * gamma(j, k);
        }
      });
  return found;
}

template <int d>
const Eigen::MatrixXd& DivergenceFreeInterpolant<d>::weights() const {
  return fitted_->weights;
}

template <int d>
const Eigen::VectorXd& DivergenceFreeInterpolant<d>::left_out_errors() const {
  return fitted_->left_out_errors;
}

template <int d>
const FitReport& DivergenceFreeInterpolant<d>::report() const {
  return fitted_->report;
}

template class HermiteInterpolant<1>;
template class HermiteInterpolant<2>;
template class HermiteInterpolant<3>;
template class DivergenceFreeInterpolant<2>;
template class DivergenceFreeInterpolant<3>;

}  // namespace rbf
