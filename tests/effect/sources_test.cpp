// [[source]]: what is released, when, how much of it, and that every unit of mass is accounted for.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"
#include "same_particles.hpp"
#include "scratch_folder.hpp"
#include "sim/landings.hpp"
#include "sim/releases.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {
namespace {

const FrameNumbers& last(const RunSummary& summary) { return summary.frames.back().second; }

RunSummary run(const std::vector<std::string>& overrides) { return Simulation(scene_of(overrides), 1).run(); }

std::vector<std::string> at_a_rate(const std::string& rate, int puffs) {
  return {"source.point=[0.3, 0.2]", "source.from=0.1",           "source.to=0.4",
          "source.rate=" + rate,     "output.times=[0,0.25,0.5]", "source.puffs=" + std::to_string(puffs)};
}

TEST(Sources, ReleaseTheIntegralOfTheirRate) {
  const double exact = 0.3 + std::cos(0.1) - std::cos(0.4);
  for (const int puffs : {1, 7, 100}) {
    const RunSummary summary = run(at_a_rate("1+sin(t)", puffs));
    EXPECT_EQ(summary.frames[0].second.released, 0);
    EXPECT_NEAR(last(summary).released.value(), exact, 2e-16 * puffs) << puffs;
    EXPECT_NEAR(last(summary).mass - summary.frames[0].second.mass, exact, 1e-15 * puffs);
  }
  // A jump within a puff is found to a millionth of it.
  EXPECT_NEAR(last(run(at_a_rate("t < 0.25 ? 2 : 0", 7))).released.value(), 0.3, 2 * 0.3 / 7 * 1e-6);
  // At 0.25 half of the puffs have come, the middle one of 7 among them.
  EXPECT_NEAR(run(at_a_rate("1", 6)).frames[1].second.released.value(), 0.15, 1e-15);
  EXPECT_NEAR(run(at_a_rate("1", 7)).frames[1].second.released.value(), 0.3 * 4 / 7, 1e-15);
}

TEST(Sources, RefuseARateThatIsNotFinite) {
  const std::string message = message_of<NumericalError>([] { run(at_a_rate("1/(t<0.3)", 3)); });
  EXPECT_NE(message.find("the rate \"1/(t<0.3)\" of source 1 is inf at t = 0.3"), std::string::npos) << message;
}

TEST(Sources, OfAShapeAtTheStartAreADensity) {
  const std::vector<std::string> shape{"source.shape=gaussian", "source.center=[0.1, 0]", "source.radius=0.2",
                                       "velocity.u=[\"-y\", \"x\"]", "output.times=[0, 0.5]"};
  Simulation released(scene_of(with(shape, {"source.at=0"})), 1);
  const RunSummary summary = released.run();
  Simulation there(scene_of({"density.center=[0.1, 0]", "velocity.u=[\"-y\", \"x\"]", "output.times=[0, 0.5]"}), 1);
  const RunSummary usual = there.run();
  const Particles &all = released.particles(), &some = there.particles();
  const std::size_t own = all.size() - some.size();  // of the density at the start
  EXPECT_EQ(own, summary.particles);
  for (std::size_t j = 0; j < some.size(); ++j) {
    EXPECT_EQ(all.alpha[own + j], some.alpha[j]);
    EXPECT_EQ(all.position[0][own + j], some.position[0][j]);
    EXPECT_EQ(all.position[1][own + j], some.position[1][j]);
  }
  EXPECT_NEAR(summary.frames[0].second.released.value(), usual.frames[0].second.mass, 1e-15)
      << "before the first output";
  EXPECT_EQ(last(summary).stretch, last(run({"velocity.u=[\"-y\", \"x\"]", "output.times=[0, 0.5]"})).stretch)
      << "the lattice of the start alone";
}

TEST(Sources, AreCarriedFromWhereAndWhenTheyBegin) {
  for (const std::string method : {"rk4", "dopri5"}) {
    Simulation simulation(scene_of({"source.point=[0.5, 0]", "source.amount=3", "source.at=0.2",
                                    "velocity.u=[\"-y\", \"x\"]", "time.method=" + method, "time.step=0.01"}),
                          1);
    simulation.run();
    const Particles& all = simulation.particles();
    EXPECT_EQ(all.alpha.back(), 3);
    EXPECT_NEAR(all.position[0].back(), 0.5 * std::cos(0.3), 1e-8) << method;
    EXPECT_NEAR(all.position[1].back(), 0.5 * std::sin(0.3), 1e-8) << method;
  }
}

TEST(Sources, HaveIdsBeyondTheLatticeWhichNoOtherHas) {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "points.csv")
      << "t,x,y,amount\n0.4,0.1,0.2,1\n0.1,-0.3,0.2,2\n0.1,0.3,0.25,4\n9,0,0,8\n";
  Simulation simulation(
      gaussdrift::parse_case(resting_gaussian, folder.path() / "scene.toml", {"source.points=points.csv"}).spec, 1);
  const RunSummary summary = simulation.run();
  EXPECT_EQ(last(summary).released.value(), 7) << "the last row is later than the run";
  const Particles& all = simulation.particles();
  const std::size_t n = all.size();
  EXPECT_TRUE(std::is_sorted(all.id.begin(), all.id.end()));
  EXPECT_EQ(std::set<std::int64_t>(all.id.begin(), all.id.end()).size(), n);
  EXPECT_EQ((std::vector<double>{all.alpha.end() - 3, all.alpha.end()}), (std::vector<double>{2, 4, 1}));
  EXPECT_EQ((std::vector<std::int64_t>{all.id.end() - 3, all.id.end()}), (std::vector<std::int64_t>{1681, 1682, 1683}));
  EXPECT_EQ((std::vector<double>{all.position[1].end() - 3, all.position[1].end()}),
            (std::vector<double>{0.2, 0.25, 0.2}));
}

TEST(Sources, LandWhereTheyReleaseAndNowhereTwice) {
  const Case spec = scene_of({"source.point=[0, 0]", "source.from=0", "source.to=0.4", "source.rate=1",
                              "source.puffs=4", "output.times=[0, 0.15, 0.5]"});
  const std::vector<double> times = landings(spec), expected{0, 0.05, 0.15, 0.25, 0.35, 0.5};
  ASSERT_EQ(times.size(), expected.size());
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], expected[i], 1e-15);
  EXPECT_EQ(times[2], 0.15) << "the output, not the release beside it";
  EXPECT_EQ(total_steps(spec), 1u + 1 + 1 + 1 + 2);
  EXPECT_EQ(landings(scene_of({"output.times=[0, 0.15, 0.5]"})), (std::vector<double>{0, 0.15, 0.5}));
}

TEST(Sources, CloseTheBudgetOfMass) {
  const std::vector<std::string> flow{"domain.edges=[\"open\", [\"closed\", \"open\"]]",
                                      "velocity.u=[\"3-y\", \"2*x\"]",
                                      "effects.reaction.rate=1+x",
                                      "time.step=0.01",
                                      "output.times=[0, 0.2, 0.5]",
                                      "source.shape=gaussian",
                                      "source.center=[-0.5, 0]",
                                      "source.radius=0.1",
                                      "source.from=0.05",
                                      "source.to=0.45",
                                      "source.rate=2+sin(9*t)",
                                      "source.puffs=20"};
  Simulation simulation(scene_of(flow), 1), threads(scene_of(flow), 3);
  const RunSummary summary = simulation.run();
  const double begun = summary.frames[0].second.mass;
  for (const auto& [time, numbers] : summary.frames) {
    double left = 0;
    for (const Departed& departed : numbers.left) left += departed.mass;
    EXPECT_NEAR(begun + numbers.released.value() - left - numbers.decayed.value(), numbers.mass, 1e-15) << time;
    if (time > 0) {
      EXPECT_GT(left, 1e-4);
      EXPECT_GT(numbers.decayed.value(), 0.001);
      EXPECT_GT(numbers.released.value(), 0.001);
    }
  }
  threads.run();
  expect_same(simulation.particles(), threads.particles());
}

TEST(Sources, OfTheGallerysPlumeComeCloseToItsFormula) {
  const Case spec = read_case(SOURCE_DIR "/cases/plume.toml", {"evaluate.per_axis=61"}).spec;
  const RunSummary summary = Simulation(spec, 1).run();
  for (const auto& [time, numbers] : summary.frames) EXPECT_LT(numbers.error.value().linf, 3e-4) << "t = " << time;
  EXPECT_NEAR(last(summary).released.value(), 2, 1e-14);
  EXPECT_GT(last(summary).decayed.value(), 0);
}

TEST(Sources, OfAPointInAUniformWindAreTheExactPlume) {
  // Blobs of radius eps, released at a rate of 1 since 0: the integral of their densities along the wind.
  const std::vector<std::string> plume{
      "velocity.u=[\"2\", \"0\"]",
      "density.height=1e-9",
      "source.point=[-0.6, 0.1]",
      "source.from=0",
      "source.to=0.5",
      "source.rate=1",
      "time.end=0.5",
      "time.step=0.1",
      "particles.per_axis=41",
      "particles.overlap=4",
      "params.eps=0.2",
      "output.times=[0.25, 0.5]",
      "reference.kind=exact",
      "reference.rho=exp(-((y-0.1)/eps)^2)/(2*sqrt(pi)*eps) * (erf((x+0.6)/eps) - erf((x+0.6-2*t)/eps))/2"};
  const auto error = [&](int puffs) {
    const RunSummary summary = run(with(plume, {"source.puffs=" + std::to_string(puffs)}));
    return std::max(summary.frames[0].second.error->linf, last(summary).error->linf);
  };
  // The middle of a puff: order 2 in its length.
  EXPECT_LT(error(100), 1e-4);
  EXPECT_NEAR(error(20) / error(40), 4, 0.2);
}

TEST(HalfLife, HalvesWeights) {
  Simulation simulation(scene_of({"effects.reaction.half_life=0.25"}), 1);
  const RunSummary summary = simulation.run();
  EXPECT_NEAR(last(summary).mass / make_scene(scene_of({})).density->mass().value(), 0.25, 1e-5);
  Simulation by_rate(scene_of({"effects.reaction.rate=log(2)/0.25"}), 1);
  by_rate.run();
  for (std::size_t j = 0; j < by_rate.particles().size(); ++j)
    EXPECT_NEAR(simulation.particles().alpha[j] / by_rate.particles().alpha[j], 1, 1e-14);
}

}  // namespace
}  // namespace gaussdrift
