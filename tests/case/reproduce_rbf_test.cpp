// The study of radial sums, for few points.
#include "reproduce/rbf.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "parsed_json.hpp"

namespace gaussdrift::reproduce {
namespace {

TEST(ReproduceRbf, KeepsThePromiseForEveryKernel) {
  const RbfReproduction result = reproduce_rbf({.points = 200, .tolerance = 1e-4});
  ASSERT_EQ(result.sums.size(), 26u);  // two dimensions; two shapes of each kernel but the thin plate
  EXPECT_EQ(std::count_if(result.sums.begin(), result.sums.end(), [](const RbfSum& sum) { return sum.in_paper; }), 10);
  for (const RbfSum& sum : result.sums) {
    EXPECT_GE(sum.gaussians, 1u) << sum.kernel;
    EXPECT_LE(sum.bound, 1e-4) << sum.kernel;
    EXPECT_LE(sum.error, 1e-4) << sum.kernel << sum.dimension;
    EXPECT_GT(sum.error, 0) << sum.kernel;
    EXPECT_LE(sum.gradient_error, 1e-4) << sum.kernel << sum.dimension;
    EXPECT_LE(sum.kernel_error, sum.bound);
    EXPECT_GT(sum.ratio(), 0);
  }
  EXPECT_TRUE(result.kept());

  ASSERT_EQ(result.terms.size(), 7u);
  for (const RbfTerms& terms : result.terms) {
    ASSERT_EQ(terms.gaussians.size(), result.accuracies.size());
    EXPECT_TRUE(std::is_sorted(terms.gaussians.begin(), terms.gaussians.end())) << terms.kernel;
    EXPECT_LE(terms.gaussians.back(), 40u) << terms.kernel;
    EXPECT_EQ(terms.kernel == "gaussian", terms.gaussians.back() == 1) << terms.kernel;
  }
  ASSERT_EQ(result.growth.size(), 4u);
  EXPECT_EQ(result.growth.back().points, 1600);

  const auto json = parsed_json(to_json(result));
  EXPECT_EQ(json["sums"].size(), 26u);
  EXPECT_EQ(json["kept"], true);
  EXPECT_NE(to_text(result).find("Every sum keeps its promise"), std::string::npos);
}

TEST(ReproduceRbf, SaysWhereAPromiseIsBroken) {
  RbfReproduction result{.options = {.tolerance = 1e-4}};
  result.sums = {{.kernel = "multiquadric", .bound = 1e-4, .error = 9e-5, .gradient_error = 9e-5}};
  EXPECT_TRUE(result.kept());
  result.sums[0].gradient_error = 2e-4;
  EXPECT_FALSE(result.kept());
  EXPECT_NE(to_text(result).find("A SUM BREAKS ITS PROMISE"), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::reproduce
