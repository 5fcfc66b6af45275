// A run that is stopped and goes on has the bits of one that never stopped: for every effect and for steps that choose
// themselves.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "effect/scene.hpp"

namespace gaussdrift {
namespace {

struct Kind {
  std::string name;
  std::vector<std::string> overrides;
};

class StopAndGo : public testing::TestWithParam<Kind> {};

/// Stops at every call of the progress function, which for 441 particles are some 2000 steps apart.
RunSummary run_with_stops(Simulation& simulation, int& stops) {
  simulation.on_progress([](const Progress&) { return false; });
  RunSummary summary = simulation.run();
  for (; !summary.complete; ++stops) {
    EXPECT_LT(summary.time, 0.5);
    summary = simulation.run();
  }
  return summary;
}

TEST_P(StopAndGo, HasTheBitsOfARunThatNeverStopped) {
  std::vector<std::string> overrides = {"particles.per_axis=21", "velocity.u=[\"-y+0.1*x\", \"x\"]",
                                        "output.times=[0, 0.3, 0.5]", "evaluate.per_axis=9"};
  overrides.insert(overrides.end(), GetParam().overrides.begin(), GetParam().overrides.end());
  const Case spec = scene_of(overrides);
  Simulation whole(spec, 1), parts(spec, 1);
  const RunSummary once = whole.run();
  int stops = 0;
  const RunSummary often = run_with_stops(parts, stops);
  EXPECT_GE(stops, 2);
  EXPECT_EQ(once.steps, often.steps);
  ASSERT_EQ(once.frames.size(), often.frames.size());
  for (std::size_t i = 0; i < once.frames.size(); ++i)
    EXPECT_EQ(once.frames[i].second.maximum, often.frames[i].second.maximum);
  EXPECT_EQ(whole.particles().position, parts.particles().position);
  EXPECT_EQ(whole.particles().alpha, parts.particles().alpha);
  EXPECT_EQ(whole.particles().id, parts.particles().id);
  EXPECT_EQ(whole.particles().spread, parts.particles().spread);
}

INSTANTIATE_TEST_SUITE_P(
    Effects, StopAndGo,
    testing::Values(Kind{"transport", {"time.step=0.0001"}},
                    Kind{"adaptive", {"time.method=dopri5", "time.step=0.01", "time.tolerance=1e-10"}},
                    Kind{"reaction", {"time.step=0.0001", "effects.reaction.rate=x+1"}},
                    Kind{"core_spreading", {"time.step=0.0001", "effects.diffusion.D=0.01"}},
                    Kind{"exchange",
                         {"time.step=0.01", "effects.diffusion.D=0.01", "effects.diffusion.method=particle-exchange"}},
                    Kind{"remesh", {"time.step=0.01", "effects.remesh.every=3"}},
                    Kind{"charge", {"time.step=0.05", "effects.charge.mobility=0.3"}},
                    Kind{"vortex", {"time.step=0.05", "effects.vortex.tolerance=1e-6"}}),
    [](const auto& kind) { return kind.param.name; });

TEST(StopAndGo, ARunThatHasEndedIsNotRunAgain) {
  Simulation simulation(scene_of({"particles.per_axis=11"}));
  EXPECT_TRUE(simulation.run().complete);
  EXPECT_THROW(simulation.run(), std::logic_error);
}

}  // namespace
}  // namespace gaussdrift
