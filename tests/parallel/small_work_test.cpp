// Small sums stay on their thread, whatever the method; large ones do not.
#include <gtest/gtest.h>

#include "oracle/promise.hpp"
#include "share_from.hpp"

namespace {

class SmallSums : public testing::TestWithParam<fgtd::Method> {};

TEST_P(SmallSums, OpenNoRegionOfThreads) {
  const auto sources = naive::random_points<2>(60, 71), targets = naive::random_points<2>(60, 72);
  const auto weights = naive::random_weights(60, 1, 73);
  const auto grid = naive::cube_grid<2>(8, 0, 1);
  EXPECT_TRUE(stays_on_its_thread([&] {
    const fgtd::Plan<2> plan(sources, weights, 30.0, {.tolerance = 1e-3, .method = GetParam(), .threads = 8});
    plan.evaluate(targets);
    plan.evaluate(grid);
  }));
}

TEST_P(SmallSums, GiveTheBitsOfLargeOnes) {
  const auto sources = naive::random_points<2>(500, 74), targets = naive::random_points<2>(500, 75);
  const auto grid = naive::cube_grid<2>(40, 0, 1);
  const fgtd::Plan<2> plan(sources, naive::random_weights(500, 2, 76), 30.0, {.method = GetParam(), .threads = 3});
  const Eigen::MatrixXd at_targets = plan.evaluate(targets), on_grid = plan.evaluate(grid);  // everything is shared
  const ShareFrom never(1e9);
  EXPECT_EQ(plan.evaluate(targets), at_targets);
  EXPECT_EQ(plan.evaluate(grid), on_grid);
}

INSTANTIATE_TEST_SUITE_P(Parallel, SmallSums, testing::ValuesIn(fgtd::methods()), naive::MethodName());

TEST(LargeSums, AreShared) {
  if (gaussdrift::base::resolve_threads(2) < 2) GTEST_SKIP() << "without OpenMP there is one thread";
  const auto points = naive::random_points<2>(1000, 77);
  const fgtd::Plan<2> plan(points, naive::random_weights(1000, 1, 78), 30.0,
                           {.method = fgtd::Method::direct, .threads = 2});
  const ShareFrom usual(ShareFrom::usual);
  const std::size_t before = gaussdrift::base::regions_opened();
  plan.evaluate(points);
  EXPECT_GT(gaussdrift::base::regions_opened(), before);
}

}  // namespace
