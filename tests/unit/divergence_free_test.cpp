// Divergence-free Gaussian fields: the collapsed pair formulas against the definition of Phi [Sch06, 6.3], fgtd against
// the pairs, and the laws of section 6.4.
#include "field/gaussians/divergence_free.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace gaussdrift {
namespace {

using Index = Eigen::Index;
constexpr std::array<GaussianMatrix, 3> matrices{GaussianMatrix::field, GaussianMatrix::curl,
                                                 GaussianMatrix::vorticity};

// Uniform in [-1, 1].
Eigen::MatrixXd random_matrix(Index rows, Index columns, unsigned seed) {
  std::mt19937_64 generator(seed);
  Eigen::MatrixXd m(rows, columns);
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) m(i, j) = static_cast<double>(generator() >> 11) * 0x1p-52 - 1;
  return m;
}

template <int d>
struct Setting {
  fgtd::Points<d> points = random_matrix(d, 300, 1), targets = random_matrix(d, 45, 2) * 1.5;
  double sigma = 9;
  Eigen::MatrixXd coefficients(GaussianMatrix matrix) const {
    return random_matrix(points.cols(), gaussian_columns(matrix, d), 3);
  }
};

// d_i d_j phi(r) and d_i phi(r) as calculus gives them.
template <int d>
double second(const Eigen::Matrix<double, d, 1>& r, double sigma, int i, int j) {
  return (4 * sigma * sigma * r[i] * r[j] - (i == j ? 2 * sigma : 0)) * std::exp(-sigma * r.squaredNorm());
}
template <int d>
double first(const Eigen::Matrix<double, d, 1>& r, double sigma, int i) {
  return -2 * sigma * r[i] * std::exp(-sigma * r.squaredNorm());
}

// The matrices as [Sch06, 6.2, 6.3] define them, entry by entry.
template <int d>
Eigen::VectorXd defined(GaussianMatrix matrix, const Eigen::Matrix<double, d, 1>& r, const Eigen::VectorXd& gamma,
                        double sigma) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(gaussian_rows(matrix, d));
  if (matrix == GaussianMatrix::curl) {
    if (d == 2) {
      result << first<d>(r, sigma, 1) * gamma[0], -first<d>(r, sigma, 0) * gamma[0];
    } else {
      const Eigen::Vector3d gradient(first<d>(r, sigma, 0), first<d>(r, sigma, 1), first<d>(r, sigma, d - 1));
      result = gradient.cross(Eigen::Vector3d(gamma));
    }
  } else if (gamma.size() == 1) {
    result[0] = -(second<d>(r, sigma, 0, 0) + second<d>(r, sigma, 1, 1)) * gamma[0];
  } else {
    for (int i = 0; i < d; ++i)
      for (int j = 0; j < d; ++j) {
        double entry = 0;
        if (i != j) entry = second<d>(r, sigma, i, j);
        for (int k = 0; i == j && k < d; ++k)
          if (k != i) entry -= second<d>(r, sigma, k, k);
        result[i] += entry * gamma[j];
      }
  }
  return result;
}

template <int d>
void pairs_are_the_definition() {
  const Setting<d> s;
  for (const GaussianMatrix matrix : matrices) {
    const Eigen::MatrixXd coefficients = s.coefficients(matrix);
    const GaussianSum<d> sum(s.points, coefficients, s.sigma, {.method = fgtd::Method::direct});
    EXPECT_TRUE(sum.pairwise());
    const Eigen::MatrixXd values = sum.evaluate(matrix, s.targets);
    ASSERT_EQ(values.cols(), gaussian_rows(matrix, d));
    for (Index i = 0; i < s.targets.cols(); ++i) {
      Eigen::VectorXd exact = Eigen::VectorXd::Zero(values.cols()), size = exact;
      for (Index k = 0; k < s.points.cols(); ++k) {
        const Eigen::VectorXd pair =
            defined<d>(matrix, s.targets.col(i) - s.points.col(k), coefficients.row(k), s.sigma);
        exact += pair;
        size += pair.cwiseAbs();
      }
      for (Index row = 0; row < values.cols(); ++row)
        EXPECT_NEAR(values(i, row), exact[row], 2.1e-15 * (size[row] + s.sigma))  // rounding of the terms: 7e-16
            << "matrix " << static_cast<int>(matrix) << ", target " << i;
    }
  }
}
TEST(GaussianPairs, AreTheDefinitionIn2D) { pairs_are_the_definition<2>(); }
TEST(GaussianPairs, AreTheDefinitionIn3D) { pairs_are_the_definition<3>(); }

template <int d>
void fgtd_equals_pairs() {
  const Setting<d> s;
  for (const GaussianMatrix matrix : matrices)
    for (const fgtd::Method method : {fgtd::Method::hermite, fgtd::Method::cells, fgtd::Method::chebyshev}) {
      const Eigen::MatrixXd coefficients = s.coefficients(matrix);
      const GaussianSum<d> pairs(s.points, coefficients, s.sigma, {.method = fgtd::Method::direct});
      const GaussianSum<d> fast(s.points, coefficients, s.sigma, {.tolerance = 1e-7, .method = method});
      EXPECT_FALSE(fast.pairwise());
      const Eigen::MatrixXd values = fast.evaluate(matrix, s.targets);
      const double promise = 1e-7 * fast.unit_error(matrix);
      EXPECT_LE((values - pairs.evaluate(matrix, s.targets)).cwiseAbs().maxCoeff(), promise);
      EXPECT_LE(promise, 8e-5 * values.cwiseAbs().maxCoeff());  // a promise that says something
      for (int row = 0; row < gaussian_rows(matrix, d); ++row)
        EXPECT_LE((fast.component(matrix, row, s.targets) - values.col(row)).cwiseAbs().maxCoeff(), promise)
            << "one component alone";
    }
}
TEST(GaussianSum, OfFgtdEqualsPairsIn2D) { fgtd_equals_pairs<2>(); }
TEST(GaussianSum, OfFgtdEqualsPairsIn3D) { fgtd_equals_pairs<3>(); }

template <int d>
void derivatives_are_slopes() {
  const Setting<d> s;
  constexpr double step = 1e-4;
  for (const GaussianMatrix matrix : matrices) {
    const GaussianSum<d> sum(s.points, s.coefficients(matrix), s.sigma,
                             {.derivative_order = 3, .method = fgtd::Method::direct});
    for (int l = 0; l < d; ++l) {
      fgtd::Derivative<d> alpha{};
      alpha[static_cast<std::size_t>(l)] = 1;
      fgtd::Points<d> ahead = s.targets, behind = s.targets;
      ahead.row(l).array() += step;
      behind.row(l).array() -= step;
      const Eigen::MatrixXd slope = (sum.evaluate(matrix, ahead) - sum.evaluate(matrix, behind)) / (2 * step);
      const Eigen::MatrixXd exact = sum.evaluate(matrix, s.targets, alpha);
      // step^2 sigma is the error of a central difference relative to the largest third derivative, give or take 4;
      // measured 1.5.
      EXPECT_LE((slope - exact).cwiseAbs().maxCoeff(), 4 * step * step * s.sigma * exact.cwiseAbs().maxCoeff());
    }
  }
}
TEST(GaussianSum, DerivativesAreSlopesIn2D) { derivatives_are_slopes<2>(); }
TEST(GaussianSum, DerivativesAreSlopesIn3D) { derivatives_are_slopes<3>(); }

template <int d>
void is_divergence_free() {
  const Setting<d> s;
  fgtd::Derivative<d> mixed{};
  mixed[0] = mixed[1] = 1;
  for (const GaussianMatrix matrix : {GaussianMatrix::field, GaussianMatrix::curl})
    for (const fgtd::Method method : {fgtd::Method::direct, fgtd::Method::hermite, fgtd::Method::chebyshev})
      for (const fgtd::Derivative<d>& alpha : {fgtd::Derivative<d>{}, mixed}) {
        const GaussianSum<d> sum(s.points, s.coefficients(matrix), s.sigma,
                                 {.tolerance = 1e-3, .derivative_order = 5, .method = method});
        const Divergence divergence = sum.divergence(matrix, s.targets, alpha);
        // Rounding: 300 sources, each right to a few units in the last place of its largest derivative. The tolerance
        // of 1e-3 does not show [Sch06, Bemerkung 6.4.3].
        EXPECT_LE(divergence.value.cwiseAbs().maxCoeff(), 9e-16 * divergence.terms.maxCoeff())
            << fgtd::to_string(method) << ", matrix " << static_cast<int>(matrix);
        EXPECT_GT(divergence.terms.maxCoeff(), s.sigma);
      }
}
TEST(GaussianSum, HasNoDivergenceIn2D) { is_divergence_free<2>(); }
TEST(GaussianSum, HasNoDivergenceIn3D) { is_divergence_free<3>(); }

TEST(GaussianSum, VorticityIsTheCurlOfTheCurlForm) {
  const Setting<2> s2;
  const GaussianSum<2> flat(s2.points, s2.coefficients(GaussianMatrix::curl), s2.sigma,
                            {.method = fgtd::Method::direct});
  const Eigen::VectorXd curl = flat.evaluate(GaussianMatrix::curl, s2.targets, {1, 0}).col(1) -
                               flat.evaluate(GaussianMatrix::curl, s2.targets, {0, 1}).col(0);
  const Eigen::VectorXd vorticity = flat.evaluate(GaussianMatrix::vorticity, s2.targets).col(0);
  EXPECT_LE((curl - vorticity).cwiseAbs().maxCoeff(), 1.5e-15 * vorticity.cwiseAbs().maxCoeff());  // rounding: 5e-16

  const Setting<3> s;
  const GaussianSum<3> sum(s.points, s.coefficients(GaussianMatrix::curl), s.sigma, {.method = fgtd::Method::direct});
  const auto slope = [&](int axis, int component) -> Eigen::VectorXd {
    fgtd::Derivative<3> alpha{};
    alpha[static_cast<std::size_t>(axis)] = 1;
    return sum.evaluate(GaussianMatrix::curl, s.targets, alpha).col(component);
  };
  const Eigen::MatrixXd field = sum.evaluate(GaussianMatrix::field, s.targets);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    EXPECT_LE((slope(j, k) - slope(k, j) - field.col(i)).cwiseAbs().maxCoeff(), 5e-15 * field.cwiseAbs().maxCoeff());
  }
}

TEST(GaussianSum, HasTheSameBitsForEveryNumberOfThreads) {
  const Setting<3> s;
  for (const fgtd::Method method : {fgtd::Method::direct, fgtd::Method::chebyshev}) {
    const auto evaluate = [&](int threads) {
      return GaussianSum<3>(s.points, s.coefficients(GaussianMatrix::field), s.sigma,
                            {.method = method, .threads = threads})
          .evaluate(GaussianMatrix::field, s.targets);
    };
    EXPECT_EQ(evaluate(1), evaluate(2)) << fgtd::to_string(method);
    EXPECT_EQ(evaluate(1), evaluate(4)) << fgtd::to_string(method);
  }
}

TEST(GaussianSum, ChoosesPairsForFewPointsAndFgtdForMany) {
  const fgtd::Points<2> few = random_matrix(2, 20, 4), many = random_matrix(2, 30000, 5);
  EXPECT_TRUE(GaussianSum<2>(few, random_matrix(20, 2, 6), 100).pairwise());
  EXPECT_FALSE(GaussianSum<2>(many, random_matrix(30000, 2, 6), 100).pairwise());
}

TEST(GaussianPairs, FarTargetsGetZeroAndNaNStaysNaN) {
  const Setting<2> s;
  const GaussianSum<2> sum(s.points, s.coefficients(GaussianMatrix::field), s.sigma, {.method = fgtd::Method::direct});
  fgtd::Points<2> targets(2, 3);
  targets << 1e200, 50, std::numeric_limits<double>::quiet_NaN(), 0, 50, 0;
  const Eigen::MatrixXd values = sum.evaluate(GaussianMatrix::field, targets);
  EXPECT_EQ(values.topRows(2), Eigen::MatrixXd::Zero(2, 2));
  EXPECT_TRUE(std::isnan(values(2, 0)) && std::isnan(values(2, 1)));
}

}  // namespace
}  // namespace gaussdrift
