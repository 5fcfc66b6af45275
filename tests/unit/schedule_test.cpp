#include "time/schedule.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace gaussdrift::time {
namespace {

TEST(Interval, ShortensItsLastStepToLandExactly) {
  const Interval turn(0, 2 * std::numbers::pi, 0.001);
  EXPECT_EQ(turn.steps(), 6284u);  // 6283 full steps and a short one
  EXPECT_EQ(turn.start(6284), 2 * std::numbers::pi);
  EXPECT_EQ(turn.length(0), 0.001);
  EXPECT_NEAR(turn.length(6283), 2 * std::numbers::pi - 6.283, 1e-15);
}

TEST(Interval, TakesNoStepOfRoundingLength) {
  const Interval tenths(0, 0.1 * 3, 0.1);  // 0.1 * 3 is 0.30000000000000004
  EXPECT_EQ(tenths.steps(), 3u);
  EXPECT_EQ(tenths.start(3), 0.1 * 3);
  EXPECT_NEAR(tenths.length(2), 0.1, 8.4e-17);
}

TEST(Interval, TakesOneStepWhereTheStepIsTooLong) {
  const Interval brief(1, 1.25, 10);
  EXPECT_EQ(brief.steps(), 1u);
  EXPECT_EQ(brief.length(0), 0.25);
}

TEST(Interval, TakesNoStepInNoTime) { EXPECT_EQ(Interval(2, 2, 0.1).steps(), 0u); }

TEST(Interval, DoesNotDriftOverMillionsOfSteps) {
  const Interval long_run(0, 1000, 1e-4);
  EXPECT_EQ(long_run.steps(), 10'000'000u);
  EXPECT_EQ(long_run.start(5'000'000), 5'000'000 * 1e-4);
}

}  // namespace
}  // namespace gaussdrift::time
