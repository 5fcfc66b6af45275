// Open edges of the domain: what leaves is taken out and counted.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "effect/apart.hpp"
#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"
#include "sim/borders/edges.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {
namespace {

const std::vector<std::string> drifting = {edges("\"open\", \"open\""),
                                           "velocity.u=[\"1\", \"-0.5\"]",
                                           "time.end=1",
                                           "time.step=0.05",
                                           "particles.threshold=0",
                                           "output.frames=5"};

TEST(OpenEdges, CountWhatLeavesByEachFace) {
  const Case spec = scene_of(with(drifting, {"particles.per_axis=40"}));
  const Particles start = seed_scene(make_scene(spec), 1);
  Simulation simulation(spec, 1), threads(spec, 3);
  const RunSummary summary = simulation.run();
  EXPECT_EQ(summary.particles, start.size());
  for (const auto& [time, numbers] : summary.frames) {
    ASSERT_EQ(numbers.left.size(), 4u);
    double inside = 0;
    std::array<std::uint64_t, 4> count{};
    std::array<double, 4> mass{};
    for (std::size_t j = 0; j < start.size(); ++j) {
      // The step at whose end it is beyond; both at once: the farther one.
      int face = -1;
      for (int step = 1; step <= 20 && face < 0 && 0.05 * step < time + 1e-9; ++step) {
        const double over = start.position[0][j] + 0.05 * step - 1, under = -1 - (start.position[1][j] - 0.025 * step);
        if (over > 1e-8 || under > 1e-8) face = over > under ? 1 : 2;
      }
      if (face < 0) {
        inside += start.alpha[j];
        continue;
      }
      ++count[static_cast<std::size_t>(face)];
      mass[static_cast<std::size_t>(face)] += start.alpha[j];
    }
    const char* names[] = {"x_min", "x_max", "y_min", "y_max"};
    for (std::size_t f = 0; f < 4; ++f) {
      EXPECT_EQ(numbers.left[f].reason, names[f]);
      EXPECT_EQ(numbers.left[f].particles, count[f]) << names[f] << " at " << time;
      EXPECT_NEAR(numbers.left[f].mass, mass[f], 1e-16);
    }
    EXPECT_NEAR(*numbers.inside, inside, 1e-16);
    EXPECT_EQ(*numbers.inside, numbers.mass);
    EXPECT_EQ(numbers.outside, 0);
    EXPECT_NEAR(numbers.mass + numbers.left[1].mass + numbers.left[2].mass, summary.frames.front().second.mass, 1e-15);
  }
  EXPECT_GT(summary.frames.back().second.left[1].particles, 500u);
  EXPECT_GT(summary.frames.back().second.left[2].particles, 200u);
  const RunSummary other = threads.run();
  for (std::size_t f = 0; f < 4; ++f)
    EXPECT_EQ(other.frames.back().second.left[f].mass, summary.frames.back().second.left[f].mass);
  EXPECT_EQ(apart(simulation.particles(), threads.particles()), 0);
}

TEST(OpenEdges, CountTheWeightThatIsLeftOfADecayingParticle) {
  const auto left = [](const char* rate) {
    const RunSummary summary =
        Simulation(scene_of(with(drifting, {"particles.per_axis=41", std::string("effects.reaction.rate=") + rate,
                                            "velocity.u=[\"1\", \"0\"]", "density.center=[0.6, 0]",
                                            "density.radius=0.02", "particles.threshold=1e-12"})))
            .run();
    return summary.frames.back().second.left[1].mass / summary.frames.front().second.mass;
  };
  EXPECT_NEAR(left("0"), 1, 1e-12);
  // A particle that starts at x = 0.6 is beyond x = 1 at t = 0.45 (0.4 is on the face).
  // Its neighbours, with exp(-(0.05/0.02)^2) of its weight, leave a step before and after.
  const double light = std::exp(-6.25);
  EXPECT_NEAR(left("2"), std::exp(-2 * 0.45) * (1 + 2 * light * std::cosh(0.1)) / (1 + 2 * light), 1e-9);
}

TEST(OpenEdges, AllMayLeave) {
  CaseTables tables = resting;
  tables.reference = "kind = \"characteristics\"";
  Simulation simulation(scene_of(with(drifting, {"time.end=5", "velocity.u=[\"1\", \"0\"]"}), case_text(tables)));
  const RunSummary summary = simulation.run();
  EXPECT_EQ(simulation.particles().size(), 0u);
  EXPECT_EQ(summary.frames.back().second.mass, 0);
  EXPECT_EQ(summary.frames.back().second.maximum, 0);
  EXPECT_NEAR(summary.frames.back().second.left[1].mass, summary.frames.front().second.mass, 1e-15);
  EXPECT_NE(summary.frames.back().second.no_norms.find("all of the mass has left"), std::string::npos);
}

TEST(OpenEdges, ChargesThatLeavePushNoMore) {
  // The effect keeps charges of its own by particle: they go with the particles.
  const std::vector<std::string> charged = {edges("\"open\", \"open\""),
                                            "effects.charge.mobility=4",
                                            "effects.charge.density=exp(-x^2)",
                                            "time.end=1",
                                            "time.step=0.02",
                                            "density.radius=0.5",
                                            "particles.per_axis=21",
                                            "particles.threshold=1e-3"};
  Simulation once(scene_of(charged), 1);
  const RunSummary summary = once.run();
  EXPECT_LT(once.particles().size(), summary.particles);
  Simulation half(scene_of(charged), 1), rest(scene_of(charged), 1);
  half.on_progress([](const Progress& progress) { return progress.time < 0.7; });
  half.run();
  ASSERT_LT(half.particles().size(), summary.particles);
  rest.restore(half.particles(), half.state());
  rest.run();
  EXPECT_EQ(apart(once.particles(), rest.particles()), 0);
}

TEST(OpenEdges, TakeTheKnownPartOfACloudInAShear) {
  // The checks of the case are that part, from the normal distribution.
  const Case spec =
      gaussdrift::read_case(SOURCE_DIR "/cases/outflow.toml", {"output.images=[]", "evaluate.per_axis=11"}).spec;
  const RunSummary summary = Simulation(spec).run();
  ASSERT_EQ(summary.checks.size(), 4u);
  for (const CheckResult& check : summary.checks) EXPECT_TRUE(check.passed) << check.text;
  EXPECT_EQ(summary.frames.back().second.left[0].particles, 0u) << "nothing leaves where the wind comes in";
}

TEST(OpenEdges, AreCheckedByWhatLeft) {
  const std::string check =
      "\n[[check]]\nwhat = \"left\"\nby = \"x_max\"\nmin = 0.2\nmax = 0.9\nat = 1\n"
      "[[check]]\nwhat = \"left\"\nby = \"x_min\"\nmax = 0\n"
      "[[check]]\nwhat = \"inside\"\nmin = 0.99\n";
  const RunSummary summary = Simulation(scene_of(drifting, resting_gaussian + check)).run();
  ASSERT_EQ(summary.checks.size(), 3u);
  const double left = summary.frames.back().second.left[1].mass / summary.frames.front().second.mass;
  EXPECT_EQ(summary.checks[0].value, left);
  EXPECT_EQ(summary.checks[0].passed, left >= 0.2 && left <= 0.9);
  EXPECT_NE(summary.checks[0].text.find("left by x_max = "), std::string::npos) << summary.checks[0].text;
  EXPECT_TRUE(summary.checks[1].passed);
  EXPECT_FALSE(summary.checks[2].passed);
}

}  // namespace
}  // namespace gaussdrift
