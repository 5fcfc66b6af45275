// Results of fgtd do not depend on the number of threads, to the last bit.
#include <gtest/gtest.h>

#include <thread>

#include "oracle/naive.hpp"

namespace {

template <class T>
class Threads : public testing::Test {};
using Dimensions = testing::Types<naive::Dimension<1>, naive::Dimension<2>, naive::Dimension<3>, naive::Dimension<4>>;
TYPED_TEST_SUITE(Threads, Dimensions);

TYPED_TEST(Threads, ChangeNoBit) {
  constexpr int d = TypeParam::value;
  const int count = d == 4 ? 300 : 3000;
  const auto sources = naive::random_points<d>(count, 61), targets = naive::random_points<d>(500, 62, -0.2, 1.2);
  const auto weights = naive::random_weights(count, 2, 63);
  const auto grid = naive::cube_grid<d>(d == 1 ? 3000 : d == 2 ? 70 : d == 3 ? 17 : 6, -0.2, 1.2);
  for (const auto method : {fgtd::Method::direct, fgtd::Method::hermite}) {
    Eigen::MatrixXd at_points, on_grid;
    for (const int threads : {1, 2, 4}) {
      const fgtd::Plan<d> plan(
          sources, weights, d < 3 ? 200.0 : 8.0,
          {.tolerance = d == 4 ? 1e-2 : 1e-5, .derivative_order = 2, .method = method, .threads = threads});
      auto combinations = naive::value_and_gradient<d>();
      combinations.push_back(naive::laplacian<d>());
      const Eigen::MatrixXd points = plan.evaluate_combinations(targets, combinations),
                            nodes = plan.evaluate_combinations(grid, combinations);
      if (threads == 1) {
        at_points = points;
        on_grid = nodes;
      }
      EXPECT_EQ(points, at_points) << fgtd::to_string(method) << ", " << threads << " threads";
      EXPECT_EQ(nodes, on_grid) << fgtd::to_string(method) << ", " << threads << " threads";
    }
  }
}

TEST(Evaluation, IsSafeFromSeveralThreadsAtOnce) {
  const auto sources = naive::random_points<2>(2000, 64), targets = naive::random_points<2>(400, 65);
  const fgtd::Plan<2> plan(sources, naive::random_weights(2000, 1, 66), 100.0,
                           {.method = fgtd::Method::hermite, .threads = 1});
  const Eigen::MatrixXd alone = plan.evaluate(targets);
  std::vector<Eigen::MatrixXd> together(4);
  std::vector<std::thread> threads;
  for (auto& values : together) threads.emplace_back([&] { values = plan.evaluate(targets); });
  for (auto& thread : threads) thread.join();
  for (const auto& values : together) EXPECT_EQ(values, alone);
}

}  // namespace
