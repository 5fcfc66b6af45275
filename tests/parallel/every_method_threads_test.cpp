// Results of fgtd do not depend on the number of threads, to the last bit, whatever the method.
#include <gtest/gtest.h>

#include <thread>

#include "oracle/promise.hpp"

namespace {

class Threads : public testing::TestWithParam<fgtd::Method> {
 protected:
  template <int d>
  void expect_same_bits(int count, double sigma, double tolerance, const fgtd::TensorGrid& grid) const {
    const auto sources = naive::random_points<d>(count, 61),
               targets = naive::random_points<d>(d == 4 ? 200 : 600, 62, -0.2, 1.2);
    const auto weights = naive::random_weights(count, 2, 63), others = naive::random_weights(count, 3, 67);
    auto combinations = naive::value_and_gradient<d>();
    combinations.push_back(naive::laplacian<d>());
    for (const bool for_grid : {false, true}) {
      std::vector<Eigen::MatrixXd> alone;
      for (const int threads : {1, 2, 4}) {
        fgtd::Options options{.tolerance = tolerance, .derivative_order = 2, .method = GetParam(), .threads = threads};
        if (for_grid) {
          options.expected_grid = grid;
        } else {
          options.expected_targets = 100000;
        }
        fgtd::Plan<d> plan(sources, weights, sigma, options);
        std::vector<Eigen::MatrixXd> together = {plan.evaluate_combinations(targets, combinations),
                                                 plan.evaluate_combinations(grid, combinations), plan.evaluate(targets),
                                                 plan.evaluate(grid)};
        plan.set_weights(others);
        together.push_back(plan.evaluate(targets));
        together.push_back(plan.evaluate(grid));
        if (threads == 1) alone = together;
        for (std::size_t i = 0; i < together.size(); ++i)
          EXPECT_EQ(together[i], alone[i])
              << threads << " threads, d = " << d << ", sigma = " << sigma << ", result " << i << ", " << plan.choice();
      }
    }
  }
};

TEST_P(Threads, ChangeNoBitInOneDimension) {
  expect_same_bits<1>(2000, 200.0, 1e-5, naive::cube_grid<1>(2000, -0.2, 1.2));
  expect_same_bits<1>(2000, 1e7, 1e-9, naive::cube_grid<1>(2000, -0.2, 1.2));
}
TEST_P(Threads, ChangeNoBitInTwoDimensions) {
  const auto grid = naive::cube_grid<2>(50, -0.2, 1.2);
  expect_same_bits<2>(2000, 0.3, 1e-12, grid);
  expect_same_bits<2>(2000, 200.0, 1e-5, grid);
  expect_same_bits<2>(2000, 1e5, 1e-8, grid);
}
TEST_P(Threads, ChangeNoBitInThreeDimensions) {
  const auto grid = naive::cube_grid<3>(13, -0.2, 1.2);
  expect_same_bits<3>(1500, 8.0, 1e-5, grid);
  expect_same_bits<3>(1500, 1000.0, 1e-6, grid);
}
TEST_P(Threads, ChangeNoBitInFourDimensions) { expect_same_bits<4>(150, 8.0, 1e-2, naive::cube_grid<4>(4, -0.2, 1.2)); }

TEST_P(Threads, MayEvaluateOnePlanTogether) {
  const auto sources = naive::random_points<2>(2000, 64), targets = naive::random_points<2>(400, 65);
  const auto grid = naive::cube_grid<2>(30, -0.1, 1.1);
  const fgtd::Plan<2> plan(sources, naive::random_weights(2000, 1, 66), 100.0, {.method = GetParam(), .threads = 1});
  const Eigen::MatrixXd at_targets = plan.evaluate(targets), on_grid = plan.evaluate(grid);
  std::vector<Eigen::MatrixXd> points(4), nodes(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i)
    threads.emplace_back([&, i] {
      points[i] = plan.evaluate(targets);
      nodes[i] = plan.evaluate(grid);
    });
  for (auto& thread : threads) thread.join();
  for (const auto& values : points) EXPECT_EQ(values, at_targets);
  for (const auto& values : nodes) EXPECT_EQ(values, on_grid);
}

// `outer` cuts the grid by the number of threads.
template <int d>
void expect_that_cuts_change_no_bit(std::size_t nodes, double sigma) {
  const auto sources = naive::random_points<d>(700, 68);
  const auto weights = naive::random_weights(700, 2, 69);
  const auto grid = naive::cube_grid<d>(nodes, -0.13, 1.17);
  auto combinations = naive::value_and_gradient<d>();
  combinations.push_back(naive::laplacian<d>());
  Eigen::MatrixXd alone;
  for (const int threads : {1, 2, 3, 4, 5, 7, 16}) {
    const fgtd::Plan<d> plan(sources, weights, sigma,
                             {.tolerance = 1e-7,
                              .derivative_order = 2,
                              .method = fgtd::Method::outer_product,
                              .threads = threads,
                              .expected_grid = grid});
    const Eigen::MatrixXd values = plan.evaluate_combinations(grid, combinations);
    if (threads == 1) alone = values;
    EXPECT_EQ(values, alone) << threads << " threads, d = " << d << ", sigma = " << sigma;
  }
}

TEST(Outer, CutsTheGridForAnyNumberOfThreadsWithoutChangingABit) {
  for (const double sigma : {30.0, 3000.0, 1e6}) {
    expect_that_cuts_change_no_bit<1>(3001, sigma);
    expect_that_cuts_change_no_bit<2>(83, sigma);
    expect_that_cuts_change_no_bit<3>(19, sigma);
  }
}

INSTANTIATE_TEST_SUITE_P(Parallel, Threads, testing::ValuesIn(fgtd::methods()), naive::MethodName());

}  // namespace
