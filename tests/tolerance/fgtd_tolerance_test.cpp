// The promise, term by term: with one column of weights for every source, each column of the result is a single
// Gaussian, right to tolerance N_alpha at every target, and beyond L = 2 ln(1/tolerance) + 40 to tolerance N_alpha
// exp(L - sigma r^2).
#include <gtest/gtest.h>

#include "oracle/naive.hpp"

namespace {

/// Largest error over its allowance. Rounding is allowed 3e-14 N_alpha near the Gaussian, and relative to it far away.
template <int d>
double worst_ratio(const fgtd::Points<d>& sources, double sigma, const fgtd::Points<d>& targets,
                   const Eigen::MatrixXd& values, const fgtd::Derivative<d>& alpha, double tolerance) {
  const double limit = 2 * std::log(1 / tolerance) + 40, scale = fgtd::derivative_scale<d>(alpha, sigma);
  double worst = 0;
  for (Eigen::Index j = 0; j < sources.cols(); ++j)
    for (Eigen::Index i = 0; i < targets.cols(); ++i) {
      const double exact = static_cast<double>(naive::term<d>(targets.col(i), sources.col(j), sigma, alpha));
      const double squared = sigma * (targets.col(i) - sources.col(j)).squaredNorm();
      const double promised = tolerance * scale * std::exp(std::min(0.0, limit - squared));
      const double rounding = squared <= limit ? 3e-14 * scale : 1e-12 * std::abs(exact);
      worst = std::max(worst, std::abs(values(i, j) - exact) / (promised + rounding + 1e-300));
    }
  return worst;
}

template <int d>
void expect_promise_kept(fgtd::Method method, const std::vector<double>& tolerances, const std::vector<int>& orders) {
  const double sigma = 3.7, width = 1 / std::sqrt(sigma);
  const int count = d == 1 ? 24 : d == 2 ? 12 : 6;
  // half of the sources in one place, the others scattered over a few widths, so that boxes are full, sparse and empty
  fgtd::Points<d> sources = naive::random_points<d>(count, 51, 0, 6 * width);
  for (int j = 0; j < count / 2; ++j) sources.col(j) = sources.col(j) / 8;
  // targets all around, up to where the Gaussians are far beyond the fading distance
  fgtd::Points<d> targets = naive::random_points<d>(d == 1 ? 300 : d == 2 ? 200 : 120, 52, -6 * width, 12 * width);
  for (int j = 0; j < count; ++j) targets.col(j) = sources.col(j);
  const fgtd::TensorGrid grid = naive::cube_grid<d>(d == 1 ? 200 : d == 2 ? 23 : 9, -7 * width, 13 * width);
  const fgtd::Points<d> grid_points = naive::points_of<d>(grid);
  const Eigen::MatrixXd one_hot = Eigen::MatrixXd::Identity(count, count);

  for (const double tolerance : tolerances)
    for (const int order : orders) {
      const fgtd::Plan<d> plan(sources, one_hot, sigma,
                               {.tolerance = tolerance, .derivative_order = order, .method = method});
      ASSERT_EQ(plan.choice().method, method);
      EXPECT_LE(plan.choice().bound.value(), tolerance);
      std::vector<fgtd::Derivative<d>> alphas = naive::derivatives_of_order<d>(order);
      if (order > 1) alphas.push_back({});
      for (const auto& alpha : alphas) {
        EXPECT_LE(worst_ratio<d>(sources, sigma, targets, plan.evaluate(targets, alpha), alpha, tolerance), 1.0)
            << "points, tolerance " << tolerance << ", order " << order << ": " << plan.choice();
        EXPECT_LE(worst_ratio<d>(sources, sigma, grid_points, plan.evaluate(grid, alpha), alpha, tolerance), 1.0)
            << "grid, tolerance " << tolerance << ", order " << order << ": " << plan.choice();
      }
    }
}

const std::vector<double> all_tolerances = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13};

TEST(Tolerance, OfHermiteIsKeptByEveryTermInOneDimension) {
  expect_promise_kept<1>(fgtd::Method::hermite, all_tolerances, {0, 1, 2, 3, 4});
}
TEST(Tolerance, OfHermiteIsKeptByEveryTermInTwoDimensions) {
  expect_promise_kept<2>(fgtd::Method::hermite, all_tolerances, {0, 1, 2, 3, 4});
}
TEST(Tolerance, OfHermiteIsKeptByEveryTermInThreeDimensions) {
  expect_promise_kept<3>(fgtd::Method::hermite, {1e-2, 1e-5, 1e-9, 1e-13}, {0, 1, 2});
  expect_promise_kept<3>(fgtd::Method::hermite, {1e-2, 1e-7}, {4});
}
TEST(Tolerance, OfDirectIsKeptByEveryTerm) {
  expect_promise_kept<1>(fgtd::Method::direct, {1e-2, 1e-13}, {0, 1, 2, 3, 4});
  expect_promise_kept<2>(fgtd::Method::direct, {1e-2, 1e-13}, {0, 1, 2, 3, 4});
  expect_promise_kept<3>(fgtd::Method::direct, {1e-2, 1e-13}, {0, 1, 2, 3, 4});
}

TEST(Tolerance, OfASharpGaussianFarFromTheOriginIsKept) {
  const double sigma = 1e10;  // width 1e-5
  fgtd::Points<2> sources = naive::random_points<2>(10, 53, 0, 3e-5),
                  targets = naive::random_points<2>(100, 54, -3e-5, 6e-5);
  sources.array() += 5;
  targets.array() += 5;
  const fgtd::Plan<2> plan(sources, Eigen::MatrixXd::Identity(10, 10), sigma,
                           {.tolerance = 1e-13, .method = fgtd::Method::hermite});
  ASSERT_EQ(plan.choice().method, fgtd::Method::hermite);
  EXPECT_LE(worst_ratio<2>(sources, sigma, targets, plan.evaluate(targets), {}, 1e-13), 1.0);
}

TEST(Tolerance, OfACombinationIsTheSumOfItsTerms) {
  const double sigma = 40;
  const auto sources = naive::random_points<2>(200, 55), targets = naive::random_points<2>(200, 56);
  const auto weights = naive::random_weights(200, 1, 57);
  const fgtd::Combination<2> combination = {{{0, 0}, 2.0}, {{2, 0}, -0.25 / sigma}, {{0, 2}, -0.25 / sigma}};
  const double scale = 2.0 + 2 * 0.25 * std::sqrt(8.0);  // sum |c_alpha| N_alpha
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const fgtd::Plan<2> plan(sources, weights, sigma,
                             {.tolerance = tolerance, .derivative_order = 2, .method = fgtd::Method::hermite});
    Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(200, 1);
    for (const auto& term : combination)
      exact += term.coefficient * naive::sum<2>(sources, weights, sigma, targets, term.derivative);
    EXPECT_LE((plan.evaluate_combination(targets, combination) - exact).cwiseAbs().maxCoeff(),
              (tolerance + 3e-14) * scale * weights.cwiseAbs().sum());
  }
}

}  // namespace
