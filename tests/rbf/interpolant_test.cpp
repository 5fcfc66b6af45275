// Does an interpolant take its values, equal the exact solution, converge, and tell how good it is?
#include "rbf/interpolant.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <string>

#include "rbf/naive.hpp"

namespace {

using Index = Eigen::Index;

using naive::cube;

/// Halton's points, which leave no large gaps as random ones do.
template <int d>
rbf::Points<d> even(Index count) {
  constexpr int bases[] = {2, 3, 5};
  rbf::Points<d> points = rbf::Points<d>::Zero(d, count);
  for (Index i = 0; i < count; ++i)
    for (int l = 0; l < d; ++l) {
      double digit = 1;
      for (Index n = i + 1; n > 0; n /= bases[l])
        points(l, i) += static_cast<double>(n % bases[l]) * (digit /= bases[l]);
    }
  return points;
}

/// A smooth function, different for each column.
template <int d>
Eigen::MatrixXd smooth(const rbf::Points<d>& x, Index columns = 1) {
  Eigen::MatrixXd values(x.cols(), columns);
  for (Index k = 0; k < columns; ++k)
    for (Index i = 0; i < x.cols(); ++i)
      values(i, k) = std::sin(3 * x(0, i) + static_cast<double>(k)) * std::cos(2 * x(d - 1, i)) + x.col(i).sum();
  return values;
}

/// Franke's function on the unit square.
Eigen::VectorXd franke(const rbf::Points<2>& points) {
  Eigen::VectorXd values(points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    const double x = 9 * points(0, i), y = 9 * points(1, i);
    const auto bump = [&](double a, double b, double at_x, double at_y) {
      return std::exp(-(x - at_x) * (x - at_x) / a - (y - at_y) * (y - at_y) / b);
    };
    values[i] = 0.75 * bump(4, 4, 2, 2) + 0.75 * std::exp(-(x + 1) * (x + 1) / 49 - (y + 1) / 10) +
                0.5 * bump(4, 4, 7, 3) - 0.2 * bump(1, 1, 4, 7);
  }
  return values;
}

rbf::Function function_of(rbf::Kernel kernel, double shape) { return {kernel, rbf::takes_shape(kernel) ? shape : 0}; }

/// 1, y_1, .. y_d as far as the kernel has them.
template <int d>
Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> polynomials(int order, const rbf::Points<d>& x) {
  Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> values(x.cols(), order == 0 ? 0 : order == 1 ? 1 : 1 + d);
  if (order >= 1) values.col(0).setOnes();
  if (order >= 2) values.rightCols(d) = x.transpose().template cast<long double>();
  return values;
}

/// The interpolant at targets by the definition: one system of weights and polynomial in long double.
template <int d>
Eigen::MatrixXd exact(const rbf::Function& function, const rbf::Points<d>& x, const Eigen::MatrixXd& values,
                      const rbf::Points<d>& targets, double regularisation = 0) {
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const auto matrix = [&](const rbf::Points<d>& y) {
    Matrix phi(y.cols(), x.cols());
    for (Index j = 0; j < x.cols(); ++j)
      for (Index i = 0; i < y.cols(); ++i) {
        long double squared = 0;
        for (int l = 0; l < d; ++l) {
          const long double apart = static_cast<long double>(y(l, i)) - x(l, j);
          squared += apart * apart;
        }
        phi(i, j) = naive::phi(function, std::sqrt(squared));
      }
    return phi;
  };
  const int order = rbf::positive_order(function.kernel);
  const Matrix p = polynomials<d>(order, x);
  Matrix system = Matrix::Zero(x.cols() + p.cols(), x.cols() + p.cols());
  system.topLeftCorner(x.cols(), x.cols()) = matrix(x);
  system.topLeftCorner(x.cols(), x.cols()).diagonal().array() +=
      function.kernel == rbf::Kernel::multiquadric ? -regularisation : regularisation;
  system.topRightCorner(x.cols(), p.cols()) = p;
  system.bottomLeftCorner(p.cols(), x.cols()) = p.transpose();
  Matrix right = Matrix::Zero(system.rows(), values.cols());
  right.topRows(x.cols()) = values.cast<long double>();
  const Matrix solved = system.fullPivLu().solve(right);
  return (matrix(targets) * solved.topRows(x.cols()) + polynomials<d>(order, targets) * solved.bottomRows(p.cols()))
      .template cast<double>();
}

class EveryInterpolant : public testing::TestWithParam<rbf::Kernel> {};

template <int d>
void equals_the_exact_solution(rbf::Kernel kernel) {
  const rbf::Function function = function_of(kernel, 0.25);
  const rbf::Points<d> points = cube<d>(70, 1), targets = 1.5 * cube<d>(40, 2);  // some outside
  const Eigen::MatrixXd values = smooth<d>(points, 2);
  const rbf::Interpolant<d> fit(function, points, values, {.accuracy = 1e-9});
  EXPECT_LE((fit.evaluate(points) - values).cwiseAbs().maxCoeff(), 2e-9 * values.cwiseAbs().maxCoeff());
  // The condition times rounding, of some thousand operations, for the largest value at the targets.
  const Eigen::MatrixXd wanted = exact<d>(function, points, values, targets);
  const double rounding = 1e-15 * fit.report().condition;
  EXPECT_LE((fit.evaluate(targets) - wanted).cwiseAbs().maxCoeff(),
            (2e-9 + rounding) * (1 + wanted.cwiseAbs().maxCoeff()))
      << fit.report();
  EXPECT_EQ(fit.report().solver, rbf::Solver::dense);
  EXPECT_LE(fit.report().residual, 1e-9);
}

TEST_P(EveryInterpolant, EqualsTheExactSolution) {
  equals_the_exact_solution<1>(GetParam() == rbf::Kernel::thin_plate ? GetParam() : rbf::Kernel::matern32);
  equals_the_exact_solution<2>(GetParam());
  equals_the_exact_solution<3>(GetParam());
}

TEST_P(EveryInterpolant, TakesTheValuesWithAChosenShape) {
  const rbf::Points<2> points = cube<2>(200, 3);
  const Eigen::MatrixXd values = smooth<2>(points);
  const rbf::Interpolant<2> fit({GetParam()}, points, values);
  EXPECT_LE((fit.evaluate(points) - values).cwiseAbs().maxCoeff(), 2e-7 * values.cwiseAbs().maxCoeff());
  EXPECT_EQ(fit.report().shape_was_chosen, rbf::takes_shape(GetParam()));
  EXPECT_EQ(fit.report().function.shape > 0, rbf::takes_shape(GetParam()));
  EXPECT_LE(fit.report().left_out[0], 0.02 * fit.report().values[0]) << fit.report();
}

TEST_P(EveryInterpolant, PredictsLeftOutValues) {
  const Index count = 30;
  const rbf::Function function = function_of(GetParam(), 0.2);
  const rbf::Points<2> points = cube<2>(count, 5);
  const Eigen::MatrixXd values = smooth<2>(points, 2);
  const rbf::Interpolant<2> fit(function, points, values);
  for (Index out = 0; out < count; ++out) {  // by fits to the others, one by one
    rbf::Points<2> others(2, count - 1);
    Eigen::MatrixXd known(count - 1, 2);
    for (Index k = 0; k + 1 < count; ++k) {
      others.col(k) = points.col(k < out ? k : k + 1);
      known.row(k) = values.row(k < out ? k : k + 1);
    }
    const Eigen::RowVector2d wrong = values.row(out) - exact<2>(function, others, known, points.col(out));
    EXPECT_LE((fit.left_out_errors().row(out) - wrong).cwiseAbs().maxCoeff(), 1e-8);
  }
  const Eigen::MatrixXd folds = rbf::cross_validation_errors<2>(function, points, values, count);
  EXPECT_LE((folds + fit.left_out_errors()).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(fit.report().left_out[1], fit.left_out_errors().col(1).norm() / std::sqrt(30.0), 1e-14);
}

// The likelihood written out: with S = [A P; P^T 0], |det S| = det B det(P^T P), and f^T lambda from S.
TEST_P(EveryInterpolant, TellsTheLikelihoodOfTheValues) {
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Index count = 25;
  const rbf::Function function = function_of(GetParam(), 0.2);
  const rbf::Points<2> points = cube<2>(count, 5);
  const Eigen::MatrixXd values = smooth<2>(points, 2);
  for (const double ridge : {0.0, 0.01}) {
    const Matrix p = polynomials<2>(rbf::positive_order(GetParam()), points);
    Matrix system = Matrix::Zero(count + p.cols(), count + p.cols()), right = Matrix::Zero(system.rows(), 2);
    for (Index i = 0; i < count; ++i)
      for (Index j = 0; j < count; ++j)
        system(i, j) = naive::phi(
            function,
            std::sqrt(static_cast<long double>((points.col(i) - points.col(j)).cast<long double>().squaredNorm())));
    system.topLeftCorner(count, count).diagonal().array() += GetParam() == rbf::Kernel::multiquadric ? -ridge : ridge;
    system.topRightCorner(count, p.cols()) = p;
    system.bottomLeftCorner(p.cols(), count) = p.transpose();
    right.topRows(count) = values.cast<long double>();
    const Eigen::PartialPivLU<Matrix> factors(system);
    const Matrix weights = factors.solve(right).topRows(count), squares = p.transpose() * p;
    const long double m = static_cast<long double>(count - p.cols());
    long double log_determinant = factors.matrixLU().diagonal().array().abs().log().sum();
    if (p.cols() > 0) log_determinant -= std::log(squares.determinant());
    const rbf::Interpolant<2> fit(function, points, values, {.regularisation = ridge});
    ASSERT_EQ(fit.report().log_likelihood.size(), 2U);
    for (Index k = 0; k < 2; ++k) {
      const long double energy = std::abs(right.col(k).head(count).dot(weights.col(k))),
                        wanted = -(m * (std::log(2 * std::acos(-1.0L) * energy / m) + 1) + log_determinant) / 2;
      // the condition times rounding
      EXPECT_NEAR(fit.report().log_likelihood[static_cast<std::size_t>(k)], static_cast<double>(wanted),
                  1e-9 + 1e-14 * fit.report().condition)
          << ridge;
    }
  }
}

TEST_P(EveryInterpolant, HasTheMostLikelyShapeIfAsked) {
  if (!rbf::takes_shape(GetParam())) return;
  const rbf::Points<2> points = cube<2>(120, 3);
  const Eigen::MatrixXd values = smooth<2>(points) + 0.01 * naive::numbers(120, 1, 4);
  const rbf::FitOptions options{.regularisation = 1e-4, .shape_by = rbf::ShapeBy::likelihood};
  const rbf::Interpolant<2> fit({GetParam()}, points, values, options);
  const double shape = fit.report().function.shape;
  EXPECT_TRUE(fit.report().shape_was_chosen);
  for (const double other : {shape / std::sqrt(2.0), shape * std::sqrt(2.0)}) {
    if (other < fit.report().spacing / 2 || other > 2) continue;  // not tried
    const rbf::Interpolant<2> beside({GetParam(), other}, points, values, options);
    EXPECT_GE(fit.report().log_likelihood[0], beside.report().log_likelihood[0]) << shape << " " << other;
  }
}

TEST_P(EveryInterpolant, SmoothsWithRegularisation) {
  const rbf::Function function = function_of(GetParam(), 0.2);
  rbf::Points<2> points = cube<2>(50, 6);
  points.col(7) = points.col(30);  // allowed then
  const Eigen::MatrixXd values = smooth<2>(points) + 0.1 * naive::numbers(50, 1, 7);
  const rbf::Interpolant<2> fit(function, points, values, {.regularisation = 0.01});
  const rbf::Points<2> targets = cube<2>(20, 8);
  EXPECT_LE((fit.evaluate(targets) - exact<2>(function, points, values, targets, 0.01)).cwiseAbs().maxCoeff(), 1e-6);
  const Eigen::VectorXd weights = fit.weights().col(0);
  const double sign = GetParam() == rbf::Kernel::multiquadric ? -1 : 1;
  EXPECT_LE((fit.evaluate(points) + sign * 0.01 * weights - values).cwiseAbs().maxCoeff(), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Rbf, EveryInterpolant, testing::ValuesIn(rbf::kernels()), [](const auto& of) {
  return naive::name({of.param, 0});
});

template <int d>
void reproduces_polynomials(rbf::Kernel kernel, Index count, const rbf::FitOptions& options) {
  const int order = rbf::positive_order(kernel);
  const rbf::Points<d> points = (cube<d>(count, 9).array() + 1e3).matrix(),
                       targets = (2 * cube<d>(20, 10).array() + 1e3).matrix();
  const auto polynomial = [&](const rbf::Points<d>& x) -> Eigen::MatrixXd {
    Eigen::MatrixXd values = Eigen::MatrixXd::Constant(x.cols(), 1, 3.5);
    if (order == 2) values += 2 * (x.colwise().sum().transpose().array() - 1e3 * d).matrix();
    return values;
  };
  const rbf::Interpolant<d> fit(function_of(kernel, 0.05), points, polynomial(points), options);
  EXPECT_LE((fit.evaluate(targets) - polynomial(targets)).cwiseAbs().maxCoeff(), 1e-9) << fit.report();
  EXPECT_LE(fit.weights().cwiseAbs().maxCoeff(), 1e-7);
}

// A Gaussian process that was drawn with some shape: the likelihood finds it, from all points and from parts of them.
TEST(Interpolant, FindsTheShapeOfAProcessByLikelihood) {
  for (const Index count : {200, 700}) {
    const rbf::Points<2> points = cube<2>(count, 11);
    Eigen::MatrixXd covariance(count, count);
    const rbf::Function process{rbf::Kernel::matern52, 0.2};
    for (Index i = 0; i < count; ++i)
      for (Index j = 0; j < count; ++j) covariance(i, j) = rbf::value(process, (points.col(i) - points.col(j)).norm());
    const Eigen::MatrixXd values = Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL() * naive::numbers(count, 2, 12);
    const rbf::Interpolant<2> fit({process.kernel}, points, values, {.shape_by = rbf::ShapeBy::likelihood});
    // Shapes are tried in steps of a factor 1.4; a sample of that size tells them apart.
    EXPECT_NEAR(std::log(fit.report().function.shape / process.shape), 0, std::log(1.45)) << fit.report();
  }
}

TEST(Interpolant, ReproducesItsPolynomials) {
  for (const rbf::Kernel kernel : {rbf::Kernel::multiquadric, rbf::Kernel::thin_plate}) {
    reproduces_polynomials<1>(kernel, 20, {});
    reproduces_polynomials<2>(kernel, 80, {});
    reproduces_polynomials<3>(kernel, 80, {});
  }
  reproduces_polynomials<2>(rbf::Kernel::thin_plate, 1700, {.accuracy = 1e-10});  // by iteration
  reproduces_polynomials<2>(rbf::Kernel::multiquadric, 1700, {.accuracy = 1e-10});
}

template <int d>
void krylov_equals_dense(const rbf::Function& function, const rbf::Points<d>& points) {
  const rbf::Points<d> targets = cube<d>(300, 12);
  const Eigen::MatrixXd values = smooth<d>(points, 2);
  const rbf::Interpolant<d> dense(function, points, values, {.solver = rbf::Solver::dense});
  const rbf::Interpolant<d> krylov(function, points, values, {.solver = rbf::Solver::krylov});
  EXPECT_EQ(krylov.report().solver, rbf::Solver::krylov);
  EXPECT_LE(krylov.report().iterations, 80) << krylov.report();  // two columns
  EXPECT_LE(krylov.report().residual, 1e-7);
  // Both are right to 1e-7 of the largest value at the points, and so twice that apart in between.
  EXPECT_LE((dense.evaluate(targets) - krylov.evaluate(targets)).cwiseAbs().maxCoeff(),
            4e-7 * values.cwiseAbs().maxCoeff())
      << krylov.report();
  // Errors of left-out values from some 200 points around are those from all.
  EXPECT_NEAR(krylov.report().left_out[0] / dense.report().left_out[0], 1, 0.6);
}

TEST(Interpolant, ByIterationEqualsThatByFactorisation) {
  krylov_equals_dense<2>({rbf::Kernel::thin_plate}, cube<2>(1550, 11));
  krylov_equals_dense<2>({rbf::Kernel::multiquadric, 0.03}, cube<2>(1550, 11));
  krylov_equals_dense<2>({rbf::Kernel::matern32, 0.3}, cube<2>(1550, 11));
  krylov_equals_dense<1>({rbf::Kernel::thin_plate}, even<1>(1550));
  krylov_equals_dense<3>({rbf::Kernel::thin_plate}, cube<3>(1550, 11));
}

// A third of the points even, a third in a small cluster, a third along a curve: close points have large weights.
TEST(Interpolant, ByIterationTakesTheValuesAtClusteredPoints) {
  rbf::Points<2> points = cube<2>(1800, 26);
  for (Index i = 0; i < points.cols(); ++i) {
    if (i % 3 == 1) points.col(i) = 0.01 * points.col(i) + Eigen::Vector2d(0.3, 0.6);
    if (i % 3 == 2) points(1, i) = 0.5 + 0.3 * std::sin(6 * points(0, i)) + 1e-3 * points(1, i);
  }
  const Eigen::MatrixXd values = smooth<2>(points);
  const rbf::Interpolant<2> fit({rbf::Kernel::thin_plate}, points, values);
  EXPECT_EQ(fit.report().solver, rbf::Solver::krylov);
  const rbf::Interpolant<2> pairs({rbf::Kernel::thin_plate}, points, values, {.solver = rbf::Solver::dense});
  const rbf::Points<2> targets = cube<2>(100, 27);
  EXPECT_LE((fit.evaluate(points) - values).cwiseAbs().maxCoeff(), 2e-7 * values.cwiseAbs().maxCoeff());
  EXPECT_LE((fit.evaluate(targets) - pairs.evaluate(targets)).cwiseAbs().maxCoeff(), 1e-5) << fit.report();
}

TEST(Interpolant, ApproachesTheFunctionAtTheKernelsRate) {
  // Near the boundary splines of order m = 2 are less accurate; in the root mean square the order is m + 1/2.
  const rbf::Points<2> targets = cube<2>(2000, 14);
  const auto error = [&](Index count) {
    const rbf::Points<2> points = even<2>(count);
    const rbf::Interpolant<2> fit({rbf::Kernel::thin_plate}, points, franke(points));
    const double measured = (fit.evaluate(targets).col(0) - franke(targets)).norm() / std::sqrt(2000.0);
    // What it says of itself: more than the error, since points at the boundary are left out too.
    EXPECT_GE(fit.report().left_out[0], measured) << fit.report();
    EXPECT_LE(fit.report().left_out[0], 10 * measured) << fit.report();
    return measured;
  };
  const double coarse = error(1000), fine = error(8000);
  EXPECT_LE(fine, coarse / std::pow(8.0, 2.5 / 2));
  EXPECT_LE(fine, 3e-5);
}

TEST(Interpolant, OfVectorsIsThatOfEveryComponent) {
  const rbf::Points<3> points = cube<3>(120, 15), targets = cube<3>(10, 16);
  const Eigen::MatrixXd values = smooth<3>(points, 3);
  const rbf::Function function{rbf::Kernel::multiquadric, 0.2};
  const Eigen::MatrixXd all = rbf::Interpolant<3>(function, points, values).evaluate(targets);
  for (Index k = 0; k < 3; ++k) {
    const Eigen::MatrixXd one = rbf::Interpolant<3>(function, points, values.col(k)).evaluate(targets);
    EXPECT_LE((all.col(k) - one).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(Interpolant, HasDerivativesAndGrids) {
  const rbf::Points<2> points = cube<2>(150, 17);
  const rbf::TensorGrid grid{{{0.2, 0.4, 0.7}, {0.1, 0.5}}};
  rbf::Points<2> nodes(2, 6);
  for (Index i = 0; i < 6; ++i)
    nodes.col(i) << grid.axes[0][static_cast<std::size_t>(i % 3)], grid.axes[1][static_cast<std::size_t>(i / 3)];
  for (const rbf::Function& function :
       {rbf::Function{rbf::Kernel::thin_plate}, rbf::Function{rbf::Kernel::multiquadric, 0.2}}) {
    const rbf::Interpolant<2> fit(function, points, smooth<2>(points, 2));
    const double step = 1e-4;
    const rbf::Points<2> ahead = (nodes.array().colwise() + Eigen::Array2d(0, step)).matrix(),
                         behind = (nodes.array().colwise() - Eigen::Array2d(0, step)).matrix();
    const rbf::Interpolant<2> accurate(function, points, smooth<2>(points, 2), {.accuracy = 1e-12});
    const Eigen::MatrixXd slope = (accurate.evaluate(ahead) - accurate.evaluate(behind)) / (2 * step);
    EXPECT_LE((fit.evaluate(nodes, {0, 1}) - slope).cwiseAbs().maxCoeff(), 2e-5);
    EXPECT_LE((fit.evaluate(grid, {0, 1}) - slope).cwiseAbs().maxCoeff(), 2e-5);
    EXPECT_LE((fit.evaluate(grid) - fit.evaluate(nodes)).cwiseAbs().maxCoeff(), 1e-6);
    const rbf::Evaluator<2> often = fit.evaluator(2.0, 1);
    EXPECT_LE((often.evaluate(nodes) - fit.evaluate(nodes)).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LE((often.evaluate_combinations(grid, {{{{0, 1}, 2.0}, {{0, 0}, 1.0}}}) - (2 * slope + fit.evaluate(nodes)))
                  .cwiseAbs()
                  .maxCoeff(),
              5e-5);
  }
}

TEST(Interpolant, DoesNotDependOnTheUnitOfLengthOrThreads) {
  const rbf::Points<2> points = cube<2>(1600, 18), far = (1e-3 * points.array() + 5).matrix();
  const rbf::Points<2> targets = cube<2>(50, 19), far_targets = (1e-3 * targets.array() + 5).matrix();
  const Eigen::MatrixXd values = smooth<2>(points);
  const auto fit = [&](const rbf::Points<2>& at, int threads) {
    return rbf::Interpolant<2>({rbf::Kernel::multiquadric}, at, values, {.threads = threads});
  };
  const rbf::Interpolant<2> near = fit(points, 1), also_near = fit(points, 2);
  EXPECT_EQ(near.weights(), also_near.weights());
  EXPECT_EQ(near.report().function.shape, also_near.report().function.shape);
  EXPECT_LE((near.evaluate(targets) - fit(far, 1).evaluate(far_targets)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Interpolant, OfNothingIsNothing) {
  const rbf::Points<2> points = cube<2>(1600, 20);
  EXPECT_EQ(
      rbf::Interpolant<2>({rbf::Kernel::thin_plate}, points, Eigen::VectorXd::Zero(1600)).evaluate(points.leftCols(3)),
      Eigen::MatrixXd::Zero(3, 1));
  const rbf::Interpolant<2> one({rbf::Kernel::matern32}, points.leftCols(1), Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_NEAR(one.evaluate(points.leftCols(1))(0, 0), 2, 1e-12);
}

template <int d>
std::string refusal(const rbf::Function& function, const rbf::Points<d>& points, const Eigen::MatrixXd& values,
                    const rbf::FitOptions& options = {}) {
  try {
    const rbf::Interpolant<d> fit(function, points, values, options);
  } catch (const rbf::Error& error) {
    return error.what();
  }
  return "";
}

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(InterpolantRefuses, EqualPoints) {
  rbf::Points<2> points = cube<2>(40, 21);
  points.col(30) = points.col(7);
  Eigen::MatrixXd values = smooth<2>(points);
  expect_in(refusal<2>({rbf::Kernel::thin_plate}, points, values), "points 7 and 30 are both at (");
  values(30, 0) += 1;
  expect_in(refusal<2>({rbf::Kernel::thin_plate}, points, values), "and have different values; remove one");
}

TEST(InterpolantRefuses, KernelsThatAreTooFlat) {
  for (const Index count : {300, 1600}) {
    const rbf::Points<2> points = cube<2>(count, 22);
    const std::string flat = refusal<2>({rbf::Kernel::multiquadric, 10}, points, smooth<2>(points));
    expect_in(flat, "not definite to rounding");
    expect_in(flat, "Lower the shape");
    expect_in(flat, "FitOptions::regularisation (begin with");
    EXPECT_THROW(rbf::Interpolant<2>({rbf::Kernel::gaussian, 3}, points, smooth<2>(points)), rbf::IllConditioned);
  }
}

TEST(InterpolantRefuses, TooFewIterations) {
  const rbf::Points<2> points = cube<2>(2500, 23);
  expect_in(refusal<2>({rbf::Kernel::multiquadric, 0.04}, points, smooth<2>(points), {.most_iterations = 1}),
            "after 1 iterations the equations are met to");
}

TEST(InterpolantRefuses, PointsThatDoNotDetermineThePolynomial) {
  rbf::Points<2> line = cube<2>(20, 24);
  line.row(1) = 2 * line.row(0);
  expect_in(refusal<2>({rbf::Kernel::thin_plate}, line, smooth<2>(line)), "all points lie on a line; thin-plate");
  EXPECT_EQ(refusal<2>({rbf::Kernel::matern32, 0.3}, line, smooth<2>(line)), "");
  const rbf::Points<2> two = line.leftCols(2);
  expect_in(refusal<2>({rbf::Kernel::thin_plate}, two, smooth<2>(two)), "2 points are too few for thin-plate");
  const rbf::Points<2> none(2, 0);
  expect_in(refusal<2>({rbf::Kernel::thin_plate}, none, Eigen::MatrixXd(0, 1)), "there are no points");
}

TEST(InterpolantRefuses, WhatIsNotFiniteOrOutOfRange) {
  rbf::Points<1> points = cube<1>(10, 25);
  Eigen::MatrixXd values = smooth<1>(points);
  const rbf::Function function{rbf::Kernel::matern52, 0.3};
  expect_in(refusal<1>(function, points, values.topRows(9)), "10 points but 9 rows of values");
  expect_in(refusal<1>({rbf::Kernel::matern52, -1}, points, values), "shape = -1");
  expect_in(refusal<1>({rbf::Kernel::thin_plate, 1}, points, values), "must be 0 for thin-plate");
  expect_in(refusal<1>(function, points, values, {.accuracy = 0}), "FitOptions::accuracy = 0");
  expect_in(refusal<1>(function, points, values, {.regularisation = -1}), "FitOptions::regularisation = -1");
  expect_in(refusal<1>(function, points, values, {.most_iterations = 0}), "FitOptions::most_iterations = 0");
  expect_in(refusal<1>(function, points, values, {.threads = -1}), "FitOptions::threads = -1");
  expect_in(refusal<1>(function, points, values, {.memory_limit = 100}), "Options::memory_limit");
  values(4, 0) = NAN;
  expect_in(refusal<1>(function, points, values), "values: row 4, column 0 is nan");
  points(0, 3) = INFINITY;
  expect_in(refusal<1>(function, points, values), "point 3");
  EXPECT_THROW(rbf::cross_validation_errors<1>(function, cube<1>(5, 1), Eigen::VectorXd::Zero(5), 6),
               rbf::InvalidArgument);
}

}  // namespace
