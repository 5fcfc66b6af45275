// A run that is stopped and goes on has the bits of one that never stopped: for every effect and for steps that choose
// themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/catalogue.hpp"
#include "effect/catalogue.hpp"
#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "same_particles.hpp"
#include "sim/run_state.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {
namespace {

struct Kind {
  std::string name;
  std::vector<std::string> overrides;
};

Case spec_of(const Kind& kind, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {"particles.per_axis=21", "velocity.u=[\"-y+0.1*x\", \"x\"]",
                                        "output.times=[0, 0.3, 0.5]", "evaluate.per_axis=9"};
  overrides.insert(overrides.end(), kind.overrides.begin(), kind.overrides.end());
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scene_of(overrides);
}

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
  const Case spec = spec_of(GetParam());
  Simulation whole(spec, 1), parts(spec, 1);
  const RunSummary once = whole.run();
  int stops = 0;
  const RunSummary often = run_with_stops(parts, stops);
  EXPECT_GE(stops, 2);
  EXPECT_EQ(once.steps, often.steps);
  ASSERT_EQ(once.frames.size(), often.frames.size());
  for (std::size_t i = 0; i < once.frames.size(); ++i)
    EXPECT_EQ(once.frames[i].second.maximum, often.frames[i].second.maximum);
  expect_same(whole.particles(), parts.particles());
}

/// New particles of an exchange take all steps since the start, which lead from output to output.
TEST(State, DoesNotGrowWithTheOutputs) {
  const auto bytes_after = [](std::size_t outputs) {
    std::string times = "0";
    for (std::size_t i = 1; i <= outputs; ++i)
      times += ", " + std::to_string(0.5 * static_cast<double>(i) / static_cast<double>(outputs));
    Simulation simulation(
        spec_of({"exchange", {"effects.diffusion.D=1e-3", "effects.diffusion.method=particle-exchange"}},
                {"output.times=[" + times + "]"}),
        1);
    simulation.run();
    return parted(simulation.state()).run.size();
  };
  EXPECT_EQ(bytes_after(5), bytes_after(50));
}

TEST_P(StopAndGo, GoesOnInAnotherSimulation) {
  const Case spec = spec_of(GetParam());
  Simulation whole(spec, 1);
  const RunSummary once = whole.run();
  // A new one at every stop, each from what the one before has left.
  auto part = std::make_unique<Simulation>(spec, 1);
  part->on_progress([](const Progress&) { return false; });
  RunSummary summary = part->run();
  while (!summary.complete) {
    auto next = std::make_unique<Simulation>(spec, 2);
    next->restore(part->particles(), part->state());
    next->on_progress([](const Progress&) { return false; });
    summary = next->run();
    part = std::move(next);
  }
  EXPECT_EQ(once.steps, summary.steps);
  EXPECT_EQ(once.steps_rejected, summary.steps_rejected);
  ASSERT_EQ(once.frames.size(), summary.frames.size());
  for (std::size_t i = 0; i < once.frames.size(); ++i) {
    EXPECT_EQ(once.frames[i].first, summary.frames[i].first);
    EXPECT_EQ(once.frames[i].second.maximum, summary.frames[i].second.maximum);
    EXPECT_EQ(once.frames[i].second.stretch, summary.frames[i].second.stretch);
  }
  ASSERT_EQ(once.effects.size(), summary.effects.size());
  for (std::size_t i = 0; i < once.effects.size(); ++i) EXPECT_EQ(once.effects[i].numbers, summary.effects[i].numbers);
  expect_same(whole.particles(), part->particles());
}

// A state in the middle of a leg, where path integrals and halves of exchanges are under way.
TEST_P(StopAndGo, GoesOnFromTheMiddleOfALeg) {
  const Case spec = spec_of(GetParam());
  Simulation whole(spec, 1), saving(spec, 1), resumed(spec, 1);
  whole.run();
  Particles particles;
  std::string state;
  int calls = 0;
  saving.on_progress([&](const Progress& progress) {
    if (progress.time > 0.1 && ++calls == 2) particles = saving.particles(), state = saving.state();
    return true;
  });
  saving.run();
  ASSERT_FALSE(state.empty());
  resumed.restore(particles, state);
  resumed.run();
  expect_same(whole.particles(), resumed.particles());
}

void expect_same(const RunSummary& a, const RunSummary& b) {
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.steps_rejected, b.steps_rejected);
  EXPECT_EQ(a.reference.rates, b.reference.rates);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    EXPECT_EQ(a.frames[i].first, b.frames[i].first);
    EXPECT_EQ(a.frames[i].second.maximum, b.frames[i].second.maximum);
    EXPECT_EQ(a.frames[i].second.stretch, b.frames[i].second.stretch);
    if (a.frames[i].second.error) {
      EXPECT_EQ(a.frames[i].second.error->linf, b.frames[i].second.error->linf);
    }
  }
  ASSERT_EQ(a.effects.size(), b.effects.size());
  for (std::size_t i = 0; i < a.effects.size(); ++i) EXPECT_EQ(a.effects[i].numbers, b.effects[i].numbers);
}

// At any seam: in the middle of a step, of a sum for a density, of paths for the exact density, between observers.
TEST_P(StopAndGo, GoesOnAfterWorkThatWasAbandonedInTheMiddle) {
  const Case spec = spec_of(GetParam(), {"time.step=0.05", "particles.per_axis=15"});
  const auto observed = [](Simulation& simulation) {
    for (const char* name : {"one", "two"}) simulation.observe(name, [](const Frame&) {});
  };
  Simulation whole(spec, 1);
  observed(whole);
  int seams = 0;
  whole.abandon_when([&] {
    ++seams;
    return false;
  });
  const RunSummary once = whole.run();
  constexpr int cuts = 12;
  ASSERT_GT(seams, cuts);
  int abandoned = 0;
  for (int cut = 0; cut < cuts; ++cut) {
    const int at = 1 + static_cast<int>(static_cast<long>(seams - 1) * cut / (cuts - 1));
    Simulation first(spec, 1), second(spec, 1);
    observed(first), observed(second);
    int asked = 0;
    first.abandon_when([&] { return ++asked >= at; });
    try {
      EXPECT_FALSE(first.run().complete) << at;
    } catch (const Abandoned&) {  // while it was prepared
      continue;
    }
    ++abandoned;
    second.restore(first.particles(), first.state());
    const RunSummary rest = second.run();
    expect_same(once, rest);
    expect_same(whole.particles(), second.particles());
  }
  EXPECT_GT(abandoned, cuts / 2);
}

INSTANTIATE_TEST_SUITE_P(
    Effects, StopAndGo,
    testing::Values(
        Kind{"transport", {"time.step=0.0001"}},
        Kind{"adaptive", {"time.method=dopri5", "time.step=0.01", "time.tolerance=1e-10"}},
        Kind{"reaction", {"time.step=0.0001", "effects.reaction.rate=x+1"}},
        Kind{"open_edges",
             {"time.step=0.004", "domain.edges=[\"open\", [\"closed\", \"open\"]]", "effects.reaction.rate=1+x",
              "particles.per_axis=22", "velocity.u=[\"1-y\", \"2*x\"]"}},
        Kind{"adaptive_open_edges",
             {"time.method=dopri5", "time.step=0.01", "time.tolerance=1e-10", "domain.edges=[\"open\", \"open\"]",
              "velocity.u=[\"1-y\", \"2*x\"]"}},
        Kind{"sources",
             {"time.step=0.0005", "source.point=[0.2, 0.3]", "source.from=0.05", "source.to=0.45", "source.rate=1+t",
              "source.puffs=13", "effects.reaction.rate=1+x"}},
        Kind{"tracers", {"density.name=A", "density.gain=-(1+x)*A", "time.step=0.0001"}},
        Kind{"tracers_exchange",
             {"density.name=A", "density.gain=-(1+x)*A", "density.diffusion=0.004", "time.step=0.01",
              "effects.diffusion.D=0.01", "effects.diffusion.method=particle-exchange"}},
        Kind{"tracers_spread",
             {"density.name=A", "density.half_life=2", "density.diffusion=0.004", "time.step=0.0001",
              "effects.diffusion.D=0.01"}},
        Kind{"inflow",
             {"time.step=0.0005", "source.face=x_min", "source.concentration=1+y", "source.puffs=13",
              "velocity.u=[\"0.3+0.1*t\", \"x\"]"}},
        Kind{"sources_adaptive",
             {"time.method=dopri5", "time.step=0.01", "time.tolerance=1e-10", "source.shape=gaussian",
              "source.center=[0.1, 0]", "source.radius=0.1", "source.from=0", "source.to=0.4", "source.rate=1",
              "source.puffs=4", "domain.edges=[\"open\", \"open\"]"}},
        Kind{"folded_edges", {"time.step=0.0001", "domain.edges=[\"periodic\", \"closed\"]"}},
        Kind{"core_spreading", {"time.step=0.0001", "effects.diffusion.D=0.01"}},
        Kind{"exchange", {"time.step=0.01", "effects.diffusion.D=0.01", "effects.diffusion.method=particle-exchange"}},
        Kind{"exchange_of_a_field",
             {"time.step=0.01", "effects.diffusion.D_field=0.01*(1+0.5*x+t)",
              "effects.diffusion.method=particle-exchange"}},
        Kind{"ellipses", {"time.step=0.0001", "effects.diffusion.D_axes=[0.01, 0.002]"}},
        Kind{"random_walk",
             {"time.step=0.002", "effects.diffusion.D_field=0.01*(1+0.5*x+t)", "domain.edges=[\"open\", \"closed\"]",
              "effects.diffusion.method=random-walk", "effects.reaction.rate=1+x"}},
        Kind{"remesh", {"time.step=0.01", "effects.remesh.every=3"}},
        Kind{"remesh_edges",
             {"time.step=0.01", "effects.remesh.every=3", "domain.edges=[\"periodic\", [\"open\", \"closed\"]]"}},
        Kind{"exchange_edges",
             {"time.step=0.01", "effects.diffusion.D=0.01", "effects.diffusion.method=particle-exchange",
              "domain.edges=[\"periodic\", \"closed\"]"}},
        Kind{"charge", {"time.step=0.05", "effects.charge.mobility=0.3"}},
        Kind{"vortex", {"time.step=0.05", "effects.vortex.tolerance=1e-6"}},
        Kind{"vortex_and_images",
             {"time.step=0.05", "effects.vortex.tolerance=1e-6", "domain.edges=[\"periodic\", \"closed\"]"}}),
    [](const auto& kind) { return kind.param.name; });

/// What [effects] can have, and no effect.
const std::vector<Kind> all_effects{
    {"transport", {}},
    {"reaction", {"effects.reaction.rate=x+1"}},
    {"core_spreading", {"effects.diffusion.D=0.01"}},
    {"exchange", {"effects.diffusion.D=0.01", "effects.diffusion.method=particle-exchange"}},
    {"random_walk", {"effects.diffusion.D=0.01", "effects.diffusion.method=random-walk"}},
    {"remesh", {"effects.remesh.every=2"}},
    {"remesh_by_stretch", {"effects.remesh.stretch=1.01"}},
    {"charge", {"effects.charge.mobility=0.3"}},
    {"vortex", {"effects.vortex.tolerance=1e-6"}}};

class StopAndGoByEachTableau : public testing::TestWithParam<std::tuple<Kind, time::Tableau>> {
 protected:
  Case spec() const {
    const auto& [kind, tableau] = GetParam();
    std::vector<std::string> more{"particles.per_axis=9", "time.step=0.02", "time.end=0.16",
                                  "output.times=[0, 0.1, 0.16]", "time.method=" + tableau.name};
    if (time::is_adaptive(tableau)) more.push_back("time.tolerance=1e-9");
    return spec_of(kind, more);
  }
};

// At seams that are spread over the run, in a simulation of another process.
TEST_P(StopAndGoByEachTableau, HasTheBitsOfARunThatNeverStopped) {
  const auto& [kind, tableau] = GetParam();
  if ((kind.name == "exchange" || kind.name == "random_walk") &&
      time::is_adaptive(tableau)) {  // it needs steps that are known beforehand
    EXPECT_THROW(spec(), CaseError) << "this can be resumed, too, if it can be run";
    return;
  }
  const Case spec = this->spec();
  Simulation whole(spec, 1);
  int seams = 0;
  whole.abandon_when([&] { return ++seams < 0; });
  const RunSummary once = whole.run();
  EXPECT_GT(once.steps, 3u);
  constexpr int cuts = 8;
  int abandoned = 0;
  for (int cut = 1; cut <= cuts; ++cut) {
    const int at = seams * cut / cuts;
    Simulation first(spec, 1), second(spec, 2);
    int asked = 0;
    first.abandon_when([&] { return ++asked >= at; });
    try {
      EXPECT_FALSE(first.run().complete) << at;
    } catch (const Abandoned&) {  // while it was prepared
      continue;
    }
    ++abandoned;
    second.restore(first.particles(), first.state());
    expect_same(once, second.run());
    expect_same(whole.particles(), second.particles());
  }
  EXPECT_GT(abandoned, cuts / 2);
}

INSTANTIATE_TEST_SUITE_P(All, StopAndGoByEachTableau,
                         testing::Combine(testing::ValuesIn(all_effects), testing::ValuesIn(time::tableaux())),
                         [](const auto& one) {
                           std::string name = std::get<0>(one.param).name + "_" + std::get<1>(one.param).name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(StopAndGo, KnowsAllEffects) {
  for (const NamedEffect& effect : base::catalogue<NamedEffect>())
    EXPECT_TRUE(std::any_of(all_effects.begin(), all_effects.end(), [&](const Kind& kind) {
      return !kind.overrides.empty() &&
             kind.overrides[0].starts_with("effects." + std::string(effect.about.name) + ".");
    })) << effect.about.name;
}

TEST(StopAndGo, ALongerRunGoesOnFromTheEndOfAShorterOne) {
  const Kind kind{"remesh", {"time.step=0.01", "effects.remesh.every=3"}};
  const Case longer = spec_of(kind, {"time.end=1", "output.times=[0, 0.3, 0.5, 1]"});
  Simulation whole(longer, 1), first(spec_of(kind), 1), second(longer, 1);
  const RunSummary once = whole.run();
  first.run();
  second.restore(first.particles(), first.state());
  const RunSummary rest = second.run();
  expect_same(whole.particles(), second.particles());
  ASSERT_EQ(rest.frames.size(), 4u);
  EXPECT_EQ(rest.frames[3].second.maximum, once.frames[3].second.maximum);
  EXPECT_EQ(rest.steps, once.steps);
}

TEST(StopAndGo, AForeignStateIsRefused) {
  const Kind plain{"transport", {}}, remesh{"remesh", {"effects.remesh.every=3"}};
  Simulation a(spec_of(plain), 1), b(spec_of(remesh), 1), c(spec_of(plain), 1),
      d(spec_of(plain, {"time.end=0.2", "output.times=[0]"}), 1);
  a.on_progress([](const Progress&) { return false; });
  a.run();
  EXPECT_THROW(b.restore(a.particles(), a.state()), InputError) << "other effects";
  EXPECT_THROW(c.restore(a.particles(), a.state().substr(0, 40)), InputError) << "cut";
  EXPECT_THROW(d.restore(a.particles(), a.state()), InputError) << "time.end before the state";
}

// By somebody who knows the format: every one of these would index out of bounds, or compute with what is no number.
TEST(StopAndGo, CraftedParticlesAreRefused) {
  const Kind kind{"exchange",
                  {"time.step=0.01", "effects.diffusion.D=0.01", "effects.diffusion.method=particle-exchange",
                   "time.end=0.02", "output.times=[0, 0.02]"}};
  Simulation whole(spec_of(kind), 1);
  whole.run();
  const auto refused = [&](const auto& change) {
    Particles particles = whole.particles();
    change(particles);
    Simulation other(spec_of(kind), 1);
    EXPECT_THROW(other.restore(std::move(particles), whole.state()), InputError);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](Particles& particles) { particles.volume.clear(); });
  refused([](Particles& particles) {
    Particles none;
    none.path.resize(particles.path.size());
    particles = none;
  });
  refused([](Particles& particles) { particles.position[1][3] = nan; });
  refused([](Particles& particles) { particles.alpha[0] = INFINITY; });
  refused([](Particles& particles) { particles.volume[0] = nan; });
  Simulation same(spec_of(kind), 1);
  EXPECT_NO_THROW(same.restore(whole.particles(), whole.state()));
}

// After nine bytes are the times of the leg: from, to, steps, now.
TEST(StopAndGo, CraftedTimesAreRefused) {
  const Kind kind{"transport", {}};
  Simulation whole(spec_of(kind), 1);
  whole.run();
  for (const std::size_t at : {9, 17, 33})
    for (const double wrong : {-1.0, 1e300, static_cast<double>(INFINITY), std::nan("")}) {
      std::string state = whole.state();
      std::memcpy(state.data() + at, &wrong, sizeof wrong);
      Simulation other(spec_of(kind), 1);
      EXPECT_THROW(other.restore(whole.particles(), state), InputError) << at << ": " << wrong;
    }
}

TEST(StopAndGo, ARunThatHasEndedIsNotRunAgain) {
  Simulation simulation(scene_of({"particles.per_axis=11"}));
  EXPECT_TRUE(simulation.run().complete);
  EXPECT_THROW(simulation.run(), std::logic_error);
}

}  // namespace
}  // namespace gaussdrift
