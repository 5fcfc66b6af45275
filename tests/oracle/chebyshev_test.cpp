// `chebyshev` against `direct`, and its promise term by term.
#include <gtest/gtest.h>

#include "fgtd/chebyshev/error.hpp"
#include "oracle/naive.hpp"

namespace {

template <int d>
fgtd::Plan<d> chebyshev(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights, double sigma, double tolerance,
                        int order = 0, int threads = 1) {
  return {sources,
          weights,
          sigma,
          {.tolerance = tolerance, .derivative_order = order, .method = fgtd::Method::chebyshev, .threads = threads}};
}

/// Largest difference from `direct`, over its allowance tolerance N_alpha Q.
template <int d>
void expect_equal(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights, double sigma,
                  const fgtd::Points<d>& targets, const fgtd::TensorGrid& grid, double tolerance,
                  const std::vector<fgtd::Derivative<d>>& derivatives, int order) {
  const fgtd::Plan<d> direct(sources, weights, sigma, {.derivative_order = order, .method = fgtd::Method::direct});
  const fgtd::Plan<d> plan = chebyshev<d>(sources, weights, sigma, tolerance, order);
  ASSERT_EQ(plan.choice().method, fgtd::Method::chebyshev);
  ASSERT_LE(plan.choice().bound.value(), tolerance);
  const double weight = weights.cwiseAbs().colwise().sum().maxCoeff();
  for (const auto& alpha : derivatives) {
    const double allowed = (tolerance + 3e-14) * fgtd::derivative_scale<d>(alpha, sigma) * weight;
    EXPECT_LE((direct.evaluate(targets, alpha) - plan.evaluate(targets, alpha)).cwiseAbs().maxCoeff(), allowed)
        << plan.choice();
    EXPECT_LE((direct.evaluate(grid, alpha) - plan.evaluate(grid, alpha)).cwiseAbs().maxCoeff(), allowed)
        << plan.choice();
  }
}

/// Largest error of a single term over its allowance, see tests/tolerance.
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

struct Slack {
  double log_sum = 0;
  int count = 0;
};

/// One column of weights for every source; `slack` collects how much of the tolerance is used.
template <int d>
void expect_promise(const std::vector<double>& tolerances, const std::vector<std::vector<fgtd::Derivative<d>>>& orders,
                    Slack* slack = nullptr) {
  const double sigma = 3.7, width = 1 / std::sqrt(sigma);
  const int count = d == 1 ? 24 : d == 2 ? 12 : 6;
  fgtd::Points<d> sources = naive::random_points<d>(count, 71, 0, 6 * width);
  for (int j = 0; j < count / 2; ++j) sources.col(j) = sources.col(j) / 8;
  fgtd::Points<d> targets = naive::random_points<d>(d == 1 ? 2000 : 1500, 72, -7 * width, 13 * width);
  for (int i = 0; i < 1000; ++i) targets.col(i) = (targets.col(i) / 10 + sources.col(i % count)).eval();
  const fgtd::TensorGrid grid = naive::cube_grid<d>(d == 1   ? 300
                                                    : d == 2 ? 31
                                                    : d == 3 ? 11
                                                             : 5,
                                                    -7 * width, 13 * width);
  const fgtd::Points<d> grid_points = naive::points_of<d>(grid);
  const Eigen::MatrixXd one_hot = Eigen::MatrixXd::Identity(count, count);
  for (const double tolerance : tolerances)
    for (const auto& alphas : orders) {
      int order = 0;
      for (const auto& alpha : alphas) {
        int sum = 0;
        for (const int a : alpha) sum += a;
        order = std::max(order, sum);
      }
      const fgtd::Plan<d> plan = chebyshev<d>(sources, one_hot, sigma, tolerance, order);
      ASSERT_EQ(plan.choice().method, fgtd::Method::chebyshev);
      EXPECT_LE(plan.choice().bound.value(), tolerance);
      double most = 0;
      for (const auto& alpha : alphas) {
        const double at_points =
            worst_ratio<d>(sources, sigma, targets, plan.evaluate(targets, alpha), alpha, tolerance);
        EXPECT_LE(at_points, 1.0) << "points, tolerance " << tolerance << ", order " << order << ": " << plan.choice();
        EXPECT_LE(worst_ratio<d>(sources, sigma, grid_points, plan.evaluate(grid, alpha), alpha, tolerance), 1.0)
            << "grid, tolerance " << tolerance << ", order " << order << ": " << plan.choice();
        most = std::max(most, at_points);
      }
      if (slack != nullptr) {
        slack->log_sum += std::log(most);
        ++slack->count;
      }
    }
}

template <int d>
std::vector<fgtd::Derivative<d>> up_to(int order) {
  std::vector<fgtd::Derivative<d>> list;
  for (int m = 0; m <= order; ++m)
    for (const auto& alpha : naive::derivatives_of_order<d>(m)) list.push_back(alpha);
  return list;
}

template <class T>
class Chebyshev : public testing::Test {};
using Dimensions = testing::Types<naive::Dimension<1>, naive::Dimension<2>, naive::Dimension<3>, naive::Dimension<4>>;
TYPED_TEST_SUITE(Chebyshev, Dimensions);

template <int d>
fgtd::TensorGrid small_grid(double low, double high) {
  return naive::cube_grid<d>(d == 1 ? 301 : d == 2 ? 33 : d == 3 ? 11 : 5, low, high);
}

TYPED_TEST(Chebyshev, EqualsDirectForUniformSources) {
  constexpr int d = TypeParam::value;
  const int count = d == 4 ? 200 : 600;
  expect_equal<d>(naive::random_points<d>(count, 11), naive::random_weights(count, 2, 12), d < 3 ? 60.0 : 6.0,
                  naive::random_points<d>(150, 13, -0.4, 1.4), small_grid<d>(-0.4, 1.4), d == 4 ? 1e-5 : 1e-9,
                  up_to<d>(d == 4 ? 2 : 4), d == 4 ? 2 : 4);
}

TYPED_TEST(Chebyshev, EqualsDirectForClusteredSources) {
  constexpr int d = TypeParam::value;
  auto sources = naive::random_points<d>(120, 14);
  for (int j = 0; j < 120; ++j)
    sources.col(j) = (sources.col(j) * (j % 3 == 0 ? 1e-3 : 0.05)).array() + (j % 2 == 0 ? 0.0 : 0.9);
  expect_equal<d>(sources, naive::random_weights(120, 1, 15), 25.0, naive::random_points<d>(100, 16, -0.2, 1.2),
                  small_grid<d>(-0.2, 1.2), 1e-6, up_to<d>(2), 2);
}

TYPED_TEST(Chebyshev, EqualsDirectForTinyClustersBesideOutliers) {
  constexpr int d = TypeParam::value;
  auto sources = naive::random_points<d>(80, 31, 0, 1e-7);
  for (int j = 0; j < 4; ++j) sources.col(j).setConstant(1e3 * (j - 2));
  const fgtd::Points<d> targets = sources;
  fgtd::TensorGrid grid{std::vector<std::vector<double>>(d, {-2000, -1, 0, 3e-8, 1e-7, 0.5, 1000})};
  expect_equal<d>(sources, naive::random_weights(80, 1, 32), 10.0, targets, grid, 1e-7, up_to<d>(1), 1);
}

TYPED_TEST(Chebyshev, EqualsDirectOnADiagonalAndOnFaces) {
  constexpr int d = TypeParam::value;
  fgtd::Points<d> sources(d, 200);
  for (int j = 0; j < 200; ++j) sources.col(j).setConstant(j / 199.0);
  expect_equal<d>(sources, naive::random_weights(200, 1, 33), 400.0, sources, small_grid<d>(0, 1), 1e-6, up_to<d>(1),
                  1);
  const fgtd::Points<d> lattice = naive::points_of<d>(naive::cube_grid<d>(d < 3 ? 9 : 5, 0, 1));
  expect_equal<d>(lattice, Eigen::MatrixXd::Ones(lattice.cols(), 1), 20.0, lattice, small_grid<d>(0, 1), 1e-6,
                  up_to<d>(1), 1);
}

TYPED_TEST(Chebyshev, EqualsDirectForEqualPointsAndForOne) {
  constexpr int d = TypeParam::value;
  const auto targets = naive::random_points<d>(60, 22, -1, 2);
  for (const int count : {1, 2, 300}) {
    const fgtd::Points<d> sources = fgtd::Points<d>::Constant(d, count, 0.3);
    expect_equal<d>(sources, Eigen::MatrixXd::Ones(count, 1), 5.0, targets, small_grid<d>(-1, 2), 1e-10, up_to<d>(2),
                    2);
  }
}

TYPED_TEST(Chebyshev, EqualsDirectFarFromTheOrigin) {
  constexpr int d = TypeParam::value;
  auto sources = naive::random_points<d>(100, 34), targets = naive::random_points<d>(100, 35, -0.5, 1.5);
  sources.array() += 1e6;
  targets.array() += 1e6;
  expect_equal<d>(sources, naive::random_weights(100, 1, 36), 3.0, targets, small_grid<d>(1e6 - 1, 1e6 + 2), 1e-12,
                  up_to<d>(1), 1);
}

TYPED_TEST(Chebyshev, ReturnsExactZerosFarOutsideTheSources) {
  constexpr int d = TypeParam::value;
  const fgtd::Plan<d> plan =
      chebyshev<d>(naive::random_points<d>(50, 20), naive::random_weights(50, 1, 21), 100.0, 1e-6, 2);
  ASSERT_EQ(plan.choice().method, fgtd::Method::chebyshev);
  for (const double far : {20.0, 1e6, 1e18, 1e300})
    for (const double sign : {-1.0, 1.0}) {
      const fgtd::Points<d> targets = fgtd::Points<d>::Constant(d, 3, sign * far);
      EXPECT_EQ(plan.evaluate(targets), Eigen::MatrixXd::Zero(3, 1)) << far;
      const fgtd::TensorGrid grid{std::vector<std::vector<double>>(d, {-far, far})};
      EXPECT_EQ(plan.evaluate(grid).cwiseAbs().maxCoeff(), 0.0) << far;
    }
}

TYPED_TEST(Chebyshev, TakesNewWeightsAndManyOutputsAtOnce) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(100, 41), targets = naive::random_points<d>(70, 42);
  const auto weights = naive::random_weights(100, 3, 43);
  fgtd::Plan<d> plan = chebyshev<d>(sources, naive::random_weights(100, 1, 44), 8.0, 1e-8, 2);
  plan.set_weights(weights);
  auto combinations = naive::value_and_gradient<d>();
  combinations.push_back(naive::laplacian<d>());
  combinations.push_back({});
  const fgtd::Plan<d> direct(sources, weights, 8.0, {.derivative_order = 2, .method = fgtd::Method::direct});
  const fgtd::Derivative<d> second{2};
  // the scale of the Laplacian is the largest
  const double allowed =
      1e-8 * d * fgtd::derivative_scale<d>(second, 8.0) * weights.cwiseAbs().colwise().sum().maxCoeff();
  const fgtd::TensorGrid grid = small_grid<d>(0, 1);
  EXPECT_LE((plan.evaluate_combinations(targets, combinations) - direct.evaluate_combinations(targets, combinations))
                .cwiseAbs()
                .maxCoeff(),
            allowed);
  EXPECT_LE((plan.evaluate_combinations(grid, combinations) - direct.evaluate_combinations(grid, combinations))
                .cwiseAbs()
                .maxCoeff(),
            allowed);
}

TYPED_TEST(Chebyshev, DoesNotDependOnThreads) {
  constexpr int d = TypeParam::value;
  const int count = 40000;  // several pieces of work share boxes
  const auto sources = naive::random_points<d>(count, 45), targets = naive::random_points<d>(9000, 46, -0.2, 1.2);
  const auto weights = naive::random_weights(count, 2, 47);
  const auto combinations = naive::value_and_gradient<d>();
  const fgtd::TensorGrid grid = small_grid<d>(-0.2, 1.2);
  Eigen::MatrixXd at_points, on_grid;
  for (const int threads : {1, 2, 4}) {
    const fgtd::Plan<d> plan = chebyshev<d>(sources, weights, 3.0, d == 4 ? 1e-3 : 1e-6, 1, threads);
    const Eigen::MatrixXd points = plan.evaluate_combinations(targets, combinations),
                          nodes = plan.evaluate_combinations(grid, combinations);
    if (threads == 1) {
      at_points = points;
      on_grid = nodes;
    }
    EXPECT_EQ(points, at_points) << threads;
    EXPECT_EQ(nodes, on_grid) << threads;
  }
}

TEST(ChebyshevSigma, EqualsDirectFromTinyToHuge) {
  const auto sources = naive::random_points<2>(400, 51);
  for (double sigma = 1e-8; sigma < 2e6; sigma *= 10) {
    auto targets = naive::random_points<2>(300, 52);
    for (int i = 0; i < 100; ++i)
      targets.col(i) = sources.col(i) + targets.col(i) * std::min(1.0, 1 / std::sqrt(sigma));
    for (const double tolerance : {1e-3, 1e-8, 1e-13})
      expect_equal<2>(sources, naive::random_weights(400, 1, 53), sigma, targets, naive::cube_grid<2>(13, 0, 1),
                      tolerance, up_to<2>(1), 1);
  }
}

TEST(ChebyshevDerivatives, OfHighOrderEqualDirect) {
  const auto sources = naive::random_points<2>(200, 54), targets = naive::random_points<2>(200, 55, -0.5, 1.5);
  const std::vector<fgtd::Derivative<2>> alphas{{8, 0}, {5, 5}, {0, 12}, {3, 2}};
  for (const double tolerance : {1e-2, 1e-7, 1e-13})
    expect_equal<2>(sources, naive::random_weights(200, 1, 56), 30.0, targets, naive::cube_grid<2>(21, -0.5, 1.5),
                    tolerance, alphas, 12);
}

const std::vector<double> all_tolerances = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13};

template <int d>
std::vector<std::vector<fgtd::Derivative<d>>> each_order_to(int highest) {
  std::vector<std::vector<fgtd::Derivative<d>>> list;
  for (int m = 0; m <= highest; ++m) list.push_back(naive::derivatives_of_order<d>(m));
  return list;
}

TEST(ChebyshevPromise, IsKeptByEveryTermAndNotWasted) {
  Slack slack;
  expect_promise<1>(all_tolerances, each_order_to<1>(4), &slack);
  expect_promise<2>(all_tolerances, each_order_to<2>(4), &slack);
  expect_promise<3>({1e-2, 1e-5, 1e-9, 1e-13}, each_order_to<3>(2), &slack);
  // on geometric average not more than a hundred times better than asked for
  EXPECT_GE(std::exp(slack.log_sum / slack.count), 0.01);
}

TEST(ChebyshevPromise, IsKeptByEveryTermOfOthers) {
  expect_promise<3>({1e-2, 1e-7}, {naive::derivatives_of_order<3>(4)});
  expect_promise<4>({1e-2, 1e-6}, each_order_to<4>(1));
  expect_promise<2>({1e-2, 1e-4, 1e-7, 1e-10, 1e-13}, {{{8, 0}, {0, 8}}, {{5, 5}}, {{0, 12}}});
  expect_promise<1>({1e-2, 1e-4, 1e-7, 1e-10, 1e-13}, {{{12}}});
  expect_promise<1>({1e-4, 1e-7, 1e-10, 1e-13}, {{{16}}});
}

TEST(ChebyshevError, IsNoLessThanWhatItBounds) {
  // more nodes, narrower boxes: less error; the widest side is as wide as it may be
  EXPECT_GT(fgtd::detail::interpolation_error(2, 1.0, 4, 0), fgtd::detail::interpolation_error(2, 1.0, 5, 0));
  EXPECT_GT(fgtd::detail::interpolation_error(2, 1.0, 4, 3), fgtd::detail::interpolation_error(2, 0.9, 4, 3));
  for (const int p : {2, 5, 8}) {
    const double side = fgtd::detail::widest_side(3, p, 4.0, 1e-6, 2);
    EXPECT_LE(fgtd::detail::interpolation_error(3, side, p, 2), 1e-6);
    EXPECT_GT(fgtd::detail::interpolation_error(3, 1.001 * side, p, 2), 1e-6);
  }
}

}  // namespace
