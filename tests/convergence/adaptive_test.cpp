// The integrator behind the reference: its order, and that it is as right as it is asked to be.
#include "time/adaptive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "time/runge_kutta.hpp"

namespace gaussdrift {
namespace {

TEST(DormandPrince, IsConsistentAndIntegratesPolynomialsToDegree7) {
  const time::Tableau& rk = time::dormand_prince_8();
  for (int i = 0; i < rk.stages; ++i) {
    double row = 0;
    for (int l = 0; l < i; ++l) row += rk.a(i, l);
    EXPECT_NEAR(row, rk.c(i), 1.8e-14) << i;  // rounding of coefficients up to 43: 7e-15
  }
  for (int power = 0; power < 8; ++power) {
    double sum = 0;
    for (int i = 0; i < rk.stages; ++i) sum += rk.b(i) * std::pow(rk.c(i), power);
    EXPECT_NEAR(sum, 1.0 / (power + 1), 1.3e-15) << power;
  }
}

TEST(DormandPrince, ReachesOrder8) {
  // y' = -2 t y^2, y(0) = 1:  y = 1 / (1 + t^2).
  const auto error = [&](int steps) {
    double y = 1;
    time::Stages work(time::dormand_prince_8(), 1);
    for (int i = 0; i < steps; ++i)
      time::step(
          time::dormand_prince_8(), i * 2.0 / steps, 2.0 / steps,
          [](double t, const double* at, double* rate) { *rate = -2 * t * *at * *at; }, &y, work);
    return std::abs(y - 0.2);
  };
  EXPECT_NEAR(std::log2(error(8) / error(16)), 8, 0.36);  // the next term, at h = 1/4; smaller steps meet rounding
}

// Two points on circles of radius 1 and 2, the second one slower by half.
void circles(double, const double* y, double* k) {
  k[0] = -y[2], k[2] = y[0];
  k[1] = -0.5 * y[3], k[3] = 0.5 * y[1];
}

TEST(AdaptiveIntegration, KeepsItsToleranceInBothDirections) {
  for (const double tolerance : {1e-6, 1e-9, 1e-12})
    for (const double end : {20., -20.}) {
      const time::AdaptiveOptions options{.components = {{tolerance}, {tolerance}}};
      double y[4] = {1, 2, 0, 0};
      const auto result = time::integrate_adaptively(circles, 0, end, 2, options, y);
      ASSERT_TRUE(result.reached) << result.trouble;
      EXPECT_EQ(result.time, end);
      // Errors of the steps add up; the estimate is one of order 5, so the method itself is better than asked.
      const double allowed = 10 * tolerance;
      EXPECT_NEAR(y[0], std::cos(end), allowed);
      EXPECT_NEAR(y[2], std::sin(end), allowed);
      EXPECT_NEAR(y[1], 2 * std::cos(end / 2), allowed);
      EXPECT_NEAR(y[3], 2 * std::sin(end / 2), allowed);
      EXPECT_LT(result.steps, 120u) << "long steps are the point of order 8";
    }
}

TEST(AdaptiveIntegration, MeasuresTheErrorRelativeToTheStateWhereAsked) {
  // y' = y to e^30: an absolute error of 1e-12 is out of reach there, a relative one is not.
  const time::AdaptiveOptions options{.components = {{0, 1e-12}}};
  double y = 1;
  const auto result =
      time::integrate_adaptively([](double, const double* at, double* k) { *k = *at; }, 0, 30, 1, options, &y);
  ASSERT_TRUE(result.reached);
  EXPECT_NEAR(y / std::exp(30.0), 1, 6.9e-12);  // errors of about 100 steps, and the condition of the problem: 2.3e-12
}

TEST(AdaptiveIntegration, CrossesKinksAndJumps) {
  // y' = |t - 1/3| and y' = sign(t - 1/3): each is one place where steps have to be short.
  const time::AdaptiveOptions options{.components = {{1e-12}, {1e-12}}};
  double y[2] = {0, 0};
  const auto result = time::integrate_adaptively(
      [](double t, const double*, double* k) {
        k[0] = std::abs(t - 1. / 3);
        k[1] = t < 1. / 3 ? -1 : 1;
      },
      0, 1, 1, options, y);
  ASSERT_TRUE(result.reached) << result.trouble;
  EXPECT_NEAR(y[0], 5. / 18, 1.1e-12);
  EXPECT_NEAR(y[1], 1. / 3, 1.1e-12);  // the tolerance
}

TEST(AdaptiveIntegration, DoesNotStepOverWhatItIsToldToSee) {
  // A pulse of length 1/50 in a state at rest: found because no step is longer than 1/100.
  const auto pulse = [](double t, const double*, double* k) { k[0] = t > 0.5 && t < 0.52 ? 1 : 0; };
  time::AdaptiveOptions options{.components = {{1e-12}}, .longest_step = 0.01};
  double y = 0;
  ASSERT_TRUE(time::integrate_adaptively(pulse, 0, 1, 1, options, &y).reached);
  EXPECT_NEAR(y, 0.02, 4.6e-12);  // two jumps, each to the tolerance
  // And a wall of width 1/50 in space, met at speed 1.
  const auto wall = [](double, const double* at, double* k) { k[0] = at[0] > 0.5 && at[0] < 0.52 ? 0.5 : 1; };
  options = {.components = {{1e-12, 0, 0.01}}};
  y = 0;
  ASSERT_TRUE(time::integrate_adaptively(wall, 0, 1, 1, options, &y).reached);
  EXPECT_NEAR(y, 0.98, 7.8e-12);
}

TEST(AdaptiveIntegration, SaysWhereItGoesNoFurther) {
  // y' = y^2, y(0) = 1 ends at t = 1.
  const time::AdaptiveOptions options{.components = {{1e-12, 1e-12}}};
  double y = 1;
  const auto blow_up =
      time::integrate_adaptively([](double, const double* at, double* k) { *k = *at * *at; }, 0, 2, 1, options, &y);
  EXPECT_FALSE(blow_up.reached);
  EXPECT_NEAR(blow_up.time, 1, 5e-13);  // measured 1.8e-13
  EXPECT_FALSE(blow_up.trouble.empty());
  y = -1;
  const auto nowhere =
      time::integrate_adaptively([](double, const double* at, double* k) { *k = std::log(*at); }, 0, 2, 1, options, &y);
  EXPECT_FALSE(nowhere.reached);
  EXPECT_EQ(nowhere.time, 0);
  EXPECT_EQ(nowhere.trouble, "the rate is not finite where it begins");
  time::AdaptiveOptions few = options;
  few.most_steps = 3;
  y = 1;
  EXPECT_EQ(
      time::integrate_adaptively([](double t, const double*, double* k) { *k = std::sin(50 * t); }, 0, 20, 1, few, &y)
          .trouble,
      "too many steps");
}

}  // namespace
}  // namespace gaussdrift
