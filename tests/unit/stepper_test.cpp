#include "sim/stepper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "field/named/named_fields.hpp"
#include "field/velocity/expression_field.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {
namespace {

const time::Tableau& rk4 = time::find_tableau("rk4");

Particles some_particles(std::size_t count) {
  Particles particles;
  for (std::size_t j = 0; j < count; ++j) {
    particles.position[0].push_back(std::cos(static_cast<double>(j)));
    particles.position[1].push_back(std::sin(0.7 * static_cast<double>(j)));
    particles.alpha.push_back(1);
    particles.id.push_back(static_cast<std::int64_t>(j));
  }
  return particles;
}

TEST(Stepper, MovesTheSameForAnyThreadsAndBatches) {
  const ExpressionField field({"-y + 0.1*sin(t)", "x"}, {});
  const time::Interval interval(0, 1, 0.03);
  Particles whole = some_particles(1000), parts = whole, threads = whole;
  Stepper(field, rk4, 1).advance(whole, interval, 0, interval.steps(), 0);
  Stepper(field, rk4, 2).advance(threads, interval, 0, interval.steps(), 0);
  for (std::size_t i = 0; i < interval.steps(); ++i) Stepper(field, rk4, 2).advance(parts, interval, i, 1, 0);
  EXPECT_EQ(whole.position, threads.position);
  EXPECT_EQ(whole.position, parts.position);
}

TEST(Stepper, WrittenAndNamedRotationAgreeToTheLastBit) {
  const ExpressionField written({"-y", "x"}, {});
  const auto named = make_named_field("rotation", {.dimension = 2});
  const time::Interval interval(0, 1, 0.01);
  Particles a = some_particles(300), b = a;
  Stepper(written, rk4, 0).advance(a, interval, 0, interval.steps(), 0);
  Stepper(*named, rk4, 0).advance(b, interval, 0, interval.steps(), 0);
  EXPECT_EQ(a.position, b.position);
}

TEST(Stepper, NamesStepTimeParticleAndPlaceOfABadVelocity) {
  // Moves right at unit speed; the square root fails where x > 1.
  const ExpressionField field({"1 + 0*sqrt(1 - x)", "0"}, {});
  Particles particles;
  particles.position[0] = {-1.0, 0.55};
  particles.position[1] = {0.0, 0.25};
  particles.alpha = {1, 1};
  particles.id = {3, 8};
  const Particles before = particles;
  const time::Interval interval(0, 1, 0.1);
  try {
    Stepper(field, rk4, 1).advance(particles, interval, 0, interval.steps(), 100);
    FAIL() << "a velocity that is not finite was not noticed";
  } catch (const NumericalError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("in step 105"), std::string::npos)
        << text;  // from 0.95 at t = 0.4: half a step brings it, by rounding, just beyond 1
    EXPECT_NE(text.find("particle 8"), std::string::npos) << text;
    EXPECT_NE(text.find("t = 0.45"), std::string::npos) << text;
    EXPECT_NE(text.find("(1, 0.25)"), std::string::npos) << text;
  }
  EXPECT_EQ(particles.position, before.position);
}

TEST(Stepper, NoticesAParticleThatLeavesForInfinity) {
  const ExpressionField field({"x*x", "0"}, {});
  Particles particles;
  particles.position[0] = {1e155};
  particles.position[1] = {0};
  particles.alpha = {1};
  particles.id = {0};
  const time::Interval interval(0, 1, 0.5);
  EXPECT_THROW(Stepper(field, rk4, 1).advance(particles, interval, 0, interval.steps(), 0), NumericalError);
}

}  // namespace
}  // namespace gaussdrift
