// `cells` against `direct` and against its promise: sharp Gaussians, scattered targets anywhere.
#include <gtest/gtest.h>

#include "oracle/promise.hpp"

namespace {

template <class T>
class Cells : public testing::Test {};
using Dimensions = testing::Types<naive::Dimension<1>, naive::Dimension<2>, naive::Dimension<3>, naive::Dimension<4>>;
TYPED_TEST_SUITE(Cells, Dimensions);

/// Largest difference to `direct` at the targets over all derivatives of some orders, in units of what is promised.
template <int d>
void expect_equal(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights, double sigma,
                  const fgtd::Points<d>& targets, double tolerance, const std::vector<int>& orders) {
  double weight = 0;
  for (Eigen::Index k = 0; k < weights.cols(); ++k) weight = std::max(weight, weights.col(k).cwiseAbs().sum());
  for (const int order : orders) {
    const fgtd::Plan<d> direct(sources, weights, sigma, {.derivative_order = order, .method = fgtd::Method::direct});
    const fgtd::Plan<d> cells(sources, weights, sigma,
                              {.tolerance = tolerance, .derivative_order = order, .method = fgtd::Method::cells});
    ASSERT_EQ(cells.choice().method, fgtd::Method::cells);
    ASSERT_LE(cells.choice().bound.value(), tolerance);
    for (const auto& alpha : naive::derivatives_of_order<d>(order)) {
      const double allowed =
          (tolerance + 3e-14) * fgtd::derivative_scale<d>(alpha, sigma) * weight;  // the promise, with its rounding
      EXPECT_LE((direct.evaluate(targets, alpha) - cells.evaluate(targets, alpha)).cwiseAbs().maxCoeff(), allowed)
          << naive::name_of<d>(alpha) << ", " << cells.choice();
    }
    const Eigen::MatrixXd both = cells.evaluate_combinations(targets, {{}, {{{}, 2.0}}});
    const Eigen::MatrixXd one = cells.evaluate(targets);
    EXPECT_TRUE((both.leftCols(weights.cols()).array() == 0).all()) << "an empty combination is 0";
    EXPECT_LE((both.rightCols(weights.cols()) - 2 * one).cwiseAbs().maxCoeff(),
              2 * (tolerance + 1e-14) * weight);  // the plain sum may use a shorter exponential
  }
}

TYPED_TEST(Cells, EqualDirectForUniformSources) {
  constexpr int d = TypeParam::value;
  for (const double sigma : {2.0, 300.0, 1e5})
    expect_equal<d>(naive::random_points<d>(500, 201), naive::random_weights(500, 3, 202), sigma,
                    naive::random_points<d>(300, 203, -0.2, 1.2), 1e-9, {0, 1, 2, 3, 4});
}

TYPED_TEST(Cells, EqualDirectForOneColumn) {
  constexpr int d = TypeParam::value;
  for (const double tolerance : {1e-2, 1e-5, 1e-8, 1e-11, 1e-13})
    for (const double sigma : {0.1, 40.0, 3e3})
      expect_equal<d>(naive::random_points<d>(1500, 204), naive::random_weights(1500, 1, 205), sigma,
                      naive::random_points<d>(700, 206, -0.2, 1.2), tolerance, {0});
}

TYPED_TEST(Cells, EqualDirectForSingleHighDerivatives) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(200, 207), targets = naive::random_points<d>(100, 208);
  const auto weights = naive::random_weights(200, 2, 209);
  std::vector<fgtd::Derivative<d>> alphas(3);
  alphas[0][0] = 8;
  alphas[1][0] = alphas[1][d - 1] = 5;
  alphas[2][d - 1] = 12;
  const fgtd::Options options{.tolerance = 1e-8, .derivative_order = 12, .method = fgtd::Method::cells};
  for (const double sigma : {5.0, 500.0}) {
    const fgtd::Plan<d> cells(sources, weights, sigma, options);
    for (const auto& alpha : alphas)
      EXPECT_LE((cells.evaluate(targets, alpha) - naive::sum<d>(sources, weights, sigma, targets, alpha))
                    .cwiseAbs()
                    .maxCoeff(),
                1e-8 * fgtd::derivative_scale<d>(alpha, sigma) *
                    weights.cwiseAbs().sum());  // the promise, for the sum of both columns
  }
}

TYPED_TEST(Cells, KeepThePromiseOfEveryTerm) {
  constexpr int d = TypeParam::value;
  naive::Scene<d> scene{"cells", 7.0, naive::random_points<d>(300, 210, 0, d < 3 ? 6.0 : 2.5), {}, {}, {}};
  scene.watch(6);
  scene.targets = naive::random_points<d>(150, 211, -2, 8);
  for (int i = 0; i < 60; ++i) scene.targets.col(i) = scene.sources.col(scene.watched[static_cast<std::size_t>(i % 6)]);
  for (int i = 0; i < 60; ++i) scene.targets(i % d, i) += i / 6 * 0.3;
  naive::ExactTerms<d> exact(scene, scene.targets);
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-11, 1e-12, 1e-13})
    for (const int order : {0, 1, 4}) {
      const fgtd::Plan<d> plan(scene.sources, scene.weights(), scene.sigma,
                               {.tolerance = tolerance, .derivative_order = order, .method = fgtd::Method::cells});
      for (const auto& alpha : naive::derivatives_of_order<d>(order)) {
        const auto errors =
            naive::measure<d>(exact, plan.evaluate(scene.targets, alpha), scene.sigma, tolerance, alpha);
        EXPECT_LE(errors.of_promise, 1.0) << tolerance << ", " << naive::name_of<d>(alpha) << ", " << errors.where;
      }
    }
}

TYPED_TEST(Cells, AreExactlyZeroBeyondTheReach) {
  constexpr int d = TypeParam::value;
  const fgtd::Points<d> sources = naive::random_points<d>(100, 212);
  fgtd::Points<d> targets = naive::random_points<d>(50, 213);
  const fgtd::Plan<d> plan(sources, naive::random_weights(100, 1, 214), 1e4,
                           {.tolerance = 1e-6, .derivative_order = 1, .method = fgtd::Method::cells});
  const double side = std::get<fgtd::Cells>(plan.choice().parameters).side;
  for (const double cells : {1e2, 1e6, 1e12, 1e200}) {
    const fgtd::Points<d> far = targets.array() + 1 + cells * side, below = targets.array() - 1 - cells * side;
    EXPECT_TRUE((plan.evaluate(far).array() == 0).all()) << cells;
    EXPECT_TRUE((plan.evaluate(below).array() == 0).all()) << cells;
  }
  targets.row(0).array() += 1e306;
  EXPECT_TRUE((plan.evaluate(targets).array() == 0).all());
}

TYPED_TEST(Cells, EqualDirectForClustersBesideOutliers) {
  constexpr int d = TypeParam::value;
  fgtd::Points<d> sources = naive::random_points<d>(300, 215);
  for (int j = 0; j < 300; ++j) {
    if (j % 3 == 0) sources.col(j) = (sources.col(j) * 1e-7).array() + 0.25;
    if (j % 3 == 1) sources.col(j) *= 1e3;
  }
  fgtd::Points<d> targets = sources.leftCols(200);
  targets.array() += 1e-9;
  for (const double sigma : {1e-4, 1.0, 1e6, 1e12, 1e16})
    expect_equal<d>(sources, naive::random_weights(300, 1, 216), sigma, targets, 1e-10, {0, 2});
}

TYPED_TEST(Cells, EqualDirectWhenAllPointsAreEqual) {
  constexpr int d = TypeParam::value;
  const fgtd::Points<d> sources = fgtd::Points<d>::Constant(d, 3000, 0.7);
  fgtd::Points<d> targets = fgtd::Points<d>::Constant(d, 300, 0.7);
  targets.rightCols(100).array() += 1e-3;
  for (const double sigma : {1e-8, 10.0, 1e6, 1e14})
    expect_equal<d>(sources, naive::random_weights(3000, 1, 217), sigma, targets, 1e-9, {0, 1});
}

TYPED_TEST(Cells, EqualDirectForEverySigmaOnTheUnitCube) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(200, 218);
  for (double sigma = 1e-8; sigma < 2e14; sigma *= 100) {
    fgtd::Points<d> targets = naive::random_points<d>(200, 219, -1, 1) * (3 / std::sqrt(sigma));
    targets.leftCols(100) += sources.leftCols(100);
    expect_equal<d>(sources, naive::random_weights(200, 1, 220), sigma, targets, 1e-7, {0, 1});
  }
}

TYPED_TEST(Cells, SumTheSameForAnyNumberOfThreads) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(4000, 221), targets = naive::random_points<d>(3000, 222, -0.1, 1.1);
  const auto weights = naive::random_weights(4000, 2, 223);
  Eigen::MatrixXd once;
  for (const int threads : {1, 2, 4}) {
    const fgtd::Plan<d> plan(sources, weights, 400.0,
                             {.derivative_order = 1, .method = fgtd::Method::cells, .threads = threads});
    const Eigen::MatrixXd values = plan.evaluate_combinations(targets, naive::value_and_gradient<d>());
    if (threads == 1) once = values;
    EXPECT_EQ(values, once) << threads << " threads";
  }
}

TEST(CellsPlan, NamesItsMemoryWhenItDoesNotFit) {
  const auto sources = naive::random_points<2>(1000, 224);
  EXPECT_THROW(fgtd::Plan<2>(sources, Eigen::MatrixXd::Ones(1000, 1), 1e4,
                             {.method = fgtd::Method::cells, .memory_limit = 30000}),
               fgtd::MemoryLimitError);
}

TEST(CellsPlan, HoldsNothingThatGrowsWithSigma) {
  const auto sources = naive::random_points<3>(100, 225);
  for (const double sigma : {1e-12, 1.0, 1e12, 1e40, 1e300}) {
    const fgtd::Plan<3> plan(sources, Eigen::MatrixXd::Ones(100, 1), sigma,
                             {.method = fgtd::Method::cells, .threads = 1, .memory_limit = 2000000});
    EXPECT_EQ(plan.choice().method, fgtd::Method::cells);
    EXPECT_LE(std::get<fgtd::Cells>(plan.choice().parameters).occupied, 100u);
    const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(100, 1);
    EXPECT_NEAR(plan.evaluate(sources)(0, 0), naive::sum<3>(sources, ones, sigma, sources.leftCols(1))(0, 0),
                100 * 1e-6)
        << sigma;  // the promise
  }
}

}  // namespace
