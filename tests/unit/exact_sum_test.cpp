// Exact sums have the bits of the exact sum rounded once, whatever the order, the ranks and the sizes of the addends.
#include "base/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/communicator.hpp"
#include "ranks_of_threads.hpp"

namespace gaussdrift::base {
namespace {

constexpr double largest = std::numeric_limits<double>::max(), smallest = std::numeric_limits<double>::denorm_min();
constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

double sum_of(const std::vector<double>& addends) {
  ExactSum sum;
  sum.add(std::span(addends));
  return sum.value();
}

/// Another way to the same number, Shewchuk's: a list of doubles that do not overlap and whose sum is exact. As long as
/// nothing overflows.
double by_expansion(const std::vector<double>& addends) {
  std::vector<double> parts;  // growing in size
  for (double x : addends) {
    std::size_t kept = 0;
    for (double y : parts) {
      if (std::abs(x) < std::abs(y)) std::swap(x, y);
      const double high = x + y, low = y - (high - x);
      if (low != 0) parts[kept++] = low;
      x = high;
    }
    parts.resize(kept);
    parts.push_back(x);
  }
  if (parts.empty()) return 0;
  double sum = parts.back(), rest = 0;
  parts.pop_back();
  while (!parts.empty() && rest == 0) {
    const double x = sum, y = parts.back();
    parts.pop_back();
    sum = x + y;
    rest = y - (sum - x);
  }
  // Half-way between two doubles, and more of the same sign follows: away from the even one.
  if (!parts.empty() && ((rest < 0 && parts.back() < 0) || (rest > 0 && parts.back() > 0))) {
    const double up = sum + 2 * rest;
    if (up - sum == 2 * rest) sum = up;
  }
  return sum;
}

/// Doubles of both signs whose exponents are spread over 2^-spread ... 2^spread. Those that underflow lose digits.
std::vector<double> wild(std::size_t count, int spread, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> exponent(-spread, spread);
  std::normal_distribution<double> digits;
  std::vector<double> addends(count);
  for (double& x : addends) x = std::ldexp(digits(random), exponent(random));
  return addends;
}

TEST(ExactSum, AgreesWithAnotherExactWay) {
  for (const int spread : {0, 1, 30, 60, 200, 1000, 1080})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      std::vector<double> addends = wild(1 + 10 * seed, std::min(spread, 1000), seed);
      if (spread > 1000)
        for (double& x : addends) x = std::ldexp(x, -spread);  // most are denormal
      EXPECT_EQ(sum_of(addends), by_expansion(addends)) << spread << " " << seed;
      // All that is large goes away again, and leaves what is small.
      const std::size_t count = addends.size();
      for (std::size_t i = 0; i + 1 < count; ++i) addends.push_back(-addends[i]);
      EXPECT_EQ(sum_of(addends), addends[count - 1]);
    }
}

TEST(ExactSum, OfWholeNumbersIsThatOfIntegers) {
  std::mt19937_64 random(3);
  ExactSum sum;
  __extension__ typedef __int128 Wide;
  Wide whole = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto number = static_cast<double>(static_cast<std::int64_t>(random()));
    sum.add(number);
    whole += static_cast<Wide>(number);
    ASSERT_EQ(sum.value(), static_cast<double>(whole)) << i;
  }
}

TEST(ExactSum, RoundsOnceAndTiesToEven) {
  const double half = std::ldexp(1, -53), ulp = 2 * half;  // of 1
  EXPECT_EQ(sum_of({1, half}), 1);
  EXPECT_EQ(sum_of({1, half, smallest}), 1 + ulp);
  EXPECT_EQ(sum_of({1, half, -smallest}), 1);
  EXPECT_EQ(sum_of({1 + ulp, half}), 1 + 2 * ulp);
  EXPECT_EQ(sum_of({-1, -half}), -1);
  EXPECT_EQ(sum_of({-1, -half, -smallest}), -1 - ulp);
  EXPECT_EQ(sum_of({2 - ulp, half}), 2);                    // all digits carry
  EXPECT_EQ(sum_of({0.1, 0.2, -0.3}), std::ldexp(1, -55));  // these three doubles add up to it
}

TEST(ExactSum, OfDenormalsIsExact) {
  EXPECT_EQ(sum_of({smallest}), smallest);
  EXPECT_EQ(sum_of({smallest, smallest, -3 * smallest}), -smallest);
  const double normal = std::numeric_limits<double>::min();
  EXPECT_EQ(sum_of({normal, -smallest}), normal - smallest);
  EXPECT_EQ(sum_of({normal - smallest, smallest}), normal);
  EXPECT_EQ(sum_of(std::vector<double>(1000, smallest)), 1000 * smallest);
}

TEST(ExactSum, ReturnsFromBeyondTheLargestDouble) {
  EXPECT_EQ(sum_of({largest, largest, -largest, -largest, 1}), 1);
  EXPECT_EQ(sum_of({largest, largest, largest, -largest, -largest}), largest);
  std::vector<double> addends(5000, largest);
  addends.insert(addends.end(), 5000, -largest);
  addends.push_back(-smallest);
  EXPECT_EQ(sum_of(addends), -smallest);
  EXPECT_EQ(sum_of({largest, largest}), inf);
  EXPECT_EQ(sum_of({-largest, -largest}), -inf);
  // Half a unit of the last digit beyond the largest double rounds to infinity, less does not.
  const double half = std::ldexp(1, 970);
  EXPECT_EQ(sum_of({largest, half}), inf);
  EXPECT_EQ(sum_of({largest, half, -smallest}), largest);
  ExactSum sum;
  sum.add(std::span<const double>(std::vector<double>{largest, largest}));
  EXPECT_TRUE(sum.finite());  // the addends were
}

TEST(ExactSum, OfNothingIsZero) {
  EXPECT_EQ(sum_of({}), 0);
  EXPECT_FALSE(std::signbit(sum_of({-0.0, -0.0})));
  EXPECT_FALSE(std::signbit(sum_of({-1, 1})));
}

TEST(ExactSum, TellsWhatIsNotFinite) {
  EXPECT_EQ(sum_of({1, inf, -largest}), inf);
  EXPECT_EQ(sum_of({1, -inf, -inf}), -inf);
  EXPECT_TRUE(std::isnan(sum_of({inf, 3, -inf})));
  EXPECT_TRUE(std::isnan(sum_of({nan})));
  EXPECT_TRUE(std::isnan(sum_of({inf, -nan})));
  ExactSum sum;
  sum.add(7);
  EXPECT_TRUE(sum.finite());
  ExactSum other;
  other.add(-inf);
  EXPECT_FALSE(other.finite());
  sum.add(other);
  EXPECT_FALSE(sum.finite());
  EXPECT_EQ(sum.value(), -inf);
}

TEST(ExactSum, HasTheSameBitsInAnyOrderAndOnAnyNumberOfRanks) {
  std::vector<double> addends = wild(3000, 300, 5);
  const double expected = sum_of(addends);
  EXPECT_EQ(expected, by_expansion(addends));
  std::mt19937_64 random(6);
  for (int time = 0; time < 5; ++time) {
    std::shuffle(addends.begin(), addends.end(), random);
    EXPECT_EQ(sum_of(addends), expected);
    ExactSum parts[3], all;
    for (const double x : addends) parts[random() % 3].add(x);
    for (const ExactSum& part : parts) all.add(part);
    EXPECT_EQ(all.value(), expected);
  }
  for (const int size : {1, 2, 3, 7}) {
    std::vector<std::size_t> owner;
    for (std::size_t i = 0; i < addends.size(); ++i) owner.push_back(random() % static_cast<std::size_t>(size));
    on_ranks(size, [&](Communicator& ranks) {
      ExactSum sums[2];
      for (std::size_t i = 0; i < addends.size(); ++i)
        if (owner[i] == static_cast<std::size_t>(ranks.rank())) {
          sums[0].add(addends[i]);
          sums[1].add(-std::abs(addends[i]));
        }
      if (ranks.rank() == 0) sums[1].add(-inf);
      sum_over_ranks(ranks, sums);
      EXPECT_EQ(sums[0].value(), expected);
      EXPECT_EQ(sums[1].value(), -inf);
      sums[0].add(-expected);
      sums[0].add(1);                                                       // goes on
      EXPECT_NEAR(sums[0].value(), 1, std::abs(expected) * 1e-16 + 1e-16);  // one rounding of `expected`
    });
  }
}

/// Doubling takes the words to their limits without a billion additions.
TEST(ExactSum, HasRoomForManyAddends) {
  ExactSum sum;
  sum.add(-largest);
  sum.add(-1);
  for (int times = 0; times < 44; ++times) sum.add(ExactSum(sum));
  sum.add(std::ldexp(1, 45));
  EXPECT_EQ(sum.value(), -inf);
  ExactSum back;
  back.add(largest);
  for (int times = 0; times < 44; ++times) back.add(ExactSum(back));
  sum.add(back);
  EXPECT_EQ(sum.value(), std::ldexp(1, 44));
}

TEST(ExactSum, TakesAsMuchMemoryAsItSays) { EXPECT_EQ(sizeof(ExactSum), 552u); }

}  // namespace
}  // namespace gaussdrift::base
