#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/nan.hpp"
#include "render/colour.hpp"
#include "render/picture.hpp"
#include "render/ticks.hpp"

namespace gaussdrift::render {
namespace {

using Range = std::pair<double, double>;
using base::nan;
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(RoundedRange, OfAConeIsZeroToOne) {
  EXPECT_EQ(rounded_range(0, 0.974870), Range(0, 1));
  EXPECT_EQ(rounded_range(0, 1), Range(0, 1));
  EXPECT_EQ(rounded_range(-3e-17, 0.999), Range(0, 1));
  EXPECT_EQ(rounded_range(0, 0.332916), Range(0, 0.35));
  EXPECT_EQ(rounded_range(0, 42), Range(0, 45));
}

TEST(RoundedRange, LeavesOutOvershootsOfOnePercentOnly) {
  EXPECT_EQ(rounded_range(-0.003, 0.99), Range(0, 1));
  EXPECT_EQ(rounded_range(0, 1.004), Range(0, 1));
  EXPECT_EQ(rounded_range(0, 1.04), Range(0, 1.2));
}

TEST(RoundedRange, CrossesZeroNoFartherThanItMust) {
  EXPECT_EQ(rounded_range(-0.017, 1), Range(-0.02, 1));
  EXPECT_EQ(rounded_range(-0.04, 0.99), Range(-0.05, 1));
  EXPECT_EQ(rounded_range(-0.07, 0.99), Range(-0.1, 1));
  EXPECT_EQ(rounded_range(-0.12, 0.99), Range(-0.2, 1)) << "no farther than to the next multiple of its steps";
  EXPECT_EQ(rounded_range(-100, 3), Range(-100, 5));
  EXPECT_EQ(rounded_range(-0.3, 1), Range(-0.4, 1)) << "more than a step";
}

TEST(RoundedRange, KeepsEndsFarFromZero) {
  EXPECT_EQ(rounded_range(0.5, 0.9), Range(0.5, 0.9));
  EXPECT_EQ(rounded_range(-2, -1.03), Range(-2, -1));
  EXPECT_EQ(rounded_range(-2, -0.1), Range(-2, 0));
}

TEST(RoundedRange, OfAConstantStartsAtZero) {
  EXPECT_EQ(rounded_range(0, 0), Range(0, 1));
  EXPECT_EQ(rounded_range(1, 1), Range(0, 1));
  EXPECT_EQ(rounded_range(-0.5, -0.5), Range(-0.5, 0));
}

TEST(RoundedRange, OfNoNumbersIsZeroToOne) {
  EXPECT_EQ(rounded_range(nan, 1), Range(0, 1));
  EXPECT_EQ(rounded_range(0, infinity), Range(0, 1));
  EXPECT_EQ(rounded_range(infinity, -infinity), Range(0, 1));  // of an empty set
}

TEST(RoundedRange, HoldsAllButOnePercentAtEverySize) {
  for (int e = -300; e <= 300; e += 7)
    for (const double low : {-1.7, -0.2, 0., 0.04, 0.8})
      for (const double high : {0.83, 1., 1.37, 9.99}) {
        const double size = std::pow(10., e);
        const auto [min, max] = rounded_range(low * size, high * size);
        const double slack = 0.0101 * high * size;
        ASSERT_LT(min, max) << low << " " << high << " e" << e;
        ASSERT_LE(min, low * size + slack) << low << " " << high << " e" << e;
        ASSERT_GE(max, high * size - slack) << low << " " << high << " e" << e;
        ASSERT_LE(max - min, 1.7 * (high - std::min(low, 0.)) * size) << "much room is wasted";
      }
}

std::vector<std::string> labels(const Ticks& ticks) {
  std::vector<std::string> list;
  for (const Tick& tick : ticks.list) list.push_back(tick.label);
  return list;
}

using Labels = std::vector<std::string>;

TEST(Ticks, AreRoundAndHaveATrueMinusSign) {
  EXPECT_EQ(labels(make_ticks(-1, 1, 5)), (Labels{"\u22121.0", "\u22120.5", "0.0", "0.5", "1.0"}));
  EXPECT_EQ(labels(make_ticks(0, 100, 5)), (Labels{"0", "20", "40", "60", "80", "100"}));
  EXPECT_EQ(labels(make_ticks(0, 0.3, 3)), (Labels{"0.0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(make_ticks(-1, 1, 5).title("x"), "x");
}

TEST(Ticks, OfSmallNumbersShowAFactor) {
  const Ticks ticks = make_ticks(0, 1e-9, 5);
  EXPECT_EQ(labels(ticks), (Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(ticks.title("x"), "x / 10⁻⁹");
  EXPECT_EQ(make_ticks(0, 5e7, 5).title("x"), "x / 10⁷");
}

TEST(Ticks, OfLogarithmsAreAllPowersOrAllPlain) {
  EXPECT_EQ((Labels{"0.01", "0.1", "1", "10"}), labels({.list = logarithmic_ticks(-2, 1.3, 8)}));
  EXPECT_EQ((Labels{"10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "1", "10"}), labels({.list = logarithmic_ticks(-4, 1.3, 8)}));
  EXPECT_EQ((Labels{"10⁻⁵", "1"}), labels({.list = logarithmic_ticks(-8, 0.3, 2)})) << "not too many";
  EXPECT_EQ((Labels{"5·10⁻⁴", "10⁻³", "2·10⁻³"}), labels({.list = logarithmic_ticks(-3.4, -2.5, 8)}));
  EXPECT_GE(logarithmic_ticks(0.5, 0.51, 5).size(), 2u) << "of a short stretch, too";
  EXPECT_EQ(logarithmic_ticks(-400, 400, 8).size(), 7u) << "beyond what numbers can be";
}

TEST(Numbers, AreToldWithPowersOfTen) {
  EXPECT_EQ(told_number(0.0241, 2), "0.024");
  EXPECT_EQ(told_number(2.4e-5, 2), "2.4·10⁻⁵");
  EXPECT_EQ(told_number(1e-5, 3), "10⁻⁵");
  EXPECT_EQ(told_number(-3e12, 3), "\u22123·10¹²");
  EXPECT_EQ(told_number(1234, 2), "1234") << "no digit before the point is lost";
  EXPECT_EQ(told_number(9.99e-4, 1), "0.001");
  EXPECT_EQ(told_number(0, 3), "0");
}

TEST(Ticks, FarFromZeroShowADifference) {
  const Ticks ticks = make_ticks(1e6, 1e6 + 1, 5);
  EXPECT_EQ(labels(ticks), (Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(ticks.title("x"), "x \u2212 1000000");
  EXPECT_EQ(make_ticks(-1e6, -1e6 + 1, 5).title("y"), "y + 1000000");
}

TEST(Ticks, LieInTheirRangeAndReadAsWhatTheyAre) {
  for (int e = -30; e <= 30; ++e)
    for (const double start : {0., -1., 0.123, 7., 1e3, -1e8})
      for (const int intervals : {1, 2, 5, 10}) {
        const double size = std::pow(10., e), min = start * size, max = (start + 1) * size;
        const Ticks ticks = make_ticks(min, max, intervals);
        for (const Tick& tick : ticks.list) {
          ASSERT_GE(tick.at, min - 1e-5 * size) << start << " e" << e;
          ASSERT_LE(tick.at, max + 1e-5 * size) << start << " e" << e;
          std::string digits = tick.label;
          if (digits.starts_with("\u2212")) digits.replace(0, 3, "-");
          ASSERT_LE(digits.size(), 8u) << tick.label;
          ASSERT_NEAR(ticks.offset + ticks.scale * std::stod(digits), tick.at, 1e-6 * size) << tick.label << " e" << e;
        }
        ASSERT_LE(ticks.list.size(), static_cast<std::size_t>(intervals) + 1);
        if (intervals >= 5) {
          ASSERT_GE(ticks.list.size(), 2u) << start << " e" << e << " " << intervals;
        }
      }
}

TEST(Ticks, OfAnEmptyRangeAreNone) {
  EXPECT_TRUE(make_ticks(1, 1, 5).list.empty());
  EXPECT_TRUE(make_ticks(0, nan, 5).list.empty());
  EXPECT_TRUE(make_ticks(0, infinity, 5).list.empty());
}

double lightness(const Colour& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

TEST(Viridis, GetsLighterWithTheValue) {
  for (int i = 0; i < 200; ++i) EXPECT_LE(lightness(viridis(i / 200.)), lightness(viridis((i + 1) / 200.)));
}

TEST(Viridis, KeepsTheEndsBeyondThem) {
  EXPECT_EQ(viridis(-5), viridis(0));
  EXPECT_EQ(viridis(7), viridis(1));
  EXPECT_EQ(viridis(infinity), viridis(1));
  EXPECT_EQ(viridis(nan), not_a_number);
}

}  // namespace
}  // namespace gaussdrift::render
