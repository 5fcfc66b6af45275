// Steps that have been taken, as bytes: all of them come back, and steps between known times take no bytes.
#include "sim/steps_taken.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace gaussdrift {
namespace {

constexpr double step = 0.03;

/// Whole intervals between neighbours of these times, and the first steps of one more.
StepsTaken taken_over(const std::vector<double>& times, std::size_t first, double last) {
  StepsTaken taken;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const time::Interval interval(times[i - 1], times[i], step);
    for (std::size_t k = i == 1 ? first : 0; k < interval.steps(); ++k) taken.add(interval, k);
  }
  const time::Interval more(times.back(), last, step);
  for (std::size_t k = 0; k < 2; ++k) taken.add(more, k);
  return taken;
}

std::string written(StepsTaken taken, const std::vector<double>& times) {
  base::StateBytes bytes;
  taken.pass(bytes, times, step);
  return bytes.written();
}

StepsTaken read(const std::string& text, const std::vector<double>& times) {
  base::StateBytes bytes(text);
  StepsTaken taken;
  taken.pass(bytes, times, step);
  bytes.end();
  return taken;
}

std::vector<double> times_to(std::size_t count) {
  std::vector<double> times{0};
  for (std::size_t i = 1; i <= count; ++i) times.push_back(0.1 * static_cast<double>(i));
  return times;
}

TEST(StepsTaken, ComeBackWhateverIsKnown) {
  const std::vector<double> times = times_to(9);
  for (const std::size_t first : {0u, 2u}) {
    const StepsTaken taken = taken_over(times, first, 1.0);
    std::vector<double> other_middle = times;
    other_middle[4] = 0.41;
    for (const std::vector<double>& known : {times, std::vector<double>{0}, times_to(4), times_to(20), other_middle})
      EXPECT_EQ(read(written(taken, known), known).parts(), taken.parts());
  }
}

TEST(StepsTaken, TakeAsManyBytesAfterManyOutputsAsAfterFew) {
  const std::vector<double> few = times_to(5), many = times_to(500);
  EXPECT_EQ(written(taken_over(few, 0, 51), few).size(), written(taken_over(many, 0, 51), many).size());
}

TEST(StepsTaken, ToTimesThatAreNotThereAreRefused) {
  const std::vector<double> times = times_to(9);
  const std::string text = written(taken_over(times, 0, 1.0), times);
  EXPECT_THROW(read(text, times_to(8)), std::out_of_range);
  std::vector<double> descending = times, huge = times;
  descending[5] = 0;
  huge.back() = 1e300;
  EXPECT_THROW(read(text, descending), std::out_of_range);
  EXPECT_THROW(read(text, huge), std::out_of_range);
}

}  // namespace
}  // namespace gaussdrift
