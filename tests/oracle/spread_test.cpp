// `spread` against `direct`: everything it does must be the same sum; and its promise, term by term.
#include <gtest/gtest.h>

#include "fgtd/spread/filter.hpp"
#include "oracle/naive.hpp"

namespace {

fgtd::Options spread_options(double tolerance, int order) {
  return {.tolerance = tolerance, .derivative_order = order, .method = fgtd::Method::spread, .threads = 1};
}

/// Largest difference between the methods over everything that can be evaluated is within the promise.
template <int d>
void expect_equal(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights, double sigma,
                  const fgtd::Points<d>& targets, const fgtd::TensorGrid& grid, double tolerance, int order) {
  const fgtd::Plan<d> direct(sources, weights, sigma, {.derivative_order = order, .method = fgtd::Method::direct});
  const fgtd::Plan<d> spread(sources, weights, sigma, spread_options(tolerance, order));
  ASSERT_EQ(spread.choice().method, fgtd::Method::spread);
  ASSERT_LE(spread.choice().bound.value(), tolerance);
  double weight = 0;
  for (Eigen::Index k = 0; k < weights.cols(); ++k) weight = std::max(weight, weights.col(k).cwiseAbs().sum());
  double scale = 1;
  for (int m = 0; m <= order; ++m)
    for (const auto& alpha : naive::derivatives_of_order<d>(m)) {
      scale = std::max(scale, fgtd::derivative_scale<d>(alpha, sigma));
      const double allowed =
          (tolerance + 3e-14) * fgtd::derivative_scale<d>(alpha, sigma) * weight;  // the promise, with its rounding
      EXPECT_LE((direct.evaluate(targets, alpha) - spread.evaluate(targets, alpha)).cwiseAbs().maxCoeff(), allowed)
          << spread.choice();
      EXPECT_LE((direct.evaluate(grid, alpha) - spread.evaluate(grid, alpha)).cwiseAbs().maxCoeff(), allowed)
          << spread.choice();
    }
  if (order < 2) return;
  auto combinations = naive::value_and_gradient<d>();
  combinations.push_back(naive::laplacian<d>());
  combinations.push_back({});
  const double allowed = d * (tolerance + 3e-14) * scale * weight;  // that of the Laplacian, the largest
  EXPECT_LE((direct.evaluate_combinations(targets, combinations) - spread.evaluate_combinations(targets, combinations))
                .cwiseAbs()
                .maxCoeff(),
            allowed);
  EXPECT_LE((direct.evaluate_combinations(grid, combinations) - spread.evaluate_combinations(grid, combinations))
                .cwiseAbs()
                .maxCoeff(),
            allowed);
}

template <class T>
class Spread : public testing::Test {};
using Dimensions = testing::Types<naive::Dimension<1>, naive::Dimension<2>, naive::Dimension<3>, naive::Dimension<4>>;
TYPED_TEST_SUITE(Spread, Dimensions);

template <int d>
fgtd::TensorGrid usual_grid() {
  constexpr int nodes[] = {301, 33, 11, 5};
  return naive::cube_grid<d>(nodes[d - 1], -0.4, 1.4);
}

TYPED_TEST(Spread, EqualsDirectForUniformSources) {
  constexpr int d = TypeParam::value;
  const int count = d == 4 ? 100 : 400;
  expect_equal<d>(naive::random_points<d>(count, 11), naive::random_weights(count, 2, 12), d < 3 ? 60.0 : 6.0,
                  naive::random_points<d>(150, 13, -0.4, 1.4), usual_grid<d>(), d == 4 ? 1e-4 : 1e-8, d == 4 ? 2 : 3);
}

TYPED_TEST(Spread, EqualsDirectForManySourcesInManyTiles) {
  constexpr int d = TypeParam::value;
  if (d == 4) return;
  const double sigma = d == 1 ? 1e8 : d == 2 ? 4e3 : 150;  // 60 to 10^4 widths an axis
  expect_equal<d>(naive::random_points<d>(4000, 31), naive::random_weights(4000, 1, 32), sigma,
                  naive::random_points<d>(500, 33, -0.1, 1.1), usual_grid<d>(), 1e-6, 1);
}

TYPED_TEST(Spread, EqualsDirectForClusteredSources) {
  constexpr int d = TypeParam::value;
  auto sources = naive::random_points<d>(120, 14);
  for (int j = 0; j < 120; ++j)
    sources.col(j) = (sources.col(j) * (j % 3 == 0 ? 1e-3 : 0.05)).array() + (j % 2 == 0 ? 0.0 : 0.9);
  expect_equal<d>(sources, naive::random_weights(120, 1, 15), 25.0, naive::random_points<d>(100, 16, -0.2, 1.2),
                  usual_grid<d>(), d == 4 ? 1e-3 : 1e-6, 2);
}

TYPED_TEST(Spread, EqualsDirectOnGridsOfEveryShape) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(200, 34);
  const auto weights = naive::random_weights(200, 1, 35);
  const double sigma = d < 3 ? 300.0 : 10.0;
  const fgtd::Points<d> target = fgtd::Points<d>::Constant(d, 1, 0.5);
  naive::Random random(36);
  fgtd::TensorGrid uneven, partly, single;
  for (int l = 0; l < d; ++l) {
    // clustered, dense and far apart nodes on one axis
    std::vector<double> nodes{-1e300, -1e3, -7, -0.3};
    for (int i = 0; i < (d < 3 ? 40 : 5); ++i) nodes.push_back(nodes.back() + 0.06 * random() * random());
    nodes.insert(nodes.end(), {0.95, 1.05, 9.0, 1e5, 1e18, 1e300});
    uneven.axes.push_back(nodes);
    partly.axes.push_back(naive::nodes(d < 3 ? 50 : 6, 0.6, 4.0));
    single.axes.push_back({0.1 + 0.2 * l});
  }
  for (const auto& grid : {uneven, partly, single}) expect_equal<d>(sources, weights, sigma, target, grid, 1e-7, 1);
}

TYPED_TEST(Spread, EqualsDirectForOneSourceAndForCoincidingSources) {
  constexpr int d = TypeParam::value;
  const fgtd::Points<d> one = fgtd::Points<d>::Constant(d, 1, 0.3), many = fgtd::Points<d>::Constant(d, 200, 0.3);
  const auto targets = naive::random_points<d>(40, 22);
  expect_equal<d>(one, Eigen::MatrixXd::Constant(1, 1, 200.0), 5.0, targets, usual_grid<d>(), 1e-10, 1);
  expect_equal<d>(many, Eigen::MatrixXd::Ones(200, 1), 5.0, targets, usual_grid<d>(), 1e-10, 1);
}

TYPED_TEST(Spread, IsExactlyZeroFarOutsideTheSources) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(50, 20);
  const fgtd::Plan<d> plan(sources, naive::random_weights(50, 1, 21), 100.0, spread_options(1e-6, 2));
  ASSERT_EQ(plan.choice().method, fgtd::Method::spread);
  for (const double far : {20.0, 1e6, 1e18, 1e300})
    for (const double sign : {-1.0, 1.0}) {
      const fgtd::Points<d> targets = fgtd::Points<d>::Constant(d, 3, sign * far);
      EXPECT_EQ(plan.evaluate(targets), Eigen::MatrixXd::Zero(3, 1)) << far;
      const fgtd::TensorGrid grid{std::vector<std::vector<double>>(d, {-far, far})};
      EXPECT_EQ(plan.evaluate(grid).cwiseAbs().maxCoeff(), 0.0) << far;
    }
}

TYPED_TEST(Spread, TakesNewWeightsAndAnyNumberOfColumns) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(100, 37), targets = naive::random_points<d>(30, 38);
  fgtd::Plan<d> plan(sources, naive::random_weights(100, 1, 39), 8.0, spread_options(1e-9, 0));
  for (const int columns : {3, 0, 1}) {
    const auto weights = naive::random_weights(100, columns, 40);
    plan.set_weights(weights);
    const Eigen::MatrixXd values = plan.evaluate(targets);
    ASSERT_EQ(values.cols(), columns);
    if (columns == 0) continue;
    EXPECT_LE((values - naive::sum<d>(sources, weights, 8.0, targets)).cwiseAbs().maxCoeff(), 100 * 1e-9);
  }
}

TEST(SpreadSum, KeepsTheLatticeSmallForClustersAndFarOutliers) {
  // Clusters a few widths wide beside outliers at a thousand: a lattice over all of it would have 10^13 nodes.
  auto sources = naive::random_points<3>(3000, 41, 0, 0.01);
  for (int j = 0; j < 3000; j += 3) sources.col(j).array() += 5;
  sources.col(7) << 1000, -1000, 3;
  sources.col(8) << -1000, 1000, 1000;
  sources.col(9) << 5, 900, -900;
  const auto weights = naive::random_weights(3000, 1, 42);
  const double sigma = 4e4;  // width 0.005
  auto options = spread_options(1e-6, 1);
  options.memory_limit = 30 << 20;
  const fgtd::Plan<3> plan(sources, weights, sigma, options);
  ASSERT_EQ(plan.choice().method, fgtd::Method::spread);
  EXPECT_LE(std::get<fgtd::Spread>(plan.choice().parameters).bricks, 5u);  // two clusters and three outliers
  fgtd::Points<3> targets(3, 60);
  for (int j = 0; j < 60; ++j) targets.col(j) = sources.col(j).array() + 0.003;
  EXPECT_LE((plan.evaluate(targets) - naive::sum<3>(sources, weights, sigma, targets)).cwiseAbs().maxCoeff(),
            1e-6 * weights.cwiseAbs().sum());
  fgtd::TensorGrid grid{{{-1000, 0.002, 0.004, 1000.001}, {-1000, 0.003, 0.008, 900}, {-900, 0.001, 0.006, 3}}};
  EXPECT_LE(
      (plan.evaluate(grid) - naive::sum<3>(sources, weights, sigma, naive::points_of<3>(grid))).cwiseAbs().maxCoeff(),
      1e-6 * weights.cwiseAbs().sum());
}

TEST(SpreadSum, GivesWayWhereALatticeIsNotJustified) {
  const auto sources = naive::random_points<3>(1000, 43);
  for (const double sigma : {1e10, 1e14, 1e300}) {
    const fgtd::Plan<3> plan(sources, Eigen::MatrixXd::Ones(1000, 1), sigma, spread_options(1e-6, 0));
    EXPECT_EQ(plan.choice().method, fgtd::Method::direct) << sigma;
  }
  const fgtd::Points<2> far = naive::random_points<2>(50, 26).array() + 1e16;
  EXPECT_EQ(fgtd::Plan<2>(far, Eigen::MatrixXd::Ones(50, 1), 4.0, spread_options(1e-6, 0)).choice().method,
            fgtd::Method::direct);
  EXPECT_EQ(fgtd::Plan<2>(naive::random_points<2>(50, 26), Eigen::MatrixXd::Ones(50, 1), 4.0, spread_options(1e-14, 0))
                .choice()
                .method,
            fgtd::Method::direct);
  EXPECT_THROW(([&] {
                 auto options = spread_options(1e-6, 0);
                 options.memory_limit = 1 << 20;
                 fgtd::Plan<3>(naive::random_points<3>(20000, 44), Eigen::MatrixXd::Ones(20000, 1), 1e4, options);
               }()),
               fgtd::MemoryLimitError);
}

TEST(SpreadSum, IsRightFarFromTheOriginAndForVeryWideAndSharpGaussians) {
  for (const double offset : {0.0, 3.0, 1e9})
    for (const double sigma : {1e-8, 4.0, 1e3}) {
      const fgtd::Points<2> sources = naive::random_points<2>(60, 45).array() + offset,
                            targets = naive::random_points<2>(60, 46).array() + offset;
      const auto weights = naive::random_weights(60, 1, 47);
      const fgtd::Plan<2> plan(sources, weights, sigma, spread_options(1e-12, 0));
      ASSERT_EQ(plan.choice().method, fgtd::Method::spread);
      EXPECT_LE((plan.evaluate(targets) - naive::sum<2>(sources, weights, sigma, targets)).cwiseAbs().maxCoeff(),
                weights.cwiseAbs().sum() * (1e-12 + 3e-14))
          << offset << ' ' << sigma;
    }
}

TEST(SpreadSum, LosesNothingToALongLattice) {
  // 10^5 nodes from end to end: positions on the lattice keep all their digits
  const double sigma = 1e9;
  const auto sources = naive::random_points<1>(5000, 48), targets = naive::random_points<1>(400, 49);
  const auto weights = naive::random_weights(5000, 1, 50);
  const fgtd::Plan<1> plan(sources, weights, sigma, spread_options(1e-13, 0));
  ASSERT_EQ(plan.choice().method, fgtd::Method::spread);
  EXPECT_LE((plan.evaluate(targets) - naive::sum<1>(sources, weights, sigma, targets)).cwiseAbs().maxCoeff(),
            4 * (1e-13 + 3e-14));  // at most a few sources within reach
}

TEST(SpreadSum, DoesNotDependOnThreads) {
  const auto sources = naive::random_points<3>(5000, 61), targets = naive::random_points<3>(900, 62, -0.2, 1.2);
  const auto weights = naive::random_weights(5000, 2, 63);
  const auto grid = naive::cube_grid<3>(19, -0.2, 1.2);
  Eigen::MatrixXd at_points, on_grid;
  for (const int threads : {1, 2, 4}) {
    auto options = spread_options(1e-6, 2);
    options.threads = threads;
    const fgtd::Plan<3> plan(sources, weights, 400.0, options);
    ASSERT_EQ(plan.choice().method, fgtd::Method::spread);
    const Eigen::MatrixXd points = plan.evaluate_combinations(targets, naive::value_and_gradient<3>()),
                          nodes = plan.evaluate_combinations(grid, naive::value_and_gradient<3>());
    if (threads == 1) {
      at_points = points;
      on_grid = nodes;
    }
    EXPECT_EQ(points, at_points) << threads;
    EXPECT_EQ(nodes, on_grid) << threads;
  }
}

/// Largest error of single terms over what is promised for them (as in tests/tolerance), and the largest over
/// tolerance N_alpha: what is achieved.
struct Achieved {
  double promise = 0, error = 0;
};
template <int d>
Achieved measure(const fgtd::Points<d>& sources, double sigma, const fgtd::Points<d>& targets,
                 const Eigen::MatrixXd& values, const fgtd::Derivative<d>& alpha, double tolerance) {
  const double limit = 2 * std::log(1 / tolerance) + 40, scale = fgtd::derivative_scale<d>(alpha, sigma);
  Achieved worst;
  for (Eigen::Index j = 0; j < sources.cols(); ++j)
    for (Eigen::Index i = 0; i < targets.cols(); ++i) {
      const double exact = static_cast<double>(naive::term<d>(targets.col(i), sources.col(j), sigma, alpha));
      const double squared = sigma * (targets.col(i) - sources.col(j)).squaredNorm();
      const double promised = tolerance * scale * std::exp(std::min(0.0, limit - squared));
      const double rounding = squared <= limit ? 3e-14 * scale : 1e-12 * std::abs(exact);
      const double error = std::abs(values(i, j) - exact);
      worst.promise = std::max(worst.promise, error / (promised + rounding + 1e-300));
      worst.error = std::max(worst.error, error / (tolerance * scale));
    }
  return worst;
}

template <int d>
void expect_promise_kept(const std::vector<double>& tolerances, const std::vector<fgtd::Derivative<d>>& alphas) {
  const double sigma = 3.7, width = 1 / std::sqrt(sigma);
  const int count = d == 1 ? 24 : d == 2 ? 8 : 4;
  const fgtd::Points<d> sources = naive::random_points<d>(count, 51, 0, 3 * width);
  fgtd::Points<d> targets = naive::random_points<d>(d == 1 ? 400 : 250, 52, -8 * width, 11 * width);
  for (int j = 0; j < 125; ++j)
    targets.col(j) =
        sources.col(j % count) + naive::random_points<d>(1, 70 + static_cast<std::uint64_t>(j), -2 * width, 2 * width);
  const fgtd::TensorGrid grid = naive::cube_grid<d>(d == 1 ? 300 : d == 2 ? 31 : 11, -8 * width, 11 * width);
  const fgtd::Points<d> grid_points = naive::points_of<d>(grid);
  double logarithms = 0, measured = 0;
  for (const double tolerance : tolerances)
    for (const auto& alpha : alphas) {
      int order = 0;
      for (const int a : alpha) order += a;
      const fgtd::Plan<d> plan(sources, Eigen::MatrixXd::Identity(count, count), sigma,
                               spread_options(tolerance, order));
      ASSERT_EQ(plan.choice().method, fgtd::Method::spread) << tolerance << ' ' << order;
      const Achieved points = measure<d>(sources, sigma, targets, plan.evaluate(targets, alpha), alpha, tolerance),
                     nodes = measure<d>(sources, sigma, grid_points, plan.evaluate(grid, alpha), alpha, tolerance);
      EXPECT_LE(points.promise, 1) << "points, order " << order << ": " << plan.choice();
      EXPECT_LE(nodes.promise, 1) << "grid, order " << order << ": " << plan.choice();
      logarithms += std::log(std::max(points.error, nodes.error));
      ++measured;
    }
  EXPECT_GE(std::exp(logarithms / measured), 0.01);  // not wasted: within 100 of what was asked for on average
}

const std::vector<double> all_tolerances = {1e-2, 1e-3, 1e-4,  1e-5,  1e-6,  3e-7, 1e-7,
                                            1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13};

TEST(SpreadSum, KeepsThePromiseOfEveryTermInOneDimension) {
  expect_promise_kept<1>(all_tolerances, {{0}, {1}, {2}, {3}, {4}});
  expect_promise_kept<1>({1e-2, 1e-6, 1e-10, 1e-13}, {{8}, {12}});
  expect_promise_kept<1>({1e-4, 1e-6, 1e-10, 1e-13}, {{16}});
}
TEST(SpreadSum, KeepsThePromiseOfEveryTermInTwoDimensions) {
  expect_promise_kept<2>(all_tolerances, {{0, 0}, {0, 1}, {2, 0}, {1, 2}, {2, 2}});
  expect_promise_kept<2>({1e-3, 1e-7, 1e-12}, {{8, 0}, {5, 5}, {0, 12}});
}
TEST(SpreadSum, KeepsThePromiseOfEveryTermInThreeDimensions) {
  expect_promise_kept<3>({1e-2, 1e-5, 1e-9, 1e-13}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}, {1, 2, 1}});
}

TEST(SpreadFilter, IsMeasuredFinelyEnough) {
  // The largest error over a mesh of many more offsets stays within the bound, and is not far below it.
  for (const double tolerance : {1e-2, 1e-5, 1e-8, 1e-11})
    for (const int order : {0, 3}) {
      const int width = static_cast<int>(std::ceil(1.9 - std::log10(tolerance)));
      const auto filter = fgtd::detail::find_filter(1, width, order, tolerance);
      ASSERT_TRUE(filter);
      const double h = filter->spacing();
      fgtd::Points<1> source(1, 41);
      for (int i = 0; i < 41; ++i) source(0, i) = i * h / 41;
      double worst = 0;
      const fgtd::Plan<1> plan(source, Eigen::MatrixXd::Identity(41, 41), 1.0, spread_options(tolerance, order));
      const fgtd::TensorGrid grid{{naive::nodes(3001, -7, 7)}};
      const auto points = naive::points_of<1>(grid);
      for (int a = 0; a <= order; ++a)
        worst = std::max({worst, measure<1>(source, 1.0, points, plan.evaluate(grid, {a}), {a}, tolerance).error,
                          measure<1>(source, 1.0, points, plan.evaluate(points, {a}), {a}, tolerance).error});
      EXPECT_LE(worst * tolerance, plan.choice().bound.value());
      EXPECT_GE(worst * tolerance, 0.1 * plan.choice().bound.value());
    }
}

}  // namespace
