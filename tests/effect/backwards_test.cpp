// time.start, and time.end before it: the clock of a case may begin anywhere and go backwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"
#include "same_particles.hpp"
#include "sim/carrier.hpp"
#include "sim/scene.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {
namespace {

const std::string turning = "velocity.u=[\"-y*(1+sin(3*t))+0.2*x*y\", \"x*(1+sin(3*t))+0.1*t\"]";
const std::vector<std::string> back_from_2{"time.start=2", "time.end=0", "time.step=0.05", "output.times=[2, 1, 0]"};

/// How far particles are from where they started when they have gone from 0.5 to 1.5 and back.
double there_and_back(const std::string& method, double step, const std::vector<std::string>& more) {
  const std::vector<std::string> common = with(
      {"time.method=" + method, "time.step=" + std::to_string(step), "particles.per_axis=15", "output.frames=1"}, more);
  const Case forwards = scene_of(with(common, {"time.start=0.5", "time.end=1.5"})),
             backwards = scene_of(with(common, {"time.start=1.5", "time.end=0.5"}));
  Particles particles = seed_scene(make_scene(forwards), 1);
  const Particles start = particles;
  StageTimes ignored;
  for (const Case* spec : {&forwards, &backwards}) {
    const Scene scene = make_scene(*spec);
    Carrier carrier(*spec, scene, 1);
    carrier.begin(particles);
    carrier.carry(particles, 0, 1, 0, ignored);
  }
  double farthest = 0;
  for (std::size_t j = 0; j < particles.size(); ++j)
    farthest = std::max(farthest, std::hypot(particles.position[0][j] - start.position[0][j],
                                             particles.position[1][j] - start.position[1][j]));
  return farthest;
}

TEST(Backwards, ReturnsParticlesToTheOrderOfTheMethod) {
  for (const time::Tableau& tableau : time::tableaux()) {
    if (time::is_adaptive(tableau)) {
      EXPECT_LT(there_and_back(tableau.name, 1, {turning, "time.tolerance=1e-9"}), 1e-6) << tableau.name;
      continue;
    }
    const double coarse = there_and_back(tableau.name, 0.04, {turning}),
                 fine = there_and_back(tableau.name, 0.01, {turning});
    EXPECT_GT(std::log(coarse / fine) / std::log(4.), tableau.time_order - 0.3) << tableau.name;
    EXPECT_LT(fine, tableau.time_order == 1 ? 0.1 : 1e-2) << tableau.name;
  }
}

TEST(Backwards, ReturnsParticlesThatMoveEachOther) {
  for (const std::string effect : {"effects.vortex.tolerance=1e-10", "effects.charge.mobility=0.5"}) {
    EXPECT_LT(there_and_back("rk4", 0.05, {effect}), 1e-7) << effect;
    EXPECT_GT(there_and_back("euler", 0.05, {effect}), 1e-6) << "they do move: " << effect;
  }
}

TEST(Backwards, HasTheBitsOfTheFlowTurnedRound) {
  for (const std::string method : {"rk4", "dopri5"}) {
    const Particles back = particles_at_end(
        scene_of(with(back_from_2, {"velocity.u=[\"-y*(1+t)\", \"x*t*t\"]", "time.method=" + method})));
    const Particles turned =
        particles_at_end(scene_of({"velocity.u=[\"-(-y*(1+(2-t)))\", \"-(x*(2-t)*(2-t))\"]", "time.end=2",
                                   "time.step=0.05", "output.times=[0, 1, 2]", "time.method=" + method}));
    expect_same(back, turned);
  }
}

TEST(Backwards, TellsTimesOfTheClock) {
  Simulation simulation(scene_of(with(back_from_2, {"velocity.u=[\"t\", \"0\"]", "check.what=mass", "check.min=0.9",
                                                    "check.at=1", "output.vtk=[\"particles\"]"})),
                        1);
  std::vector<double> seen, moving, progressed;
  simulation.observe("look", [&](const Frame& frame) {
    seen.push_back(frame.time);
    EXPECT_EQ(frame.elapsed, 2 - frame.time);
    moving.push_back(frame.velocity->front());
  });
  simulation.on_progress([&](const Progress& progress) {
    EXPECT_EQ(progress.time, 2 - progress.elapsed);
    EXPECT_EQ(progress.end, 0);
    return true;
  });
  const RunSummary summary = simulation.run();
  EXPECT_EQ(seen, (std::vector<double>{2, 1, 0}));
  EXPECT_EQ(moving, seen) << "the velocity as the case has it";
  EXPECT_EQ(summary.time, 0);
  EXPECT_EQ(summary.frames[1].first, 1);
  ASSERT_EQ(summary.checks.size(), 1u);
  EXPECT_EQ(summary.checks[0].time, 1);
  EXPECT_TRUE(summary.checks[0].passed);
}

TEST(Backwards, AgreesWithTheExactDensity) {
  // A turn by 2 + 2 sin(1) backwards.
  const std::string flow = "velocity.u=[\"-y*(1+cos(t))\", \"x*(1+cos(t))\"]", angle = "(2+sin(2)-t-sin(t))",
                    rho = "exp(-((x*cos" + angle + "-y*sin" + angle + "-0.3)^2+(x*sin" + angle + "+y*cos" + angle +
                          ")^2)/0.04)";
  const std::vector<std::string> common = with(back_from_2, {flow, "density.center=[0.3, 0]", "particles.cutoff=gauss6",
                                                             "particles.per_axis=81", "time.step=0.02"});
  const RunSummary formula =
                       Simulation(scene_of(with(common, {"reference.rho=" + rho, "reference.kind=exact"})), 1).run(),
                   paths = Simulation(scene_of(common), 1).run();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(formula.frames[i].second.error.value().linf, 2e-3);
    EXPECT_NEAR(formula.frames[i].second.error.value().linf, paths.frames[i].second.error.value().linf, 1e-8) << i;
  }
  EXPECT_EQ(formula.frames.back().second.mass, formula.frames.front().second.mass);
}

TEST(Backwards, UndoesReactions) {
  // What has decayed comes back.
  const auto mass = [](const std::vector<std::string>& times) {
    const RunSummary summary = Simulation(scene_of(with(times, {"effects.reaction.rate=1+t"})), 1).run();
    return summary.frames.back().second.mass / summary.frames.front().second.mass;
  };
  EXPECT_NEAR(mass({"time.start=1", "time.end=2", "output.times=[1, 2]"}), std::exp(-2.5), 1e-12);
  EXPECT_NEAR(mass({"time.start=2", "time.end=1", "output.times=[2, 1]"}), std::exp(2.5), 1e-10);
}

TEST(Backwards, MeetsSourcesWhenItPassesTheirTimes) {
  const RunSummary summary =
      Simulation(scene_of(with(back_from_2, {"source.point=[0.5, 0]", "source.from=1.5", "source.to=0.5",
                                             "source.rate=t", "source.puffs=10", "velocity.u=[\"-y\", \"x\"]"})),
                 1)
          .run();
  EXPECT_NEAR(summary.frames[1].second.released.value(), (1.5 * 1.5 - 1) / 2, 1e-14);
  EXPECT_NEAR(summary.frames[2].second.released.value(), 1, 1e-14);
  // From 1.5 back to 0 a particle that is released there turns by 1.5.
  Simulation one(scene_of(with(back_from_2, {"source.point=[0.5, 0]", "source.at=1.5", "source.amount=2",
                                             "velocity.u=[\"-y\", \"x\"]"})),
                 1);
  one.run();
  EXPECT_NEAR(one.particles().position[0].back(), 0.5 * std::cos(1.5), 1e-7);
  EXPECT_NEAR(one.particles().position[1].back(), -0.5 * std::sin(1.5), 1e-7);
}

TEST(Backwards, StartsWhereItIsTold) {
  const std::vector<std::string> later{"velocity.u=[\"-y*(1+(t-5))\", \"x\"]", "time.start=5", "time.end=5.5",
                                       "output.times=[5, 5.5]"};
  const Particles shifted = particles_at_end(scene_of(later)),
                  plain = particles_at_end(scene_of({"velocity.u=[\"-y*(1+t)\", \"x\"]", "output.times=[0, 0.5]"}));
  ASSERT_EQ(shifted.size(), plain.size());
  for (std::size_t j = 0; j < plain.size(); ++j)
    for (const std::size_t k : {0u, 1u}) EXPECT_NEAR(shifted.position[k][j], plain.position[k][j], 1e-14);
}

TEST(Backwards, IsWrittenAndReadWithTheSameTimes) {
  for (const std::vector<std::string>& times :
       {std::vector<std::string>{"time.start=0.7", "time.end=0.1", "output.times=[0.7, 0.6, 0.3, 0.1]"},
        {"time.start=0.1", "time.end=0.7", "output.frames=7"},
        {"time.start=-1e3/7", "time.end=1e3/9", "output.frames=9"}}) {
    const Case spec = scene_of(times), again = scene_of({}, case_text(spec, "."));
    EXPECT_EQ(spec.output.times, again.output.times);
    EXPECT_EQ(spec.time.end, again.time.end);
    EXPECT_EQ(spec.time.backwards, again.time.backwards);
    EXPECT_EQ(spec.time.start, again.time.start);
  }
}

TEST(Backwards, GoesOnWithTheSameBits) {
  const Case spec = scene_of({turning, "time.start=1.7", "time.end=0.3", "output.times=[1.7, 1.1, 0.3]",
                              "effects.reaction.rate=0.3+t", "time.step=0.0005"});
  Simulation whole(spec, 1);
  const RunSummary once = whole.run();
  Simulation part(spec, 1);
  part.on_progress([&](const Progress&) { return false; });
  RunSummary summary = part.run();
  ASSERT_FALSE(summary.complete);
  EXPECT_LT(summary.time, 1.7);
  const Case read = scene_of({}, case_text(spec, "."));  // as a resumed run reads it
  Simulation next(read, 2);
  next.restore(part.particles(), part.state());
  summary = next.run();
  EXPECT_EQ(once.steps, summary.steps);
  EXPECT_EQ(once.frames.back().second.maximum, summary.frames.back().second.maximum);
  ASSERT_EQ(summary.frames.size(), 3u);
  EXPECT_EQ(summary.frames[1].first, once.frames[1].first);
  expect_same(whole.particles(), next.particles());
}

std::string refused(const std::vector<std::string>& overrides) {
  return message_of<CaseError>([&] { scene_of(overrides); });
}

TEST(Backwards, RefusesWhatCannotBeUndone) {
  const std::string message = refused({"time.start=1", "time.end=0", "output.frames=2", "effects.diffusion.D=0.1"});
  EXPECT_NE(message.find("the run goes backwards in time, and that does not go with [effects.diffusion]"),
            std::string::npos)
      << message;
}

TEST(Backwards, RefusesTimesThatItDoesNotMeet) {
  const std::vector<std::string> back{"time.start=2", "time.end=1"};
  const auto says = [&](const std::vector<std::string>& more, const std::string& words) {
    const std::string message = refused(with(back, more));
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  says({"output.times=[1, 2]"}, "entry 2 of output.times is 2, not before the entry before it, 1");
  says({"output.times=[2, 0.5]"}, "entry 2 of output.times is 0.5, before time.end = 1");
  says({"output.times=[3, 1]"}, "entry 1 of output.times is 3; the run begins at 2");
  says({"output.frames=2", "time.start=2020-01-03"}, "time.start is a date, and no data of the case have dates");
  says({"output.frames=2", "source.point=[0,0]", "source.at=3", "source.amount=1"},
       "lies before the run, which begins at 2 and goes backwards");
}

TEST(Backwards, TheSourceOfTheGalleryIsFound) {
  // The checks of the case are the cloud that was released, and its mass.
  const Case spec =
      read_case(SOURCE_DIR "/cases/source_finding.toml", {"output.images=[]", "evaluate.per_axis=41"}).spec;
  const RunSummary summary = Simulation(spec).run();
  ASSERT_EQ(summary.checks.size(), 2u);
  for (const CheckResult& check : summary.checks) EXPECT_TRUE(check.passed) << check.text;
}

}  // namespace
}  // namespace gaussdrift
