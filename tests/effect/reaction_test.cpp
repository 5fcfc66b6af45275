// Reaction against closed forms: weights follow exp(-integral of u0) along the path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "scene.hpp"
#include "sim/carrier.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {
namespace {

std::vector<double> factors(const std::vector<std::string>& overrides) {
  Case still = scene_of(overrides);
  still.effects = {};
  const Particles before = particles_at_end(still), after = particles_at_end(scene_of(overrides));
  std::vector<double> list;
  for (std::size_t j = 0; j < before.size(); ++j) list.push_back(after.alpha[j] / before.alpha[j]);
  return list;
}

TEST(Reaction, DecaysExponentially) {
  for (const char* method : {"rk4", "euler", "heun", "rk4-38"})
    for (const double factor : factors({"effects.reaction.rate=0.3", std::string("time.method=") + method}))
      EXPECT_NEAR(factor, std::exp(-0.15), 3.3e-16) << method;  // a constant is integrated exactly: rounding alone
}

class StiffRate : public ::testing::TestWithParam<double> {};

TEST_P(StiffRate, NeitherOvershootsNorLosesItsSign) {
  const Particles after = particles_at_end(scene_of(
      {"effects.reaction.rate=" + std::to_string(GetParam()), "density.height=-2", "time.step=0.1", "time.end=0.5"}));
  // With a reaction every particle is kept, so here too.
  const Particles before =
      particles_at_end(scene_of({"particles.threshold=0", "density.height=-2", "time.step=0.1", "time.end=0.5"}));
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t j = 0; j < after.size(); ++j) {
    EXPECT_LE(after.alpha[j], 0);
    EXPECT_TRUE(std::isfinite(after.alpha[j]));
    const double exact = before.alpha[j] * std::exp(-0.5 * GetParam());
    EXPECT_NEAR(after.alpha[j], exact,
                1.7e-13 * std::abs(exact));  // the exponent, up to 500, is right to 1e-16 of itself: 5.7e-14
  }
}
// Steps of 0.1: an explicit method would need steps below 2/u0.
INSTANTIATE_TEST_SUITE_P(, StiffRate, ::testing::Values(1e6, 1e3, 30., -30., -1e3));

TEST(Reaction, SaysWhereAWeightBecomesTooLarge) {
  try {
    particles_at_end(scene_of({"effects.reaction.rate=-1e3*(1+x)", "time.end=1", "output.times=[0,1]"}));
    FAIL() << "exp(1000) was taken for a number";
  } catch (const NumericalError& error) {
    const std::string text = error.what();
    for (const char* part : {"reaction has made the weight of particle ", "by t = 1", "[effects.reaction]", "at ("})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

TEST(Reaction, SaysWhereItsRateIsNotFinite) {
  try {
    particles_at_end(scene_of({"effects.reaction.rate=1/(t < 0.25 ? 1 : 0)"}));
    FAIL() << "an infinite rate was not noticed";
  } catch (const NumericalError& error) {
    const std::string text = error.what();
    for (const char* part : {"the rate of [effects.reaction] is inf", "in step 3", "t = 0.25", "for particle "})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

TEST(Reaction, IsIntegratedAlongThePath) {
  // u = (1, 0) and u0 = x^3: the integral over the path is ((x0 + t)^4 - x0^4) / 4, and rk4 is exact for cubics.
  const std::vector<std::string> overrides{"velocity.u=[\"1\", \"0\"]", "effects.reaction.rate=x^3"};
  Case still = scene_of(overrides);
  still.effects = {};
  const Particles before = particles_at_end(still), after = particles_at_end(scene_of(overrides));
  for (std::size_t j = 0; j < before.size(); ++j) {
    const double x = before.position[0][j], x0 = x - 0.5;
    const double exact = std::exp(-(std::pow(x, 4) - std::pow(x0, 4)) / 4);
    EXPECT_NEAR(after.alpha[j] / before.alpha[j], exact, 1.8e-15 * exact);
  }
}

TEST(Reaction, HasTheOrderOfTheMethod) {
  // On a rotation with u0 = exp(x sin 2t), against steps so short that their error is rounding.
  const auto weight = [](const char* method, double step) {
    const Particles end = particles_at_end(
        scene_of({"velocity.u=[\"-y\", \"x\"]", "effects.reaction.rate=exp(3*x*sin(2*t))", "time.end=2",
                  "output.times=[2]", "time.step=" + std::to_string(step), std::string("time.method=") + method,
                  "particles.per_axis=5", "particles.overlap=2", "density.radius=1"}));
    return end.alpha[7];
  };
  const double exact = weight("rk4", 0.001);
  const std::pair<const char*, int> methods[] = {{"heun", 2}, {"rk4", 4}, {"rk4-38", 4}};
  for (const auto& [method, order] : methods) {
    const double measured = std::log2(std::abs(weight(method, 0.04) - exact) / std::abs(weight(method, 0.02) - exact));
    EXPECT_NEAR(measured, order, 0.043) << method;  // the next term of the expansion: 0.0144
  }
}

TEST(Reaction, GivesTheSameBitsForAnyThreadsAndFrames) {
  const std::vector<std::string> overrides{"velocity.u=[\"-y\", \"x\"]", "effects.reaction.rate=x*y+t"};
  const Particles one = particles_at_end(scene_of(overrides), 1), two = particles_at_end(scene_of(overrides), 2);
  EXPECT_EQ(one.alpha, two.alpha);
  EXPECT_EQ(one.position, two.position);
}

// --- what is not named is not there ------------------------------------------------------------------------------

TEST(Reaction, OfItsCaseStaysNearTheExactDensity) {
  const Case spec = read_case(SOURCE_DIR "/cases/decay.toml", {"particles.per_axis=150", "evaluate.per_axis=61"}).spec;
  Simulation simulation(spec);
  const RunSummary summary = simulation.run();
  double worst = 0, mass = summary.frames.front().second.mass;
  for (const auto& [time, frame] : summary.frames) {
    ASSERT_TRUE(frame.error.has_value());
    EXPECT_LE(frame.mass, mass);
    mass = frame.mass;
    worst = std::max(worst, frame.error->l1);
  }
  EXPECT_LE(worst, 0.004);  // smoothing of the cone's tip and edge: measured, and rounded up by about a tenth
  EXPECT_GE(worst, 0.002) << "the bound is too wide to notice anything";
}

TEST(Effects, AreConstructedOnlyIfTheCaseNamesThem) {
  const Case transport_alone = scene_of({});
  const Scene scene = make_scene(transport_alone);
  EXPECT_TRUE(Carrier(transport_alone, scene, 1).effects().empty());
  Simulation plain(transport_alone);
  plain.prepare();
  EXPECT_TRUE(plain.particles().path.empty()) << "no array is kept for effects";
  EXPECT_EQ(plain.particles().spread, 0);
  const RunSummary summary = plain.run();
  ASSERT_EQ(summary.effects.size(), 1u);
  EXPECT_EQ(summary.effects[0].name, "transport");
  for (const auto& [stage, seconds] : summary.stages.stages())
    EXPECT_EQ(stage.rfind("effect ", 0), std::string::npos) << stage;

  Simulation reacting(scene_of({"effects.reaction.rate=1"}));
  const RunSummary reacted = reacting.run();
  ASSERT_EQ(reacted.effects.size(), 2u);
  EXPECT_EQ(reacted.effects[1].name, "reaction");
  EXPECT_EQ(reacted.effects[1].changes, std::vector<std::string>{"weight"});
  EXPECT_GT(reacted.effects[1].seconds, 0);

  Simulation all(scene_of({"effects.reaction.rate=1", "effects.diffusion.D=0.01", "effects.remesh.every=2"}));
  std::vector<std::string> names;
  for (const EffectSummary& effect : all.run().effects) names.push_back(effect.name);
  EXPECT_EQ(names, (std::vector<std::string>{"transport", "reaction", "diffusion", "remesh"}));
}

}  // namespace
}  // namespace gaussdrift
