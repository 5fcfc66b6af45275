// Work that is predicted to take longer than it may is refused before it begins, by every method.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "farfield/farfield.hpp"

namespace {

TEST(FarfieldTime, IsRefusedBeforeTheWorkBegins) {
  const farfield::Points<3> points = farfield::Points<3>::Random(3, 1200);
  for (const farfield::Method method : farfield::methods()) {
    farfield::Options options{.tolerance = 1e-3, .method = method};
    const auto plan = [&] { return farfield::Plan<3>(farfield::Kernel::coulomb, points, options); };
    const farfield::Choice choice = plan().choice();
    options.most_seconds = choice.seconds;
    EXPECT_NO_THROW(plan()) << farfield::to_string(method);
    options.most_seconds = choice.seconds / 2;
    try {
      plan();
      ADD_FAILURE() << farfield::to_string(method);
    } catch (const farfield::TimeLimitError& error) {
      EXPECT_EQ(error.seconds, choice.seconds);
      EXPECT_EQ(error.method, choice.method);
      EXPECT_NE(std::string(error.what()).find(farfield::to_string(choice.method) + " would take about 1 s"),
                std::string::npos)
          << error.what();
    }
  }
  farfield::Options wrong;
  wrong.most_seconds = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(farfield::Plan<3>(farfield::Kernel::coulomb, points, wrong), farfield::InvalidArgument);
}

// Numbers in the exception, for those who tell it in other words.
TEST(FarfieldRange, NamesTheTargetThatIsBeyondDoubles) {
  farfield::Points<3> points = farfield::Points<3>::Zero(3, 3);
  points.col(0) << 1, 1, 1;
  points(0, 2) = 1e-200;
  try {
    farfield::Plan<3>(farfield::Kernel::coulomb, points).evaluate(Eigen::VectorXd::Ones(3));
    FAIL() << "nothing was thrown";
  } catch (const farfield::RangeError& error) {
    EXPECT_EQ(error.quantity, "field");
    EXPECT_EQ(error.target, 1u);
  }
}

}  // namespace
