// The error of a fit near points: of the samples around them, not of those far away.
#include "field/fit_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gaussdrift {
namespace {

TEST(FitErrors, AreThoseOfTheSamplesAround) {
  std::vector<double> positions, errors;
  for (int i = 0; i < 20; ++i)  // 20 on the left with small errors, and as many on the right with large ones
    for (const double side : {-1.0, 1.0}) {
      positions.insert(positions.end(), {side, 0.01 * i});
      errors.push_back(side < 0 ? 3e-4 : 0.5);
    }
  errors[0] = NAN;  // was not left out
  const FitErrors fit(2, positions, errors);
  ASSERT_TRUE(fit.known());
  const std::vector<double> x{-1.1, -0.9, 1}, y{0, 0.2, 0.1};
  EXPECT_NEAR(fit.near({2, 2, {x.data(), y.data(), nullptr}}), 3e-4, 1e-12);
  EXPECT_NEAR(fit.near({2, 3, {x.data(), y.data(), nullptr}}), std::sqrt((2 * 9e-8 + 0.25) / 3), 1e-12);
  EXPECT_EQ(fit.near({2, 0, {}}), 0);
  EXPECT_FALSE(FitErrors().known());
  EXPECT_FALSE(FitErrors(2, {0, 0}, {NAN}).known());
}

}  // namespace
}  // namespace gaussdrift
