// [[source]] face = "...": what the velocity carries in through a face of the domain, and runs that start empty.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "same_particles.hpp"

namespace gaussdrift {
namespace {

/// A channel of length 2 and width 1, without a density at the start.
CaseTables channel() {
  return {.domain = "min = [0, 0]\nmax = [2, 1]\nedges = [\"open\", \"periodic\"]",
          .velocity = velocity_of({"1", "0"}),
          .density = "",
          .particles = "per_axis = 41",
          .time = "end = 1\nstep = 0.05",
          .evaluate = "per_axis = 41"};
}

Case channel_with(const std::vector<std::string>& overrides) {
  return parse_case(case_text(channel()), "channel.toml",
                    with({"source.face=x_min", "source.concentration=2", "source.puffs=20"}, overrides))
      .spec;
}

FrameNumbers last(const RunSummary& summary) { return summary.frames.back().second; }

TEST(Inflow, FillsAChannelThatStartsEmpty) {
  Simulation simulation(channel_with({"output.times=[0, 0.5, 1]"}), 1);
  std::vector<double> middle, face;  // at (0.5, 0.5) and (0, 0.5)
  simulation.observe("look", [&](const Frame& frame) {
    EXPECT_EQ(frame.density->lattice.points[0], 41u);
    middle.push_back(frame.density->rho[10 + 41 * 10]);
    face.push_back(frame.density->rho[41 * 10]);
  });
  const RunSummary summary = simulation.run();
  EXPECT_TRUE(summary.complete);
  EXPECT_EQ(summary.particles, 0u);
  EXPECT_EQ(middle[0], 0);
  EXPECT_NEAR(middle[2], 2, 1e-7) << "half a unit behind the front";
  EXPECT_NEAR(face[1], 2, 1e-7) << "what is to come stands beyond the face";
  EXPECT_NEAR(face[2], 2, 1e-7);
  EXPECT_NEAR(last(summary).released.value(), 2, 1e-14);
  EXPECT_NEAR(last(summary).mass, 2, 1e-13);
  EXPECT_EQ(simulation.particle_count(), 20u * 20u) << "one a cell and puff";
  EXPECT_TRUE(std::isnan(summary.frames[0].second.centroid[0]));
}

TEST(Inflow, LeavesNothingBeyondTheFaceWhenItHasEnded) {
  // The fluid that follows is empty: at the face half of what is behind it, as it was for all times before.
  Simulation simulation(channel_with({"source.to=0.5", "source.puffs=10", "output.times=[0.5, 0.55, 1]"}), 1);
  std::vector<double> face;
  simulation.observe("look", [&](const Frame& frame) { face.push_back(frame.density->rho[41 * 10]); });
  simulation.run();
  EXPECT_NEAR(face[0], 2, 1e-7);
  EXPECT_LT(face[1], 1);
  EXPECT_NEAR(face[2], 0, 1e-7);
  // Where nobody says what is beyond the face, there may be particles.
  Simulation plain(channel_with({"domain.edges=[\"unbounded\", \"periodic\"]", "output.times=[1]"}), 1);
  plain.observe("look", [&](const Frame& frame) { EXPECT_NEAR(frame.density->rho[41 * 10], 1, 0.01); });
  plain.run();
}

TEST(Inflow, BringsTheIntegralOfWhatFlowsIn) {
  const auto released = [](const std::vector<std::string>& overrides) {
    return last(Simulation(channel_with(overrides), 1).run()).released.value();
  };
  // c = 1 + x + sin(pi y) t with u = t: the integral of t + (2/pi) t^2 from 0.2 to 0.7.
  EXPECT_NEAR(released({"velocity.u=[\"t\", \"0\"]", "source.concentration=1+x+sin(pi*y)*t", "source.from=0.2",
                        "source.to=0.7"}),
              (0.49 - 0.04) / 2 + 2 / std::numbers::pi * (0.343 - 0.008) / 3, 1e-8);
  // Where the velocity goes out, nothing comes in; what comes in at the upper end goes down.
  EXPECT_NEAR(released({"domain.edges=[\"open\", \"unbounded\"]", "velocity.u=[\"y-0.5\", \"0\"]"}), 2 * 0.125, 1e-14);
  EXPECT_NEAR(released({"source.face=x_max", "velocity.u=[\"-0.5\", \"0\"]"}), 1, 1e-14);
  // Backwards that is the face where the flow goes out.
  EXPECT_NEAR(
      released({"source.face=x_max", "velocity.u=[\"t\", \"0\"]", "time.start=1", "time.end=0", "output.times=[1, 0]"}),
      1, 1e-14);
  EXPECT_NEAR(released({"domain.min=[0, 0, 0]", "domain.max=[2, 1, 0.5]", "velocity.u=[\"1\", \"0\", \"0\"]",
                        "particles.per_axis=13", "evaluate.per_axis=9",
                        "domain.edges=[\"unbounded\", \"unbounded\", \"unbounded\"]", "source.concentration=1+z"}),
              0.5 + 0.125, 1e-13);
}

TEST(Inflow, FollowsTheConcentration) {
  const auto error = [](int per_axis) {
    Simulation simulation(
        channel_with({"particles.per_axis=" + std::to_string(per_axis), "source.puffs=" + std::to_string(per_axis),
                      "source.concentration=1+sin(6*t)", "velocity.u=[\"2\", \"0\"]", "evaluate.tolerance=1e-10"}),
        1);
    double largest = 0;
    simulation.observe("look", [&](const Frame& frame) {
      for (std::size_t i = 12; i <= 28 && frame.time == 1; ++i)  // x from 0.6 to 1.4: far from face and front
        largest =
            std::max(largest, std::abs(frame.density->rho[i + 41 * 7] - 1 - std::sin(6 * (1 - 0.05 * double(i) / 2))));
    });
    simulation.run();
    return largest;
  };
  const double coarse = error(41), fine = error(81);
  EXPECT_NEAR(coarse / fine, 4, 0.4) << "the second order of the blobs";
  EXPECT_LT(fine, 6e-3);
}

TEST(Inflow, KeepsTheBudgetOfMass) {
  const RunSummary summary = Simulation(channel_with({"velocity.u=[\"3\", \"0\"]", "effects.reaction.rate=0.4",
                                                      "source.puffs=60", "time.end=2", "check.what=released",
                                                      "check.min=11.9", "check.at=2", "output.times=[0, 1, 2]"}),
                                        1)
                                 .run();
  const FrameNumbers numbers = last(summary);
  double left = 0;
  for (const Departed& departed : numbers.left) left += departed.mass;
  EXPECT_GT(left, 1);
  EXPECT_NEAR(numbers.mass, numbers.released.value() - left - numbers.decayed.value(), 1e-13);
  EXPECT_TRUE(summary.checks[0].passed);
}

TEST(Inflow, GoesOnWithTheSameBits) {
  const Case spec = channel_with(
      {"velocity.u=[\"1\", \"0.3*sin(t)\"]", "output.times=[0, 0.5, 1]", "source.concentration=c*(1+y)", "params.c=2"});
  Simulation whole(spec, 1), part(spec, 1);
  whole.run();
  int calls = 0;
  part.on_progress([&](const Progress&) { return ++calls < 7; });
  ASSERT_FALSE(part.run().complete);
  Simulation next(scene_of({}, case_text(spec, ".")), 2);
  next.restore(part.particles(), part.state());
  EXPECT_TRUE(next.run().complete);
  expect_same(whole.particles(), next.particles());
}

TEST(Inflow, WarnsOfGapsBetweenPuffs) {
  const RunSummary summary = Simulation(channel_with({"source.puffs=4"}), 1).run();
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_NE(summary.warnings[0].find("what comes in through x_min goes 0.25 from one puff to the next"),
            std::string::npos)
      << summary.warnings[0];
}

TEST(Inflow, RefusesFacesWhereNothingComesIn) {
  const auto refused = [](const std::vector<std::string>& overrides, const std::string& words) {
    const std::string message = message_of<Error>([&] { Simulation(channel_with(overrides), 1).prepare(); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  refused({"source.face=y_min"}, "through y_min, which is periodic, comes what goes out at the other end");
  refused({"domain.edges=[[\"closed\", \"open\"], \"periodic\"]"},
          "nothing can come in through x_min, which is closed");
  refused({"source.face=x_max"}, "nothing can come in through x_max: the velocity does not lead into the domain there");
  refused({"source.face=z_min"}, "the domain has no face z_min");
  refused({"source.rate=1"}, "\"rate\" does not go with \"face\"");
  refused({"source.from=0.5", "source.to=0.2"}, "nothing comes in between \"from\" and \"to\"");
  refused({"source.concentration=1/(t<0.5)"}, "");
}

TEST(Inflow, RefusesARunWithNothing) {
  const std::string message = message_of<CaseError>([] { parse_case(case_text(channel()), "channel.toml", {}); });
  EXPECT_NE(message.find("missing table: [density]"), std::string::npos) << message;
}

}  // namespace
}  // namespace gaussdrift
