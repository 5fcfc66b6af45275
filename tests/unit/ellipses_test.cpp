// Blobs that are ellipses: sums on a grid and what is known of one blob, against formulas written out with the inverse of
// its matrix.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "gaussdrift/lattice.hpp"
#include "particle/cutoff.hpp"
#include "particle/round_coordinates.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {
namespace {

constexpr Tensor aslant{{{1, 0.2, 0.1}, {0.2, 0.7, -0.1}, {0.1, -0.1, 0.5}}};
constexpr Tensor along_axes{{{1, 0, 0}, {0, 0.3, 0}, {0, 0, 0.1}}};

/// The shape with a largest eigenvalue of 1.
Tensor scaled(Tensor shape, int d) {
  Eigen::MatrixXd matrix(d, d);
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < d; ++j) matrix(i, j) = shape[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const double largest = matrix.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
  for (auto& row : shape)
    for (double& entry : row) entry /= largest;
  for (std::size_t k = static_cast<std::size_t>(d); k < max_dimension; ++k)
    for (std::size_t l = 0; l < max_dimension; ++l) shape[k][l] = shape[l][k] = 0;
  return shape;
}

/// exp(-x^T M^-1 x) / sqrt(pi^d det M), M = eps^2 I + spread * shape, and its gradient.
struct Exact {
  Eigen::MatrixXd inverse;
  double factor;

  Exact(int d, double eps, double spread, const Tensor& shape) {
    Eigen::MatrixXd matrix = eps * eps * Eigen::MatrixXd::Identity(d, d);
    for (int i = 0; i < d; ++i)
      for (int j = 0; j < d; ++j)
        matrix(i, j) += spread * shape[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    inverse = matrix.inverse();
    factor = 1 / std::sqrt(std::pow(std::numbers::pi, d) * matrix.determinant());
  }
  double value(const Eigen::VectorXd& x) const { return factor * std::exp(-x.dot(inverse * x)); }
  Eigen::VectorXd gradient(const Eigen::VectorXd& x) const { return -2 * value(x) * (inverse * x); }
};

Particles some_particles(int d) {
  Particles particles;
  particles.dimension = d;
  for (int j = 0; j < 40; ++j) {
    for (int k = 0; k < d; ++k)
      particles.position[static_cast<std::size_t>(k)].push_back(std::sin(1.7 * j + 2.3 * k * j + k));
    particles.alpha.push_back(1 + 0.5 * std::cos(j));
    particles.id.push_back(j);
  }
  return particles;
}

class Ellipses : public testing::TestWithParam<std::tuple<int, bool>> {};
INSTANTIATE_TEST_SUITE_P(Blobs, Ellipses, testing::Combine(testing::Values(2, 3), testing::Bool()));

TEST_P(Ellipses, AreSummedOnAGridWithTheirGradients) {
  const auto [d, is_aslant] = GetParam();
  const Tensor shape = scaled(is_aslant ? aslant : along_axes, d);
  const double eps = 0.2, spread = 0.15;
  const Exact exact(d, eps, spread, shape);
  const Cutoff cutoff = spread_cutoff(make_cutoff("gauss2", d, eps), d, spread, shape);
  const Particles particles = some_particles(d);
  const Lattice lattice = make_lattice(d, {-1, -1, -1}, {1, 1, 1}, 13);
  for (const double tolerance : {1e-4, 1e-9}) {
    DensityOptions options{.tolerance = tolerance};
    for (int k = 0; k < d; ++k) {
      std::array<int, max_dimension> alpha{};
      alpha[static_cast<std::size_t>(k)] = 1;
      options.derivatives.push_back({alpha});
    }
    DensityReport report;
    const DensityGrid sum = evaluate_density(particles, cutoff, lattice, options, &report);
    std::vector<double> errors(options.quantities(), 0.0), largest = errors;
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      Eigen::VectorXd x(d);
      std::size_t rest = i;
      for (int k = 0; k < d; ++k) {
        x(k) = lattice.coordinate(k, rest % lattice.points[static_cast<std::size_t>(k)]);
        rest /= lattice.points[static_cast<std::size_t>(k)];
      }
      Eigen::VectorXd right = Eigen::VectorXd::Zero(1 + d);
      for (std::size_t j = 0; j < particles.size(); ++j) {
        Eigen::VectorXd from = x;
        for (int k = 0; k < d; ++k) from(k) -= particles.position[static_cast<std::size_t>(k)][j];
        right(0) += particles.alpha[j] * exact.value(from);
        right.tail(d) += particles.alpha[j] * exact.gradient(from);
      }
      for (std::size_t q = 0; q < errors.size(); ++q) {
        const double found = q == 0 ? sum.rho[i] : report.derivatives[q - 1][i];
        errors[q] = std::max(errors[q], std::abs(found - right(static_cast<Eigen::Index>(q))));
        largest[q] = std::max(largest[q], std::abs(right(static_cast<Eigen::Index>(q))));
      }
    }
    for (std::size_t q = 0; q < errors.size(); ++q) EXPECT_LT(errors[q], tolerance * largest[q]) << q;  // the promise
    EXPECT_LT(report.measured_error, tolerance);
  }
}

TEST_P(Ellipses, HaveThePeakAndTheReachOfOneBlob) {
  const auto [d, is_aslant] = GetParam();
  const Tensor shape = scaled(is_aslant ? aslant : along_axes, d);
  const double eps = 0.2, spread = 0.15, part = 1e-8;
  const Cutoff second = spread_cutoff(make_cutoff("gauss2", d, eps), d, spread, shape);
  const Exact exact(d, eps, spread, shape);
  EXPECT_NEAR(peak(second), exact.factor, 1e-14 * exact.factor);  // rounding
  // gauss4 is (1 - eps^2/4 Laplacian) gauss2, and the Laplacian at the centre is -2 trace of the inverse.
  const Cutoff fourth = spread_cutoff(make_cutoff("gauss4", d, eps), d, spread, shape);
  const double at_centre = exact.factor * (1 + eps * eps / 2 * exact.inverse.trace());
  EXPECT_NEAR(peak(fourth), at_centre, 1e-14 * at_centre);  // rounding
  // Along the longest axis, beyond the reach of both. A bound is not far too wide: twice the true reach at most.
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(exact.inverse);
  const Eigen::VectorXd longest = solver.eigenvectors().col(0);
  const auto fourth_at = [&](double r) {
    const Eigen::VectorXd x = r * longest, ax = exact.inverse * x;
    return exact.value(x) * (1 - eps * eps / 4 * (4 * ax.squaredNorm() - 2 * exact.inverse.trace()));
  };
  const double reach_2 = reach(second, part), reach_4 = reach(fourth, part);
  EXPECT_LE(exact.value(reach_2 * longest), part * exact.factor * (1 + 1e-12));
  EXPECT_GT(exact.value(reach_2 / 2 * longest), part * exact.factor);
  EXPECT_LE(std::abs(fourth_at(reach_4)), part * at_centre * (1 + 1e-12));
  EXPECT_GT(std::abs(fourth_at(reach_4 / 2)), part * at_centre);
}

TEST(Ellipses, ThatAreRoundAreTheBlobsThatTheyWere) {
  constexpr Tensor round{{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}};
  const Cutoff cutoff = make_cutoff("gauss4", 2, 0.2), one = spread_cutoff(cutoff, 2, 0.1),
               other = spread_cutoff(cutoff, 2, 0.1, round);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_TRUE(other[i].is_round());
    EXPECT_EQ(one[i].width, other[i].width);
    EXPECT_EQ(one[i].coefficient, other[i].coefficient);
  }
}

}  // namespace
}  // namespace gaussdrift
