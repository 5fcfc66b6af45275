// Bounds on results: which output decides, and what cannot be judged.
#include "sim/checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gaussdrift {
namespace {

using Quantity = CheckSpec::Quantity;

std::vector<std::pair<double, FrameNumbers>> frames() {
  std::vector<std::pair<double, FrameNumbers>> list(3);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto time = static_cast<double>(k);
    list[k].first = time;
    list[k].second.mass = 4 - time;
    list[k].second.error = ErrorNorms{0.125 + 0.03125 * time, 0.25 + 0.03125 * time, 0.5 - 0.03125 * time};
  }
  return list;
}

CheckResult judged(const CheckSpec& check) { return judge({check}, 4, frames(), {}).at(0); }

TEST(Checks, AreDecidedByTheWorstOutput) {
  const CheckResult l1 = judged({.what = Quantity::l1, .max = 0.17});
  EXPECT_FALSE(l1.passed);
  EXPECT_EQ(l1.value, 0.1875);
  EXPECT_EQ(l1.time, 2);
  EXPECT_EQ(l1.text, "L1 = 0.1875 at t = 2, must be at most 0.17");
  EXPECT_TRUE(judged({.what = Quantity::l1, .max = 0.1875}).passed) << "the bound itself is allowed";
  const CheckResult linf = judged({.what = Quantity::linf, .max = 0.75});
  EXPECT_TRUE(linf.passed);
  EXPECT_EQ(linf.time, 0) << "the nearest to the bound";
  EXPECT_TRUE(judged({.what = Quantity::l2, .max = 0.3125, .min = 0.25}).passed);
  EXPECT_FALSE(judged({.what = Quantity::l2, .min = 0.26}).passed);
}

TEST(Checks, OfTheMassAreRelativeToTheStart) {
  EXPECT_TRUE(judged({.what = Quantity::mass, .max = 1, .min = 0.5}).passed);
  const CheckResult kept = judged({.what = Quantity::mass, .max = 1.001, .min = 0.999});
  EXPECT_FALSE(kept.passed);
  EXPECT_EQ(kept.value, 0.5);
}

TEST(Checks, MayLookAtOneOutput) {
  EXPECT_TRUE(judged({.what = Quantity::l1, .max = 0.13, .at = 0}).passed);
  EXPECT_FALSE(judged({.what = Quantity::l1, .max = 0.13, .at = 1}).passed);
}

TEST(Checks, ThatCannotBeJudgedFail) {
  auto list = frames();
  list[1].second.error->linf = std::numeric_limits<double>::quiet_NaN();
  const CheckSpec check{.what = Quantity::linf, .max = 10};
  const CheckResult nan = judge({check}, 4, list, {}).at(0);
  EXPECT_FALSE(nan.passed);
  EXPECT_EQ(nan.time, 1);
  EXPECT_EQ(nan.text, "Linf at t = 1 must be at most 10 but is not known: it is not a number");
  list[1].second.no_norms = "nothing is left to compare (all of the mass has left the domain)";
  EXPECT_EQ(judge({check}, 4, list, {}).at(0).text,
            "Linf at t = 1 must be at most 10 but is not known: nothing is left to compare (all of the mass has left "
            "the domain)");
  list = frames();
  list[2].second.untraced = 1;
  EXPECT_FALSE(judge({check}, 4, list, {}).at(0).passed) << "a norm that leaves points out";
  list = frames();
  list[0].second.error.reset();
  EXPECT_FALSE(judge({check}, 4, list, {}).at(0).passed) << "no reference";
  EXPECT_FALSE(judge({check}, 4, {}, {}).at(0).passed) << "no outputs";
  EXPECT_FALSE(judge({{.what = Quantity::mass, .max = 2}}, 0, frames(), {}).at(0).passed) << "no mass to compare with";
}

}  // namespace
}  // namespace gaussdrift
