#include "field/gaussians/divergence_free_fit.hpp"

#include <fmt/format.h>

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "field/gaussians/divergence_free.hpp"
#include "field/gaussians/overlapping_blocks.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

// The system as Eigen's solvers want it: something that multiplies vectors of all unknowns, column after column of
// Gamma.
template <int d>
class GaussianSystem;

}  // namespace

}  // namespace gaussdrift

template <int d>
struct Eigen::internal::traits<gaussdrift::GaussianSystem<d>> : Eigen::internal::traits<Eigen::SparseMatrix<double>> {};

namespace gaussdrift {

namespace {

template <int d>
class GaussianSystem : public Eigen::EigenBase<GaussianSystem<d>> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic, IsRowMajor = false };

  // Products are as accurate as can be: conjugate gradients need a matrix that is symmetric and definite to rounding.
  static constexpr double product_tolerance = 1e-13;

  GaussianSystem(GaussianMatrix matrix, const fgtd::Points<d>& points, double sigma, const GaussianFitOptions& options)
      : matrix_(matrix),
        points_(points),
        columns_(gaussian_columns(matrix, d)),
        shift_(options.regularisation * diagonal(matrix, sigma)),
        sum_(points, Eigen::MatrixXd::Zero(points.cols(), columns_), sigma,
             {.tolerance = product_tolerance, .derivative_order = 2, .threads = options.threads}) {}

  Eigen::Index rows() const { return points_.cols() * columns_; }
  Eigen::Index cols() const { return rows(); }
  template <class Right>
  Eigen::Product<GaussianSystem, Right, Eigen::AliasFreeProduct> operator*(const Eigen::MatrixBase<Right>& x) const {
    return {*this, x.derived()};
  }

  /// A Gamma, without the shift.
  Eigen::MatrixXd field(const Eigen::MatrixXd& coefficients) const {
    sum_.set_coefficients(coefficients);
    return sum_.evaluate(matrix_, points_);
  }
  Eigen::VectorXd product(const Eigen::VectorXd& x) const {
    return field(x.reshaped(points_.cols(), columns_)).reshaped() + shift_ * x;
  }
  double shift() const { return shift_; }

  /// The diagonal of A, every entry: Phi(0) = 2 sigma (d - 1) I; -Laplacian phi(0) = 4 sigma in two dimensions.
  static double diagonal(GaussianMatrix matrix, double sigma) {
    return matrix == GaussianMatrix::field ? 2 * sigma * (d - 1) : 4 * sigma;
  }

 private:
  GaussianMatrix matrix_;
  const fgtd::Points<d>& points_;
  Eigen::Index columns_;
  double shift_;
  mutable GaussianSum<d> sum_;  // its coefficients are the argument of the product
};

}  // namespace

}  // namespace gaussdrift

template <int d, class Right>
struct Eigen::internal::generic_product_impl<gaussdrift::GaussianSystem<d>, Right, Eigen::SparseShape,
                                             Eigen::DenseShape, Eigen::GemvProduct>
    : Eigen::internal::generic_product_impl_base<
          gaussdrift::GaussianSystem<d>, Right,
          Eigen::internal::generic_product_impl<gaussdrift::GaussianSystem<d>, Right>> {
  using Scalar = double;
  template <class Destination>
  static void scaleAndAddTo(Destination& to, const gaussdrift::GaussianSystem<d>& system, const Right& x,
                            const double& factor) {
    to += factor * system.product(x);
  }
};

namespace gaussdrift {

namespace {

using Index = Eigen::Index;

template <int d>
std::string place(const fgtd::Points<d>& points, Index k) {
  std::string text = "(";
  for (int l = 0; l < d; ++l) text += fmt::format("{}{:.10g}", l ? ", " : "", points(l, k));
  return text + ")";
}

template <int d>
void check_distinct(const fgtd::Points<d>& points, const Eigen::MatrixXd& samples) {
  std::vector<Index> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  const auto coordinates = [&](Index k) {
    std::array<double, d> x;
    for (int l = 0; l < d; ++l) x[static_cast<std::size_t>(l)] = points(l, k);
    return x;
  };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const auto xa = coordinates(a), xb = coordinates(b);
    return xa != xb ? xa < xb : a < b;
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Index a = order[i - 1], b = order[i];
    if (coordinates(a) != coordinates(b)) continue;
    throw InputError(fmt::format("samples {} and {} are both at {}{}; no field can be fitted to that: remove one",
                                 a + 1, b + 1, place<d>(points, a),
                                 samples.row(a) == samples.row(b) ? "" : " but have different values"));
  }
}

template <int d>
double spacing_of(const fgtd::Points<d>& points) {
  const Eigen::VectorXd extent = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
  return std::pow(extent.prod() / static_cast<double>(points.cols()), 1.0 / d);
}

template <int d>
[[noreturn]] void refuse(const fgtd::Points<d>& points, double sigma, const GaussianFitOptions& options,
                         const std::string& what) {
  throw GaussiansTooWide(fmt::format(
      "{}: Gaussians of width {:.4g} can hardly be told apart at samples that lie {:.2g} apart on average{}. Lower "
      "width, remove samples that lie very close together, or {} regularisation (begin with 1e-8).",
      what, 1 / std::sqrt(sigma), spacing_of<d>(points),
      options.regularisation > 0 ? fmt::format(", with regularisation = {}", options.regularisation) : "",
      options.regularisation > 0 ? "raise" : "set"));
}

// As Eigen's solvers want it.
template <int d>
class Preconditioner {
 public:
  void set(const OverlappingBlocks<d>& blocks) { blocks_ = &blocks; }
  Eigen::VectorXd solve(const Eigen::VectorXd& x) const { return blocks_->solve(x); }
  template <class Matrix>
  Preconditioner& compute(const Matrix&) {
    return *this;
  }
  Eigen::ComputationInfo info() const { return Eigen::Success; }

 private:
  const OverlappingBlocks<d>* blocks_ = nullptr;
};

void check_options(const GaussianFitOptions& options) {
  if (!(options.residual > 0 && options.residual < 1))
    throw InputError(fmt::format("residual = {}, must lie in (0, 1)", options.residual));
  if (!(options.regularisation >= 0 && std::isfinite(options.regularisation)))
    throw InputError(fmt::format("regularisation = {}, must be 0 or more", options.regularisation));
}

/// The solution, by the blocks alone if they are all of the system; names the solver in `fit`.
template <int d>
Eigen::VectorXd solve(const GaussianSystem<d>& system, const OverlappingBlocks<d>& blocks, const Eigen::VectorXd& right,
                      const GaussianFitOptions& options, GaussianFit& fit) {
  if (blocks.is_exact()) {
    fit.solver = "cholesky";
    return blocks.solve(right);
  }
  fit.solver = "conjugate gradients";
  Eigen::ConjugateGradient<GaussianSystem<d>, Eigen::Lower | Eigen::Upper, Preconditioner<d>> solver;
  solver.preconditioner().set(blocks);
  solver.setMaxIterations(options.most_iterations);
  solver.setTolerance(options.residual);
  solver.compute(system);
  const Eigen::VectorXd gamma = solver.solve(right);
  fit.iterations = static_cast<int>(solver.iterations());
  return gamma;
}

/// The root mean square of those that are no NaN.
double size_of_known(const Eigen::VectorXd& errors) {
  double squares = 0, known = 0;
  for (const double error : errors) {
    if (std::isnan(error)) continue;
    squares += error * error;
    ++known;
  }
  return std::sqrt(squares / known);
}

}  // namespace

template <int d>
GaussianFit fit_gaussians(GaussianMatrix matrix, const fgtd::Points<d>& points, const Eigen::MatrixXd& samples,
                          double sigma, const GaussianFitOptions& options) {
  check_options(options);
  if (points.cols() == 0) throw InputError("there are no samples to fit a field to");
  check_distinct<d>(points, samples);

  const Index count = points.cols(), columns = gaussian_columns(matrix, d);
  const GaussianSystem<d> system(matrix, points, sigma, options);
  const Eigen::VectorXd right = samples.reshaped();
  const double size = right.norm();
  GaussianFit fit;
  fit.coefficients = Eigen::MatrixXd::Zero(count, columns);
  if (size == 0) {
    fit.solver = "none: all samples are 0";
    return fit;
  }

  const OverlappingBlocks<d> blocks(matrix, points, sigma, system.shift(), options.threads);
  // A solution exists for every condition, but beyond this its digits mean nothing.
  constexpr double smallest_reciprocal_condition = 100 * std::numeric_limits<double>::epsilon();
  if (const double rcond = blocks.reciprocal_condition(); rcond < smallest_reciprocal_condition)
    refuse<d>(points, sigma, options,
              rcond > 0 ? fmt::format("the matrix has a condition of {:.0e} or more", 1 / rcond)
                        : "the matrix is not definite to rounding");

  const Eigen::VectorXd gamma = solve<d>(system, blocks, right, options, fit);
  fit.coefficients = gamma.reshaped(count, columns);
  const Eigen::MatrixXd field = system.field(fit.coefficients);
  fit.residual = (right - field.reshaped() - system.shift() * gamma).norm() / size;
  fit.misfit = (samples - field).cwiseAbs().maxCoeff() / samples.cwiseAbs().maxCoeff();
  // The solver's own residual is updated, not recomputed, and may be a little off.
  if (!(fit.residual <= 1.1 * options.residual))
    refuse<d>(points, sigma, options,
              fit.iterations > 0
                  ? fmt::format("conjugate gradients reached a residual of {:.1e} after {} iterations, not {:.1e}",
                                fit.residual, fit.iterations, options.residual)
                  : fmt::format("the residual is {:.1e}, not {:.1e}", fit.residual, options.residual));
  fit.left_out_errors = blocks.left_out_errors(right);
  fit.left_out = size_of_known(fit.left_out_errors) / (right.norm() / std::sqrt(static_cast<double>(count)));
  constexpr double knowing_nothing = 0.9;  // 1 is the error of a field that is 0 everywhere
  if (!(fit.left_out < knowing_nothing))
    throw InputError(
        fmt::format("the samples do not follow from each other. When each is predicted from the others, the error is "
                    "{:.2g} of their size. Gaussians of width {:.4g} do not bridge samples that lie {:.2g} apart on "
                    "average. Raise width, or add samples.",
                    fit.left_out, 1 / std::sqrt(sigma), spacing_of<d>(points)));
  return fit;
}

template GaussianFit fit_gaussians<2>(GaussianMatrix, const fgtd::Points<2>&, const Eigen::MatrixXd&, double,
                                      const GaussianFitOptions&);
template GaussianFit fit_gaussians<3>(GaussianMatrix, const fgtd::Points<3>&, const Eigen::MatrixXd&, double,
                                      const GaussianFitOptions&);

}  // namespace gaussdrift
