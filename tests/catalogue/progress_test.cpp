// What the line of progress says of the time that is left.
#include <gtest/gtest.h>

#include "cli/progress.hpp"

namespace gaussdrift::cli {
namespace {

TEST(SecondsLeft, CountStepsAndOutputsEachByTheirOwn) {
  // 100 s of seeding and one output of two, then one step of a thousand in 2 ms.
  Progress progress{.steps_done = 1,
                    .steps_total = 1000,
                    .length = 1,
                    .seconds = 100.002,
                    .step_seconds = 0.002,
                    .outputs_done = 1,
                    .outputs_total = 2};
  EXPECT_NEAR(seconds_left(progress).value(), 999 * 0.002 + 100, 1e-9);
  progress.outputs_done = 2;
  EXPECT_NEAR(seconds_left(progress).value(), 999 * 0.002, 1e-9);
}

TEST(SecondsLeft, FollowTheTimeOfTheSceneWhereStepsAreChosen) {
  const Progress progress{
      .steps_done = 7, .time = 1.75, .end = 1, .elapsed = 0.25, .length = 1, .seconds = 3, .step_seconds = 3};
  EXPECT_DOUBLE_EQ(seconds_left(progress).value(), 9);
}

TEST(SecondsLeft, AreNotToldBeforeAnythingIsDone) {
  EXPECT_FALSE(seconds_left({.steps_total = 10, .length = 1, .seconds = 60}));
  EXPECT_FALSE(seconds_left(
      {.steps_done = 1, .steps_total = 10, .length = 1, .seconds = 60, .step_seconds = 1, .outputs_total = 1}));
  EXPECT_EQ(progress_text({.steps_total = 10, .length = 1, .seconds = 60}).find("left"), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::cli
