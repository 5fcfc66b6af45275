// `outer_product` against `direct` and against its promise: tensor grids of every kind.
#include <gtest/gtest.h>

#include "oracle/promise.hpp"

namespace {

template <class T>
class Outer : public testing::Test {};
using Dimensions = testing::Types<naive::Dimension<1>, naive::Dimension<2>, naive::Dimension<3>, naive::Dimension<4>>;
TYPED_TEST_SUITE(Outer, Dimensions);

template <int d>
constexpr int grid_nodes = d == 1   ? 700
                           : d == 2 ? 45
                           : d == 3 ? 13
                                    : 7;

/// Graded nodes, another number of them on every axis.
template <int d>
fgtd::TensorGrid graded_grid(double low, double high) {
  fgtd::TensorGrid grid;
  for (int l = 0; l < d; ++l) {
    std::vector<double> axis = naive::nodes(grid_nodes<d> + 3 * l, 0, 1);
    for (double& node : axis) node = low + (high - low) * node * (0.2 + 0.8 * node);
    grid.axes.push_back(axis);
  }
  return grid;
}

/// Largest difference to `direct` on the grid over all derivatives of some orders, in units of what is promised.
template <int d>
void expect_equal(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights, double sigma,
                  const fgtd::TensorGrid& grid, double tolerance, const std::vector<int>& orders) {
  double weight = 0;
  for (Eigen::Index k = 0; k < weights.cols(); ++k) weight = std::max(weight, weights.col(k).cwiseAbs().sum());
  for (const int order : orders) {
    const fgtd::Plan<d> direct(sources, weights, sigma, {.derivative_order = order, .method = fgtd::Method::direct});
    const fgtd::Plan<d> outer(sources, weights, sigma,
                              {.tolerance = tolerance,
                               .derivative_order = order,
                               .method = fgtd::Method::outer_product,
                               .expected_grid = grid});
    ASSERT_EQ(outer.choice().method, fgtd::Method::outer_product);
    ASSERT_LE(outer.choice().bound.value(), tolerance);
    for (const auto& alpha : naive::derivatives_of_order<d>(order)) {
      const double allowed =
          (tolerance + 3e-14) * fgtd::derivative_scale<d>(alpha, sigma) * weight;  // the promise, with its rounding
      EXPECT_LE((direct.evaluate(grid, alpha) - outer.evaluate(grid, alpha)).cwiseAbs().maxCoeff(), allowed)
          << naive::name_of<d>(alpha) << ", " << outer.choice();
    }
    if (order < 2) continue;
    auto combinations = naive::value_and_gradient<d>();
    combinations.push_back(naive::laplacian<d>());
    combinations.push_back({});
    combinations.back().push_back(combinations[1][0]);  // a derivative and the value in one sum
    combinations.back().push_back({{}, -3.0});
    combinations.push_back({});
    fgtd::Derivative<d> second{};
    second[0] = 2;
    // The Laplacian's scale or three times the value's, the largest
    const double allowed = (tolerance + 3e-14) * weight *
                           (3 + d * fgtd::derivative_scale<d>(second, sigma) + fgtd::derivative_scale<d>({1}, sigma));
    EXPECT_LE((direct.evaluate_combinations(grid, combinations) - outer.evaluate_combinations(grid, combinations))
                  .cwiseAbs()
                  .maxCoeff(),
              allowed);
  }
}

TYPED_TEST(Outer, EqualsDirectOnUniformGrids) {
  constexpr int d = TypeParam::value;
  const auto grid = naive::cube_grid<d>(grid_nodes<d>, -0.3, 1.2);
  for (const double sigma : {0.5, 60.0, 3e3, 1e6})
    expect_equal<d>(naive::random_points<d>(300, 231), naive::random_weights(300, 2, 232), sigma, grid, 1e-9,
                    {0, 1, 2, 3, 4});
}

TYPED_TEST(Outer, EqualsDirectOnGradedGrids) {
  constexpr int d = TypeParam::value;
  for (const double tolerance : {1e-2, 1e-5, 1e-8, 1e-11, 1e-13})
    expect_equal<d>(naive::random_points<d>(400, 233), naive::random_weights(400, 1, 234), 90.0,
                    graded_grid<d>(-0.5, 1.4), tolerance, {0, 2});
}

TYPED_TEST(Outer, EqualsDirectOnGridsOfOneNodeAndOutside) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(200, 235);
  const auto weights = naive::random_weights(200, 1, 236);
  fgtd::TensorGrid grid{std::vector<std::vector<double>>(d, {0.4})};
  expect_equal<d>(sources, weights, 50.0, grid, 1e-9, {0, 1});
  grid.axes[0] = {-1e9, -0.2, 0.1, 0.11, 0.9, 5, 1e200};
  expect_equal<d>(sources, weights, 50.0, grid, 1e-9, {0, 2});
  grid.axes[d - 1] = {1.1, 7};
  expect_equal<d>(sources, weights, 50.0, grid, 1e-9, {0, 2});
  grid.axes[d - 1] = {-3e7};
  expect_equal<d>(sources, weights, 50.0, grid, 1e-9, {0});
}

TYPED_TEST(Outer, EqualsDirectForSingleHighDerivatives) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(100, 237);
  const auto weights = naive::random_weights(100, 2, 238);
  const auto grid = graded_grid<d>(-0.1, 1.1);
  const fgtd::Points<d> nodes = naive::points_of<d>(grid);
  std::vector<fgtd::Derivative<d>> alphas(3);
  alphas[0][0] = 8;
  alphas[1][0] = alphas[1][d - 1] = 5;
  alphas[2][d - 1] = 12;
  const fgtd::Options options{
      .tolerance = 1e-8, .derivative_order = 12, .method = fgtd::Method::outer_product, .expected_grid = grid};
  for (const double sigma : {5.0, 500.0}) {
    const fgtd::Plan<d> outer(sources, weights, sigma, options);
    const fgtd::Plan<d> direct(sources, weights, sigma, {.derivative_order = 12, .method = fgtd::Method::direct});
    for (const auto& alpha : alphas)
      EXPECT_LE((outer.evaluate(grid, alpha) - direct.evaluate(grid, alpha)).cwiseAbs().maxCoeff(),
                1e-8 * fgtd::derivative_scale<d>(alpha, sigma) * weights.cwiseAbs().sum());  // the promise
  }
}

TYPED_TEST(Outer, KeepsThePromiseOfEveryTerm) {
  constexpr int d = TypeParam::value;
  naive::Scene<d> scene{"outer", 7.0, naive::random_points<d>(300, 239, 0, d < 3 ? 6.0 : 2.5), {}, {}, {}};
  scene.watch(6);
  scene.grid = graded_grid<d>(-2, 8);
  const fgtd::Points<d> nodes = naive::points_of<d>(scene.grid);
  naive::ExactTerms<d> exact(scene, nodes);
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-11, 1e-12, 1e-13})
    for (const int order : {0, 1, 4}) {
      if (d == 4 && order == 4) continue;  // as in d = 3
      const fgtd::Plan<d> plan(scene.sources, scene.weights(), scene.sigma,
                               {.tolerance = tolerance,
                                .derivative_order = order,
                                .method = fgtd::Method::outer_product,
                                .expected_grid = scene.grid});
      for (const auto& alpha : naive::derivatives_of_order<d>(order)) {
        const auto errors = naive::measure<d>(exact, plan.evaluate(scene.grid, alpha), scene.sigma, tolerance, alpha);
        EXPECT_LE(errors.of_promise, 1.0) << tolerance << ", " << naive::name_of<d>(alpha) << ", " << errors.where;
      }
    }
}

TYPED_TEST(Outer, EqualsDirectForClustersBesideOutliersAndEqualPoints) {
  constexpr int d = TypeParam::value;
  fgtd::Points<d> sources = naive::random_points<d>(300, 241);
  for (int j = 0; j < 300; ++j) {
    if (j % 3 == 0) sources.col(j) = (sources.col(j) * 1e-7).array() + 0.25;
    if (j % 3 == 1) sources.col(j) *= 1e3;
    if (j > 200) sources.col(j).setConstant(0.25);
  }
  fgtd::TensorGrid grid = naive::cube_grid<d>(d < 3 ? 30 : 5, 0.25 - 1e-7, 0.25 + 2e-7);
  for (auto& axis : grid.axes) axis.insert(axis.end(), {0.5, 3.0, 900.0});
  for (const double sigma : {1e-4, 1.0, 1e6, 1e12, 1e16})
    expect_equal<d>(sources, naive::random_weights(300, 1, 242), sigma, grid, 1e-10, {0, 2});
}

TYPED_TEST(Outer, EqualsDirectForEverySigmaOnTheUnitCube) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(100, 243);
  for (double sigma = 1e-8; sigma < 2e14; sigma *= 100) {
    fgtd::TensorGrid grid;
    for (int l = 0; l < d; ++l)
      grid.axes.push_back(naive::nodes(9, sources(l, 7) - 4 / std::sqrt(sigma), sources(l, 7) + 4 / std::sqrt(sigma)));
    expect_equal<d>(sources, naive::random_weights(100, 1, 244), sigma, grid, 1e-7, {0, 1});
  }
}

TYPED_TEST(Outer, GivesTheSameForAnyNumberOfThreads) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(3000, 245);
  const auto weights = naive::random_weights(3000, 2, 246);
  const auto grid = naive::cube_grid<d>(grid_nodes<d>, -0.2, 1.2);
  Eigen::MatrixXd once;
  for (const int threads : {1, 2, 3, 4}) {
    const fgtd::Plan<d> plan(
        sources, weights, 300.0,
        {.derivative_order = 2, .method = fgtd::Method::outer_product, .threads = threads, .expected_grid = grid});
    auto combinations = naive::value_and_gradient<d>();
    combinations.push_back(naive::laplacian<d>());
    const Eigen::MatrixXd values = plan.evaluate_combinations(grid, combinations);
    if (threads == 1) once = values;
    EXPECT_EQ(values, once) << threads << " threads";
  }
}

TYPED_TEST(Outer, ServesScatteredTargetsToo) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(300, 247), targets = naive::random_points<d>(200, 248, -0.3, 1.3);
  const auto weights = naive::random_weights(300, 2, 249);
  const fgtd::Plan<d> plan(sources, weights, 200.0,
                           {.tolerance = 1e-9,
                            .derivative_order = 1,
                            .method = fgtd::Method::outer_product,
                            .expected_grid = naive::cube_grid<d>(grid_nodes<d>, 0, 1)});
  for (const auto& alpha : naive::derivatives_of_order<d>(1))
    EXPECT_LE(
        (plan.evaluate(targets, alpha) - naive::sum<d>(sources, weights, 200.0, targets, alpha)).cwiseAbs().maxCoeff(),
        300 * 1e-9 * fgtd::derivative_scale<d>(alpha, 200.0));  // the promise, weights below 1
}

TEST(OuterSum, CrossesWindowsLongerThanABlock) {
  const auto sources = naive::random_points<2>(100, 250);
  const auto weights = naive::random_weights(100, 1, 251);
  fgtd::TensorGrid grid{{naive::nodes(700, -1, 2), naive::nodes(5, 0, 1)}};
  expect_equal<2>(sources, weights, 3.0, grid, 1e-8, {0, 2});
  std::swap(grid.axes[0], grid.axes[1]);
  expect_equal<2>(sources, weights, 3.0, grid, 1e-8, {0, 2});
}

TEST(OuterSum, IsChosenForFewParticlesOnAGrid) {
  const auto sources = naive::random_points<2>(300, 252, -0.25, 0.25);
  const auto grid = naive::cube_grid<2>(200, -1, 1);
  const fgtd::Plan<2> plan(sources, Eigen::MatrixXd::Ones(300, 1), 5600.0, {.expected_grid = grid});
  EXPECT_EQ(plan.choice().method, fgtd::Method::outer_product);
}

}  // namespace
