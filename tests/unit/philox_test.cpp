// Random numbers without a state: the known answers of Philox, and that what is drawn is normal and independent.
#include "base/philox.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace gaussdrift::base {
namespace {

using Words = std::array<std::uint32_t, 4>;

// Of the file kat_vectors that comes with Random123 [SMDS11].
TEST(Philox, HasTheKnownAnswers) {
  constexpr std::uint32_t all = 0xffffffffu;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({all, all, all, all}, {all, all}), (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

// The mean of n independent numbers of variance v deviates by sqrt(v/n), and by more than five times that in one of two
// million trials. Powers 1 to 4 of a normal number have the variances 1, 2, 15, 96; a product of two has 1.
TEST(Philox, DrawsNormalNumbersThatAreIndependentAlongEveryCounter) {
  constexpr int count = 200000;
  double powers[4]{}, beside = 0, next = 0, after = 0, other_seed = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto [x, y] = two_normals(7, i, 3);
    double power = 1;
    for (double& sum : powers) sum += power *= x;
    beside += x * y;
    next += x * two_normals(7, i + 1, 3)[0];
    after += x * two_normals(7, i, 4)[0];
    other_seed += x * two_normals(8, i, 3)[0];
  }
  const auto far = [](double sum, double mean, double variance) {
    return std::abs(sum / count - mean) / std::sqrt(variance / count);
  };
  EXPECT_LT(far(powers[0], 0, 1), 5);
  EXPECT_LT(far(powers[1], 1, 2), 5);
  EXPECT_LT(far(powers[2], 0, 15), 5);
  EXPECT_LT(far(powers[3], 3, 96), 5);
  for (const double product : {beside, next, after, other_seed}) EXPECT_LT(far(product, 0, 1), 5);
}

}  // namespace
}  // namespace gaussdrift::base
