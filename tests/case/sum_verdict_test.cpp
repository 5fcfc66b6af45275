// A sum is compared with all pairs, and an error beyond the promise is never told as if it were none.
#include "sum/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "gaussdrift/error.hpp"
#include "sum/pairs.hpp"
#include "sum/points.hpp"
#include "sum/radial.hpp"

namespace gaussdrift::sum {
namespace {

input::PointsTable cloud(std::size_t count, int dimension) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0, 1), weight(-1, 1);
  input::PointsTable table;
  for (int l = 0; l < dimension; ++l) table.coordinates.push_back(std::string(1, "xyzw"[l]));
  for (std::size_t j = 0; j < count; ++j) {
    for (int l = 0; l < dimension; ++l) table.positions.push_back(place(random));
    table.weights.push_back(weight(random));
  }
  return table;
}

TEST(SumVerdict, KeepsTheWorstErrorAndWhatIsNotANumber) {
  Worst worst;
  EXPECT_EQ(worst.error(), 0);
  for (const double error : {2.0, 3.0, 1.0}) worst.take(error);
  EXPECT_EQ(worst.error(), 3);
  for (const double error : {std::numeric_limits<double>::quiet_NaN(), 9.0}) worst.take(error);
  EXPECT_TRUE(std::isnan(worst.error()));
  EXPECT_EQ(relative(0, 0), 0);
}

TEST(SumVerdict, NamesWhatIsBeyondThePromise) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(broken_promises({}, 0).empty());
  EXPECT_TRUE(broken_promises({{"the field", 1e-6, 1e-6}, {"the potential", 0, 1e-6}}, 200).empty());
  const auto broken = broken_promises({{"the potential", 1e-7, 1e-6}, {"the field", 5e-2, 1e-2}}, 200);
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].rfind("the field is wrong by 0.05 where 0.01 is promised. This was found at 200 targets", 0), 0u)
      << broken[0];
  EXPECT_EQ(broken_promises({{"d_0", nan, 1e-2}}, 10).size(), 1u);
}

// Every kernel in every dimension: what was computed keeps the promise, what is changed afterwards does not.
TEST(SumVerdict, FindsValuesOfPairsThatAreWrong) {
  for (const auto& [kernel, dimension] : {std::pair{farfield::Kernel::coulomb, 2},
                                          {farfield::Kernel::coulomb, 3},
                                          {farfield::Kernel::log, 1},
                                          {farfield::Kernel::log, 2}}) {
    PairSumRequest request;
    request.kernel = kernel;
    request.method = farfield::Method::symmetric;
    request.sources = cloud(500, dimension);
    request.tolerance = 1e-3;
    PairSums sums = sum_pairs(request);
    EXPECT_EQ(sums.compared, 200u);
    EXPECT_TRUE(broken_promises(sums.measured, sums.compared).empty()) << farfield::to_string(kernel) << dimension;
    const Eigen::MatrixXd right = sums.values;
    for (int column = 0; column <= dimension; ++column) {
      sums.values = right;
      sums.values.col(column).array() += 0.2 * sums.charge_total;  // a hundredth of the sums without signs, or more
      measure_errors(request, sums);
      const auto broken = broken_promises(sums.measured, sums.compared);
      ASSERT_EQ(broken.size(), 1u) << column;
      EXPECT_EQ(broken[0].find(column == 0 ? "the potential" : "the field"), 0u) << broken[0];
      EXPECT_NE(to_json(sums).find("\"kept\": false"), std::string::npos);
    }
    sums.values = right;
    sums.values(0, 0) = std::numeric_limits<double>::quiet_NaN();
    measure_errors(request, sums);
    EXPECT_EQ(broken_promises(sums.measured, sums.compared).size(), 1u);
  }
}

TEST(SumVerdict, FindsValuesOfGaussiansThatAreWrong) {
  for (int dimension = 1; dimension <= 4; ++dimension)
    for (const auto method : fgtd::methods()) {
      SumRequest request;
      request.method = method;
      request.sigma = 2;
      request.sources = cloud(dimension == 4 ? 40 : 200, dimension);
      request.tolerance = 1e-2;
      request.derivatives = {std::vector<int>(static_cast<std::size_t>(dimension), 0), {1}};
      request.derivatives.back().resize(static_cast<std::size_t>(dimension), 0);
      PointSums sums = sum_points(request);
      EXPECT_TRUE(broken_promises(sums.measured, sums.compared).empty()) << fgtd::to_string(method) << dimension;
      EXPECT_EQ(sums.measured.empty(), sums.choice.method == fgtd::Method::direct);
      sums.values(0, 1) += 3 * request.tolerance * sums.weight_total * 2;  // N_alpha = sqrt(2 sigma) = 2
      measure_errors(request, sums);
      const auto broken = broken_promises(sums.measured, sums.compared);
      ASSERT_EQ(broken.size(), 1u) << fgtd::to_string(method) << dimension;
      EXPECT_EQ(broken[0].find("d_1"), 0u) << broken[0];
    }
}

TEST(SumVerdict, FindsValuesOfRadialKernelsThatAreWrong) {
  for (int dimension = 1; dimension <= 3; ++dimension)
    for (const rbf::Kernel kernel : rbf::kernels()) {
      RadialSumRequest request;
      request.function = {kernel, rbf::takes_shape(kernel) ? 0.3 : 0};
      request.method = rbf::Method::gaussians;
      request.sources = cloud(300, dimension);
      request.tolerance = 1e-3;
      request.derivatives = {std::vector<int>(static_cast<std::size_t>(dimension), 0), {1}};
      request.derivatives.back().resize(static_cast<std::size_t>(dimension), 0);
      RadialSums sums = sum_radial(request);
      ASSERT_EQ(sums.choice.method, rbf::Method::gaussians) << to_string(kernel);
      EXPECT_EQ(sums.compared, 200u);
      EXPECT_TRUE(broken_promises(sums.measured, sums.compared).empty()) << to_string(kernel) << dimension;
      const double slope = rbf::largest_derivative(request.function, sums.choice.range, 1);
      sums.values(0, 1) += 3 * request.tolerance * slope * sums.weight_total;
      measure_errors(request, sums);
      const auto broken = broken_promises(sums.measured, sums.compared);
      ASSERT_EQ(broken.size(), 1u) << to_string(kernel) << dimension;
      EXPECT_EQ(broken[0].find("d_1"), 0u) << broken[0];
      EXPECT_NE(to_json(sums).find("\"kept\": false"), std::string::npos);
    }
}

TEST(SumVerdict, SamplesTargetsOfTablesAndGrids) {
  PairSumRequest request;
  request.sources = cloud(1000, 2);
  const SampleOfTargets own = sample_targets(request);
  ASSERT_EQ(own.rows.size(), 200u);
  EXPECT_EQ(own.points(1, 3), request.sources.positions[2 * static_cast<std::size_t>(own.rows[3]) + 1]);
  request.grid = {{0, 1, 3}, {10, 14, 5}};
  const SampleOfTargets grid = sample_targets(request);
  ASSERT_EQ(grid.rows.size(), 15u);
  EXPECT_EQ(grid.points(0, 4), 0.5);  // row 4 = 1 + 3 * 1: the first axis runs fastest
  EXPECT_EQ(grid.points(1, 4), 11.0);
}

TEST(SumVerdict, RefusesWhatIsPredictedToTakeTooLongAndTellsTheRest) {
  PointsRequest request;
  request.threads = 2;
  request.most_seconds = 300;
  std::string told;
  request.tell = [&](const std::string& what) { told = what; };
  tell_or_refuse(request, {45, "hermite"}, [] { return PredictedWork{}; });
  EXPECT_EQ(told, "hermite takes about 45 s on 2 threads");
  const auto refused = [&](const PredictedWork& work, const PredictedWork& fastest) {
    try {
      tell_or_refuse(request, work, [&] { return fastest; });
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(
      refused({7500, "hermite"}, {0.25, "direct"}),
      "hermite would take about 2.1 hours on 2 threads, and only sums of up to 5 minutes are begun. Use --method auto, "
      "which takes about 0.25 s (direct), or raise --seconds.");
  EXPECT_EQ(refused({400, "direct"}, {400, "direct"}),
            "direct would take about 7 minutes on 2 threads, and only sums of up to 5 minutes are begun. Ask for fewer "
            "targets or a larger tolerance, or raise --seconds.");
}

}  // namespace
}  // namespace gaussdrift::sum
