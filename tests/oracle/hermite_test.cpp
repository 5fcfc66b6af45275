// `hermite` against `direct`: everything it does must be the same sum.
#include <gtest/gtest.h>

#include "oracle/naive.hpp"

namespace {

/// Largest difference between the methods over everything that can be evaluated, in units of tolerance N_alpha Q.
template <int d>
void expect_equal(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights, double sigma,
                  const fgtd::Points<d>& targets, const fgtd::TensorGrid& grid, double tolerance, int order) {
  const fgtd::Plan<d> direct(sources, weights, sigma, {.derivative_order = order, .method = fgtd::Method::direct});
  const fgtd::Plan<d> hermite(sources, weights, sigma,
                              {.tolerance = tolerance, .derivative_order = order, .method = fgtd::Method::hermite});
  ASSERT_EQ(hermite.choice().method, fgtd::Method::hermite);
  ASSERT_LE(hermite.choice().bound.value(), tolerance);
  double weight = 0;
  for (Eigen::Index k = 0; k < weights.cols(); ++k) weight = std::max(weight, weights.col(k).cwiseAbs().sum());
  for (int m = 0; m <= order; ++m)
    for (const auto& alpha : naive::derivatives_of_order<d>(m)) {
      const double allowed =
          (tolerance + 3e-14) * fgtd::derivative_scale<d>(alpha, sigma) * weight;  // the promise, with its rounding
      EXPECT_LE((direct.evaluate(targets, alpha) - hermite.evaluate(targets, alpha)).cwiseAbs().maxCoeff(), allowed)
          << hermite.choice();
      EXPECT_LE((direct.evaluate(grid, alpha) - hermite.evaluate(grid, alpha)).cwiseAbs().maxCoeff(), allowed)
          << hermite.choice();
    }
  if (order < 2) return;
  auto combinations = naive::value_and_gradient<d>();
  combinations.push_back(naive::laplacian<d>());
  combinations.push_back({});
  fgtd::Derivative<d> second{};
  second[0] = 2;
  const double allowed = d * (tolerance + 3e-14) * fgtd::derivative_scale<d>(second, sigma) *
                         weight;  // the Laplacian's scale, the largest
  EXPECT_LE((direct.evaluate_combinations(targets, combinations) - hermite.evaluate_combinations(targets, combinations))
                .cwiseAbs()
                .maxCoeff(),
            std::max(allowed, weight * tolerance));
  EXPECT_LE((direct.evaluate_combinations(grid, combinations) - hermite.evaluate_combinations(grid, combinations))
                .cwiseAbs()
                .maxCoeff(),
            std::max(allowed, weight * tolerance));
}

template <class T>
class Hermite : public testing::Test {};
using Dimensions = testing::Types<naive::Dimension<1>, naive::Dimension<2>, naive::Dimension<3>, naive::Dimension<4>>;
TYPED_TEST_SUITE(Hermite, Dimensions);

TYPED_TEST(Hermite, EqualsDirectForUniformSources) {
  constexpr int d = TypeParam::value;
  const int count = d == 4 ? 100 : 400;
  expect_equal<d>(naive::random_points<d>(count, 11), naive::random_weights(count, 2, 12), d < 3 ? 60.0 : 6.0,
                  naive::random_points<d>(150, 13, -0.4, 1.4),
                  naive::cube_grid<d>(d == 1   ? 301
                                      : d == 2 ? 33
                                      : d == 3 ? 11
                                               : 5,
                                      -0.4, 1.4),
                  d == 4 ? 1e-4 : 1e-8, 2);
}

TYPED_TEST(Hermite, EqualsDirectForClusteredSources) {
  constexpr int d = TypeParam::value;
  auto sources = naive::random_points<d>(120, 14);
  for (int j = 0; j < 120; ++j)
    sources.col(j) = (sources.col(j) * (j % 3 == 0 ? 1e-3 : 0.05)).array() + (j % 2 == 0 ? 0.0 : 0.9);
  expect_equal<d>(sources, naive::random_weights(120, 1, 15), 25.0, naive::random_points<d>(100, 16, -0.2, 1.2),
                  naive::cube_grid<d>(d == 1   ? 100
                                      : d == 2 ? 20
                                               : 6,
                                      -0.2, 1.2),
                  d == 4 ? 1e-3 : 1e-6, 2);
}

TYPED_TEST(Hermite, EqualsDirectForSharpGaussiansWithMostlyEmptyBoxes) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(60, 17);
  auto targets = naive::random_points<d>(60, 18, -1e-4, 1e-4);
  targets += sources;
  fgtd::TensorGrid grid;
  for (int l = 0; l < d; ++l) grid.axes.push_back(naive::nodes(7, sources(l, 0) - 1e-4, sources(l, 0) + 1e-4));
  expect_equal<d>(sources, naive::random_weights(60, 1, 19), 1e8, targets, grid, 1e-5, d == 4 ? 0 : 2);
}

TYPED_TEST(Hermite, CountsPointsOnFacesOnceAndOnTheUpperCornerToo) {
  constexpr int d = TypeParam::value;
  const fgtd::HermiteParameters by_hand{
      .box_scale = 0.5, .expansion_order = 14, .neighbours = fgtd::HermiteParameters::all_boxes};
  const double sigma = 2.0;  // side 1/2: the lattice below lies on faces and corners of boxes
  const fgtd::TensorGrid lattice = naive::cube_grid<d>(d < 3 ? 5 : 3, 0, 1);
  const fgtd::Points<d> sources = naive::points_of<d>(lattice);
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(sources.cols(), 1);
  fgtd::Options options;
  options.hermite = by_hand;
  const fgtd::Plan<d> hermite(sources, weights, sigma, options);
  EXPECT_EQ(std::get<fgtd::Hermite>(hermite.choice().parameters).boxes, std::size_t{1} << d);
  const fgtd::Plan<d> direct(sources, weights, sigma, {.method = fgtd::Method::direct});
  const double allowed = hermite.choice().bound.value() * weights.sum();  // (3.5) with Q
  EXPECT_LE((direct.evaluate(sources) - hermite.evaluate(sources)).cwiseAbs().maxCoeff(), allowed);
  EXPECT_LE((direct.evaluate(lattice) - hermite.evaluate(lattice)).cwiseAbs().maxCoeff(), allowed);
}

TYPED_TEST(Hermite, ReturnsExactZerosFarOutsideTheSources) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(50, 20);
  const auto weights = naive::random_weights(50, 1, 21);
  const fgtd::Plan<d> plan(sources, weights, 100.0, {.derivative_order = 2, .method = fgtd::Method::hermite});
  for (const double far : {20.0, 1e6, 1e18, 1e300}) {
    for (const double sign : {-1.0, 1.0}) {
      const fgtd::Points<d> targets = fgtd::Points<d>::Constant(d, 3, sign * far);
      EXPECT_EQ(plan.evaluate(targets), Eigen::MatrixXd::Zero(3, 1)) << far;
      fgtd::TensorGrid grid{std::vector<std::vector<double>>(d, {-far, far})};
      EXPECT_EQ(plan.evaluate(grid).cwiseAbs().maxCoeff(), 0.0) << far;
    }
  }
}

TYPED_TEST(Hermite, NeighboursByHandAreTheThesissBoxes) {
  constexpr int d = TypeParam::value;
  // Sources in the middles of boxes 0 .. 4 of the first axis; with n = 1 a target in box 2 sees boxes 1, 2, 3 and no
  // others.
  const double sigma = 2.0, side = 0.25;
  fgtd::Points<d> sources = fgtd::Points<d>::Zero(d, 6);
  for (int j = 0; j < 5; ++j) sources(0, j) = (j + 0.5) * side;
  fgtd::Options options;
  options.hermite = fgtd::HermiteParameters{.box_scale = 0.25, .expansion_order = 12, .neighbours = 1};
  const Eigen::MatrixXd weights = (Eigen::VectorXd(6) << 1, 1, 1, 1, 1, 0).finished();
  const fgtd::Plan<d> plan(sources, weights, sigma, options);
  fgtd::Points<d> target = fgtd::Points<d>::Zero(d, 1);
  target(0, 0) = 2.3 * side;
  const Eigen::MatrixXd seen = naive::sum<d>(sources.middleCols(1, 3), Eigen::MatrixXd::Ones(3, 1), sigma, target);
  EXPECT_NEAR(plan.evaluate(target)(0, 0), seen(0, 0),
              2e-11);  // p = 12, r = 1/4: truncation below 1e-11 a term; measured 7e-12
  fgtd::TensorGrid grid{std::vector<std::vector<double>>(d, {0.0})};
  grid.axes[0] = {target(0, 0)};
  EXPECT_NEAR(plan.evaluate(grid)(0, 0), seen(0, 0), 2e-11);
}

TYPED_TEST(Hermite, WorksWithOneSourceAndWithCoincidingSources) {
  constexpr int d = TypeParam::value;
  const fgtd::Points<d> one = fgtd::Points<d>::Constant(d, 1, 0.3), many = fgtd::Points<d>::Constant(d, 200, 0.3);
  const auto targets = naive::random_points<d>(40, 22);
  const fgtd::Plan<d> single(one, Eigen::MatrixXd::Constant(1, 1, 200.0), 5.0,
                             {.tolerance = 1e-10, .method = fgtd::Method::hermite});
  const fgtd::Plan<d> pile(many, Eigen::MatrixXd::Ones(200, 1), 5.0,
                           {.tolerance = 1e-10, .method = fgtd::Method::hermite});
  EXPECT_LE((single.evaluate(targets) - naive::sum<d>(one, Eigen::MatrixXd::Constant(1, 1, 200.0), 5.0, targets))
                .cwiseAbs()
                .maxCoeff(),
            200 * 1e-10);
  EXPECT_LE((pile.evaluate(targets) - single.evaluate(targets)).cwiseAbs().maxCoeff(),
            200 * 2e-10);  // two plans, each to its tolerance
}

TEST(HermiteSum, TakesBoxScalesBeyondOneWithoutABound) {
  const auto sources = naive::random_points<2>(300, 23);
  const auto weights = naive::random_weights(300, 1, 24);
  fgtd::Options options;
  options.hermite = fgtd::HermiteParameters{.box_scale = 1.6, .expansion_order = 45};
  const fgtd::Plan<2> plan(sources, weights, 20.0, options);
  EXPECT_FALSE(plan.choice().bound.has_value());
  const auto targets = naive::random_points<2>(100, 25);
  EXPECT_LE((plan.evaluate(targets) - naive::sum<2>(sources, weights, 20.0, targets)).cwiseAbs().maxCoeff(),
            1.3e-14);  // 1.6^45/sqrt(45!): 1e-19; rounding of 300 terms, measured 4.4e-15
}

TEST(HermiteSum, FarFromTheOriginFallsBackToDirectWhereBoxesCannotBeToldApart) {
  const fgtd::Points<2> sources = naive::random_points<2>(50, 26).array() + 1e13;
  const fgtd::Plan<2> plan(sources, Eigen::MatrixXd::Ones(50, 1), 4.0, {.method = fgtd::Method::hermite});
  EXPECT_EQ(plan.choice().method, fgtd::Method::direct);
  const fgtd::Points<2> nearer = naive::random_points<2>(50, 26).array() + 1e9;
  const fgtd::Plan<2> boxes(nearer, Eigen::MatrixXd::Ones(50, 1), 4.0, {.method = fgtd::Method::hermite});
  ASSERT_EQ(boxes.choice().method, fgtd::Method::hermite);
  EXPECT_LE(
      (boxes.evaluate(nearer) - naive::sum<2>(nearer, Eigen::MatrixXd::Ones(50, 1), 4.0, nearer)).cwiseAbs().maxCoeff(),
      50 * 1e-6);  // the tolerance
}

TEST(Automatic, TakesDirectForFewPointsAndAFastMethodForMany) {
  const auto few = naive::random_points<2>(20, 27), many = naive::random_points<2>(20000, 28);
  EXPECT_EQ(fgtd::Plan<2>(few, Eigen::MatrixXd::Ones(20, 1), 10.0).choice().method, fgtd::Method::direct);
  EXPECT_NE(fgtd::Plan<2>(many, Eigen::MatrixXd::Ones(20000, 1), 10.0).choice().method, fgtd::Method::direct);
}

}  // namespace
