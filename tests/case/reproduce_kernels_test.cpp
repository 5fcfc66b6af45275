// The studies of general kernels, for few points.
#include "parsed_json.hpp"
#include "reproduce/kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace gaussdrift::reproduce {
namespace {

TEST(ReproduceKernels, FindsWhatTheSlidesState) {
  const KernelsReproduction result = reproduce_kernels({.points = 500, .finest = 1e-4});
  ASSERT_EQ(result.rates.size(), 3u);
  for (const KernelsRate& rate : result.rates) {
    EXPECT_LE(rate.factor, rate.stated) << "eta " << rate.eta;
    EXPECT_LT(rate.error.back(), rate.error[2]);
  }
  EXPECT_LT(result.rates[2].factor, result.rates[1].factor);
  EXPECT_LT(result.rates[1].factor, result.rates[0].factor);

  ASSERT_EQ(result.decays.size(), 6u);
  for (const KernelsDecay& decay : result.decays) {
    EXPECT_GT(decay.constant, 0.5) << decay.diameter << ", " << decay.distance;
    EXPECT_LT(decay.constant, 1.5) << decay.diameter << ", " << decay.distance;
  }

  ASSERT_EQ(result.blocks.size(), 5u);
  for (const KernelsBlocks& blocks : result.blocks) {
    EXPECT_LE(blocks.recompressed_error, blocks.error);
    EXPECT_LT(blocks.recompressed, blocks.doubles);
  }

  ASSERT_EQ(result.sums.size(), 16u);
  EXPECT_TRUE(result.kept());

  ASSERT_EQ(result.orders.size(), 2u);
  const KernelsOrders &variable = result.orders[0], &one = result.orders[1];
  EXPECT_TRUE(std::is_sorted(variable.orders.rbegin(), variable.orders.rend()));
  EXPECT_EQ(variable.orders.front(), one.orders.back());
  EXPECT_LE(variable.measured, 1e-6);
  EXPECT_LT(variable.megabytes, one.megabytes);

  ASSERT_EQ(result.bases.size(), 4u);
  for (const KernelsBases& bases : result.bases) {  // fewer functions, the more they know
    EXPECT_LT(bases.best, bases.harmonic);
    EXPECT_LT(bases.total, bases.tensor);
    EXPECT_LT(bases.harmonic, bases.sphere);
  }
  EXPECT_LT(result.bases.back().harmonic, result.bases.back().total);
  const auto json = parsed_json(to_json(result));
  EXPECT_EQ(json["sums"].size(), 16u);
  EXPECT_EQ(json["kept"], true);
  EXPECT_NE(to_text(result).find("Every sum keeps its promise"), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::reproduce
