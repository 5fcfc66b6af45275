// `direct` against the definition in long double.
#include <gtest/gtest.h>

#include <limits>

#include "oracle/naive.hpp"

namespace {

template <class T>
class Direct : public testing::Test {};
using Dimensions = testing::Types<naive::Dimension<1>, naive::Dimension<2>, naive::Dimension<3>, naive::Dimension<4>>;
TYPED_TEST_SUITE(Direct, Dimensions);

TYPED_TEST(Direct, EqualsTheDefinitionWithAllDerivativesToOrderFive) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(70, 1), targets = naive::random_points<d>(37, 2, -0.5, 1.5);
  const auto weights = naive::random_weights(70, 3, 3);
  const double sigma = 7.3;
  const fgtd::Plan<d> plan(sources, weights, sigma, {.derivative_order = 5, .method = fgtd::Method::direct});
  for (int order = 0; order <= 5; ++order)
    for (const auto& alpha : naive::derivatives_of_order<d>(order)) {
      const double error = (plan.evaluate(targets, alpha) - naive::sum<d>(sources, weights, sigma, targets, alpha))
                               .cwiseAbs()
                               .maxCoeff();
      // Three roundings of every term, at 1.1e-16 of the scale and the weight; measured is one.
      EXPECT_LE(error, 3.3e-16 * fgtd::derivative_scale<d>(alpha, sigma) * weights.col(0).cwiseAbs().sum())
          << "order " << order;
    }
}

TYPED_TEST(Direct, GridAndPointsGiveTheSame) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(50, 4);
  const auto weights = naive::random_weights(50, 2, 5);
  const auto grid = naive::cube_grid<d>(5, -0.3, 1.2);
  const fgtd::Plan<d> plan(sources, weights, 11.0, {.method = fgtd::Method::direct});
  EXPECT_EQ(plan.evaluate(grid), plan.evaluate(naive::points_of<d>(grid)));  // the same operations in the same order
}

TYPED_TEST(Direct, ManyCombinationsAndColumnsKeepTheirPlaces) {
  constexpr int d = TypeParam::value;
  const auto sources = naive::random_points<d>(20, 6), targets = naive::random_points<d>(9, 7);
  const auto weights = naive::random_weights(20, 7, 8);
  const fgtd::Plan<d> plan(sources, weights, 3.0, {.derivative_order = 3, .method = fgtd::Method::direct});
  std::vector<fgtd::Combination<d>> combinations;
  std::vector<fgtd::Derivative<d>> alphas;
  for (int order = 0; order <= 3; ++order)
    for (const auto& alpha : naive::derivatives_of_order<d>(order)) {
      alphas.push_back(alpha);
      combinations.push_back({{alpha, 2.0}});
    }
  const Eigen::MatrixXd all = plan.evaluate_combinations(targets, combinations);
  ASSERT_EQ(all.cols(), static_cast<Eigen::Index>(7 * combinations.size()));
  for (std::size_t q = 0; q < alphas.size(); ++q) {
    const Eigen::MatrixXd one = 2 * plan.evaluate(targets, alphas[q]);
    const Eigen::MatrixXd part = all.middleCols(static_cast<Eigen::Index>(7 * q), 7);
    // A rounding of each of 20 terms.
    EXPECT_LE((part - one).cwiseAbs().maxCoeff(), 2.2e-16 * fgtd::derivative_scale<d>(alphas[q], 3.0) * 20) << q;
  }
}

TEST(DirectSum, StaysAccurateForManySources) {
  const int count = 200000;
  const fgtd::Points<1> sources = fgtd::Points<1>::Zero(1, count);
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Constant(count, 1, 0.1);
  const fgtd::Plan<1> plan(sources, weights, 1.0, {.method = fgtd::Method::direct});
  const fgtd::Points<1> target = fgtd::Points<1>::Zero(1, 1);
  // In chunks of 256 a term is rounded by about 1000 additions at most, whose signs differ: sqrt(1000) 1.1e-16. One
  // after the other they would err by 1e-13 and more.
  EXPECT_NEAR(plan.evaluate(target)(0, 0), count * 0.1, 3.5e-15 * count * 0.1);
}

TEST(DirectSum, SurvivesHugeCoordinatesAndSharpGaussians) {
  fgtd::Points<2> sources(2, 3);
  sources << 1e300, -1e308, 0, 1e300, 1e308, 0;
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(3, 1);
  fgtd::Points<2> targets(2, 4);
  targets << 1e300, 1e308, 0, 1e-160, 1e300, -1e308, 0, 0;
  for (const double sigma : {1e-300, 1.0, 1e290}) {
    const fgtd::Plan<2> plan(sources, weights, sigma, {.derivative_order = 1});
    const Eigen::MatrixXd values = plan.evaluate(targets), slopes = plan.evaluate(targets, {1, 0});
    EXPECT_TRUE(values.allFinite() && slopes.allFinite()) << sigma;
    EXPECT_EQ(values(2, 0), 1.0) << sigma;  // only the source at the origin is near
    EXPECT_EQ(values(0, 0), 1.0) << sigma;
    EXPECT_EQ(values(1, 0), 0.0) << sigma;
  }
}

TEST(DirectSum, ExponentialIsRightToTwoUnitsInTheLastPlace) {
  const fgtd::Points<1> source = fgtd::Points<1>::Zero(1, 1);
  const Eigen::MatrixXd weight = Eigen::MatrixXd::Ones(1, 1);
  const fgtd::Plan<1> plan(source, weight, 1.0, {.method = fgtd::Method::direct});
  fgtd::Points<1> targets(1, 20000);
  for (int i = 0; i < 20000; ++i) targets(0, i) = std::sqrt(705.0 * i / 20000);
  const Eigen::MatrixXd values = plan.evaluate(targets);
  for (int i = 0; i < 20000; ++i) {
    const double squared =
        targets(0, i) * targets(0, i);  // as the library rounds it; exp() is judged, not its argument
    const double exact = static_cast<double>(std::exp(-static_cast<long double>(squared)));
    EXPECT_NEAR(values(i, 0), exact, 2 * std::numeric_limits<double>::epsilon() * exact) << squared;
  }
}

}  // namespace
