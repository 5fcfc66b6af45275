#include "base/repeated_time.hpp"

#include <gtest/gtest.h>

namespace gaussdrift::base {
namespace {

RepeatedTime of(std::initializer_list<double> seconds) {
  RepeatedTime time;
  for (const double each : seconds) time.add(each);
  return time;
}

TEST(RepeatedTime, IsTheFastestIfAnotherComesNearIt) {
  EXPECT_FALSE(of({}).repeatable());
  EXPECT_FALSE(of({1}).repeatable());
  EXPECT_FALSE(of({66.8, 0.7, 92}).repeatable()) << "of a busy machine";
  EXPECT_TRUE(of({66.8, 0.7, 92, 0.75}).repeatable());
  EXPECT_EQ(of({66.8, 0.7, 92, 0.75}).fastest(), 0.7);
  EXPECT_FALSE(of({0.75, 0.74, 0.5}).repeatable()) << "a faster one has to be confirmed again";
}

TEST(RepeatedTime, IsMeasuredAgainWhereItIsLongerThanThatOfDearerWork) {
  using Indices = std::vector<std::size_t>;
  const EnoughTimes enough{.long_enough = 1000, .most = 6};
  EXPECT_EQ(to_measure_again({of({1, 1}), of({2, 2}), of({3, 3})}, enough), Indices{});
  EXPECT_EQ(to_measure_again({of({1, 1}), of({5, 5}), of({3, 3})}, enough), Indices{1});
  EXPECT_EQ(to_measure_again({of({66.8}), of({92}), of({88}), of({0.7, 0.7})}, enough), (Indices{0, 1, 2}));
  EXPECT_EQ(to_measure_again({of({3.1, 3.1}), of({3, 3})}, enough), Indices{}) << "as good as equal";
  EXPECT_EQ(to_measure_again({of({5, 5, 5, 5, 5, 5}), of({3, 3})}, enough), Indices{}) << "measured often enough";
}

TEST(RepeatedTime, OfLongWorkIsMeasuredAgainOnlyOutOfOrder) {
  using Indices = std::vector<std::size_t>;
  const EnoughTimes enough{.long_enough = 10, .most = 6};
  EXPECT_EQ(to_measure_again({of({9}), of({11}), of({12})}, enough), Indices{0});
  EXPECT_EQ(to_measure_again({of({20}), of({11}), of({12})}, enough), Indices{0});
  EXPECT_EQ(to_measure_again({of({20, 10}), of({11}), of({12})}, enough), Indices{0}) << "which of them is right?";
}

}  // namespace
}  // namespace gaussdrift::base
