// Order and error of the time integrators, against exact solutions.
#include "time/runge_kutta.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "field/named/named_fields.hpp"
#include "sim/stepper.hpp"
#include "time/stability.hpp"

namespace gaussdrift {
namespace {

class EveryTableau : public ::testing::TestWithParam<time::Tableau> {};

TEST_P(EveryTableau, IsConsistent) {
  const time::Tableau& rk = GetParam();
  double sum = 0;
  for (int i = 0; i < rk.stages; ++i) {
    sum += rk.b(i);
    double row = 0;
    for (int l = 0; l < i; ++l) row += rk.a(i, l);
    EXPECT_NEAR(row, rk.c(i), 1e-15) << rk.name << ", stage " << i;
  }
  EXPECT_NEAR(sum, 1, 1e-15) << rk.name;
}

TEST_P(EveryTableau, ReachesItsOrderOnATimeDependentProblem) {
  // y' = -2 t y^2, y(0) = 1:  y = 1 / (1 + t^2).
  const auto error = [&](int steps) {
    double y = 1;
    time::Stages work(GetParam(), 1);
    for (int i = 0; i < steps; ++i)
      time::step(
          GetParam(), i * 2.0 / steps, 2.0 / steps,
          [](double t, const double* at, double* rate) { *rate = -2 * t * *at * *at; }, &y, work);
    return std::abs(y - 0.2);
  };
  const double order = std::log2(error(80) / error(160));
  EXPECT_NEAR(order, GetParam().time_order, 0.2) << GetParam().name;  // the next term of the expansion, at h = 1/40
}

INSTANTIATE_TEST_SUITE_P(, EveryTableau, ::testing::ValuesIn(time::tableaux()), [](const auto& tableau) {
  std::string name = tableau.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// --- stability ----------------------------------------------------------------------------------------------------

TEST_P(EveryTableau, MatchesTheExponentialToItsOrder) {
  const std::vector<double> polynomial = time::stability_polynomial(GetParam());
  double factorial = 1;
  for (int k = 0; k <= GetParam().time_order; factorial *= ++k)
    EXPECT_NEAR(polynomial[static_cast<std::size_t>(k)], 1 / factorial, 1e-15) << "coefficient of z^" << k;
}

TEST(Stability, LimitsAreTheKnownOnes) {
  const struct {
    const char* name;
    double imaginary, negative;  // where the boundary of |R| <= 1 crosses the axes; dopri5: s = y^2 with
                                 // s^3 - 25 s^2 + 225 s = 200, from R = 1 + ... + z^5/120 + z^6/600
  } known[] = {{"euler", 0, 2},
               {"heun", 0, 2},
               {"rk4", std::sqrt(8.0), 2.785293563405282},
               {"rk4-38", std::sqrt(8.0), 2.785293563405282},
               {"dopri5", 0.997189, 3.306576}};
  for (const auto& [name, imaginary, negative] : known) {
    const time::Tableau& rk = time::find_tableau(name);
    const auto growth = [&](std::complex<double> z) {
      return std::abs(time::stability_function(time::stability_polynomial(rk), z));
    };
    constexpr double digits = 1e-5;  // of the list above
    if (imaginary > 0) {
      EXPECT_LE(growth({0, imaginary - digits}), 1) << name;
    }
    EXPECT_GT(growth({0, imaginary > 0 ? imaginary + digits : 0.1}), 1) << name;
    EXPECT_LE(growth(-negative + digits), 1) << name;
    EXPECT_GT(growth(-negative - digits), 1) << name;
  }
}

TEST(Stability, OfAStepIsJudgedByTheGrowthOverTheRun) {
  const double turn = 2 * std::numbers::pi, infinite = std::numeric_limits<double>::infinity();
  // euler on a rotation: |R|^2 = 1 + theta^2 a step, so the radius grows by about exp(pi theta) a turn.
  const double euler = time::largest_stable_step(time::find_tableau("euler"), {0, 1}, turn, 0.1, infinite);
  EXPECT_NEAR(euler, 0.1 / std::numbers::pi, 4.8e-5);  // the next term of ln(1 + theta^2) is theta^2/2 smaller: 1.6e-5
  // rk4 does not grow below sqrt(8); over many turns the limit sharpens to that.
  EXPECT_NEAR(time::largest_stable_step(time::find_tableau("rk4"), {0, 1}, 1e4, 0.1, infinite), std::sqrt(8.0), 3.3e-5);
  EXPECT_EQ(time::largest_stable_step(time::find_tableau("rk4"), {0, 1}, 1e4, 0.1, 0.5), 0.5);
  EXPECT_EQ(time::largest_stable_step(time::find_tableau("rk4"), 0, 1e4, 0.1, 7), 7) << "a shear has the eigenvalue 0";
}

struct Turn {
  double step, radius_loss, phase_lag;
};
class Rk4OnARotation : public ::testing::TestWithParam<Turn> {};

TEST_P(Rk4OnARotation, HasThePredictedAmplitudeAndPhaseAfterOneTurn) {
  const double end = 2 * std::numbers::pi;
  const auto rotation = make_named_field("rotation", {.dimension = 2});
  const time::Interval interval(0, end, GetParam().step);
  Particles particles;
  particles.position[0] = {1};
  particles.position[1] = {0};
  particles.alpha = {1};
  particles.id = {0};
  Stepper(*rotation, time::find_tableau("rk4"), 1).advance(particles, interval, 0, interval.steps(), 0);
  const double x = particles.position[0][0], y = particles.position[1][0];

  // |A| = 1 - theta^6/144 and a phase error of -theta^5/120 a step, theta the step: summed over the steps taken.
  double radius_loss = 0, phase_lag = 0;
  for (std::size_t i = 0; i < interval.steps(); ++i) {
    radius_loss += std::pow(interval.length(i), 6) / 144;
    phase_lag += std::pow(interval.length(i), 5) / 120;
  }
  const double rounding = 2e-13;  // thousands of steps, each with a few roundings of 1e-16
  EXPECT_NEAR(1 - std::hypot(x, y), radius_loss,
              0.015 * radius_loss + rounding);  // next term: theta^2/8 at theta = 0.2
  EXPECT_NEAR(-std::atan2(y, x), phase_lag, 0.03 * phase_lag + rounding);
  EXPECT_NEAR(radius_loss, GetParam().radius_loss,
              0.05 * GetParam().radius_loss);  // these figures are given to two or three digits
  EXPECT_NEAR(phase_lag, GetParam().phase_lag, 0.05 * GetParam().phase_lag);
}

INSTANTIATE_TEST_SUITE_P(, Rk4OnARotation,
                         ::testing::Values(Turn{0.2, 1.37e-5, 8.15e-5}, Turn{0.1, 4.3e-7, 5.2e-6},
                                           Turn{0.05, 1.3e-8, 3.2e-7}, Turn{0.01, 4.3e-12, 5.2e-10}));

}  // namespace
}  // namespace gaussdrift
