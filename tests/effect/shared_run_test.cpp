// A run that several ranks share has the bits of a run on one: densities, particles and all numbers but seconds.
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "particle/placing.hpp"
#include "ranks_of_threads.hpp"
#include "same_numbers.hpp"
#include "same_particles.hpp"

namespace gaussdrift {
namespace {

struct Kind {
  std::string name;
  std::vector<std::string> overrides;
  std::string refused = {};  // on several ranks, with these words
};

std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }

// A cone of 18 000 particles that turns and leaves its tiles; the smallest are an eighth of the box wide.
Case spec_of(const Kind& kind) {
  std::vector<std::string> overrides = {
      "particles.per_axis=1001", "density.shape=\"wendland\"",       "density.center=[0.4, 0.05]",
      "density.radius=0.15",     "velocity.u=[\"-y+0.1*x\", \"x\"]", "output.times=[0, 0.3, 0.5]",
      "evaluate.per_axis=300",   "evaluate.tile_particles=500",      "output.vtk=[\"particles\"]"};
  overrides.insert(overrides.end(), kind.overrides.begin(), kind.overrides.end());
  return scene_of(overrides);
}

struct Seen {
  double time = 0;
  FrameNumbers numbers;
  std::vector<double> rho, exact, velocity;
  Particles particles;
};

void watch(Simulation& simulation, std::vector<Seen>& seen) {
  simulation.observe("test", [&](const Frame& frame) {
    while (!seen.empty() && seen.back().time >= frame.elapsed) seen.pop_back();  // an output that is shown again
    seen.push_back({frame.elapsed, frame.numbers, frame.density->rho,
                    frame.exact ? *frame.exact : std::vector<double>(),
                    frame.velocity ? *frame.velocity : std::vector<double>(), *frame.particles});
  });
}

void expect_same(const std::vector<Seen>& a, const std::vector<Seen>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].time, b[i].time);
    EXPECT_EQ(a[i].rho, b[i].rho) << "output " << i;
    EXPECT_EQ(a[i].exact, b[i].exact);
    EXPECT_EQ(a[i].velocity, b[i].velocity);
    expect_same(a[i].particles, b[i].particles);
    expect_same(a[i].numbers, b[i].numbers);
  }
}

std::vector<Numbers> effects_of(const RunSummary& summary) {
  std::vector<Numbers> numbers;
  for (const EffectSummary& effect : summary.effects) numbers.push_back(effect.numbers);
  return numbers;
}

class SharedRun : public testing::TestWithParam<Kind> {};

TEST_P(SharedRun, HasTheBitsOfOneRank) {
  const Case spec = spec_of(GetParam());
  Simulation alone(spec, 1);
  std::vector<Seen> expected;
  watch(alone, expected);
  const RunSummary once = alone.run();
  const bool one_tile = GetParam().name.ends_with("one_tile");
  if (GetParam().refused.empty() && !one_tile) {
    EXPECT_NE(once.transform_choice.find(" tiles"), std::string::npos);
  }
  for (const EffectSummary& effect : once.effects)
    for (const auto& [what, number] : effect.numbers)
      if (what == "remeshings") {
        EXPECT_GE(number, 2);
      }
  for (const int size : {2, 3, 4, 8}) {
    std::vector<Seen> seen;
    Particles at_end;
    std::string told;
    const auto ends = ends_on_ranks(size, [&](base::Communicator& ranks) {
      Simulation simulation(spec, 1, ranks);
      if (ranks.rank() == 0) watch(simulation, seen);
      const RunSummary summary = simulation.run();
      EXPECT_EQ(summary.steps, once.steps);
      EXPECT_EQ(summary.particles, once.particles);
      EXPECT_EQ(summary.seeding.carried.front().all, once.seeding.carried.front().all);
      EXPECT_EQ(summary.beyond_at_start, once.beyond_at_start);
      EXPECT_EQ(effects_of(summary), effects_of(once));
      if (!one_tile) {
        EXPECT_LT(simulation.particles().size(), alone.particles().size()) << "they are shared";
      }
      Particles all = simulation.all_particles();
      if (ranks.rank() == 0) at_end = std::move(all);
    });
    for (const auto& end : ends) {
      if (!end) {
        EXPECT_TRUE(GetParam().refused.empty());
        continue;
      }
      try {
        std::rethrow_exception(end);
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(GetParam().refused), std::string::npos) << error.what();
        EXPECT_FALSE(GetParam().refused.empty()) << error.what();
      }
    }
    if (!GetParam().refused.empty()) continue;
    expect_same(seen, expected);
    expect_same(at_end, alone.particles());
  }
}

/// 3000 particles and few steps, for what is summed over all of them at every stage.
std::vector<std::string> with_few(std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(),
                   {"particles.per_axis=401", "particles.overlap=1", "time.step=0.1", "density.center=[0.25, 0.01]"});
  return overrides;
}

const std::string characteristics = "reference.kind=\"characteristics\"";

std::vector<std::string> with_exchange(const std::vector<std::string>& more) {
  std::vector<std::string> overrides = {"effects.diffusion.D=1e-6", "effects.diffusion.method=\"particle-exchange\"",
                                        "effects.diffusion.tolerance=1e-4"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return overrides;
}

INSTANTIATE_TEST_SUITE_P(
    , SharedRun,
    testing::Values(
        Kind{"transport", {}}, Kind{"adaptive", {"time.method=\"dopri5\"", "time.tolerance=1e-6"}},
        Kind{"reaction", {"effects.reaction.rate=\"1+x\"", characteristics}},
        Kind{"open_edges",
             {"domain.edges=[\"open\", \"periodic\"]", "velocity.u=[\"1.2\", \"0.3*x\"]", "effects.reaction.rate=1+x",
              "density.center=[0.4, 0.95]", characteristics, "reference.points=300"}},
        Kind{"inflow",
             {"source.face=x_min", "source.concentration=1+y*y", "source.puffs=5", "velocity.u=[\"0.3\", \"x\"]"}},
        Kind{"tracers", {"density.name=A", "density.gain=-(1+x)*A", "density.half_life=2"}},
        Kind{"tracers_spread",
             {"density.name=A", "density.diffusion=3e-7", "effects.diffusion.D=1e-6",
              "effects.diffusion.method=\"core-spreading\""}},
        Kind{"tracers_exchange", with_exchange({"density.name=A", "density.gain=-(1+x)*A", "density.diffusion=3e-7"})},
        Kind{"backwards", {"time.start=0.9", "time.end=0.5", "output.times=[0.9, 0.7, 0.5]"}},
        Kind{"sources",
             {"source.shape=gaussian", "source.center=[0.1, 0.3]", "source.radius=0.012", "source.from=0.1",
              "source.to=0.4", "source.rate=1+t", "source.puffs=3", "effects.reaction.rate=1+x",
              "domain.edges=[\"open\", \"periodic\"]", "velocity.u=[\"1.2\", \"0.3*x\"]"}},
        Kind{"folded_edges",
             {"domain.edges=[\"closed\", \"periodic\"]", "velocity.u=[\"0.3*(1-x^2)\", \"0.5\"]",
              "density.center=[0.92, 0.9]", characteristics, "reference.points=300"}},
        Kind{"spreading", {"effects.diffusion.D=1e-6", "effects.diffusion.method=\"core-spreading\""}},
        Kind{"ellipses", {"effects.diffusion.D_axes=[1e-6, 2e-7]", "effects.diffusion.D_xy=1e-7"}},
        Kind{"random_walk",
             {"effects.diffusion.D_field=1e-6*(1+x^2)", "effects.diffusion.method=\"random-walk\"",
              "domain.edges=[\"open\", \"periodic\"]"}},
        Kind{"exchange_of_a_field",
             {"effects.diffusion.D_field=1e-6*(1+x^2)", "effects.diffusion.method=\"particle-exchange\"",
              "effects.diffusion.tolerance=1e-4"}},
        Kind{"compared", {characteristics}}, Kind{"everywhere", {characteristics, "reference.points=1000000"}},
        Kind{"formula", {"reference.kind=\"exact\"", "reference.rho=\"exp(-x^2-y^2-t)\""}},
        Kind{"sampled", {characteristics, "reference.points=500"}}, Kind{"threshold", {"particles.threshold=0.01"}},
        Kind{"remesh", {"effects.remesh.every=1"}},
        Kind{"remesh_at_stretch", {"effects.remesh.stretch=1.015", "effects.remesh.kernel=\"m4prime\""}},
        Kind{"remesh_adaptive",
             {"effects.remesh.every=2", "time.method=\"dopri5\"", "time.tolerance=1e-6",
              "effects.reaction.rate=\"1+x\"", characteristics}},
        Kind{"remesh_spread",
             {"effects.remesh.every=2", "effects.diffusion.D=1e-6", "effects.diffusion.method=\"core-spreading\""}},
        Kind{"remesh_beyond",  // the domain: ids of nodes there are negative
             {"effects.remesh.every=2", "velocity.u=[\"-0.5\", \"0.3\"]", "density.center=[-0.7, 0.05]"}},
        Kind{"remesh_edges",  // some of them negative ids, which have images
             {"effects.remesh.every=2", "velocity.u=[\"0\", \"0.5\"]", "density.center=[0.9, 0.9]",
              "domain.edges=[\"closed\", [\"open\", \"unbounded\"]]"}},
        Kind{"remesh_one_tile", {"effects.remesh.every=2", "evaluate.tile_particles=1000000"}},
        Kind{"exchange", with_exchange({})},
        Kind{"exchange_on_one_tile", with_exchange({"evaluate.tile_particles=1000000"})},
        Kind{"exchange_remesh", with_exchange({"effects.remesh.every=2", "effects.reaction.rate=\"1+x\""})},
        Kind{"exchange_beyond",  // the domain: ids of nodes there are negative
             with_exchange({"velocity.u=[\"-0.5\", \"0.3\"]", "density.center=[-0.7, 0.05]"})},
        Kind{"exchange_edges", with_exchange({"velocity.u=[\"0.4\", \"0.1\"]", "density.center=[0.9, 0.95]",
                                              "domain.edges=[\"periodic\", [\"unbounded\", \"closed\"]]"})},
        Kind{"vortex", with_few({"effects.vortex.tolerance=1e-2"})},
        Kind{"vortex_one_tile", with_few({"effects.vortex.tolerance=1e-2", "evaluate.tile_particles=1000000"})},
        Kind{"vortex_adaptive",
             with_few({"effects.vortex.tolerance=1e-2", "time.method=\"dopri5\"", "time.tolerance=1e-3"})},
        Kind{"charge_adaptive",
             with_few({"effects.charge.mobility=0.1", "effects.charge.tolerance=1e-2",
                       "effects.charge.density=\"max(0,0.04-(x-0.2)^2-y^2)\"", "effects.reaction.rate=\"1+x\"",
                       "time.method=\"dopri5\"", "time.tolerance=1e-2"})},
        Kind{"vortex_spread", with_few({"effects.vortex.tolerance=1e-2", "effects.diffusion.D=1e-6",
                                        "effects.diffusion.method=\"core-spreading\""})},
        Kind{"vortex_remesh", with_few({"effects.vortex.tolerance=1e-2", "effects.remesh.every=2"})},
        Kind{"charge", with_few({"effects.charge.mobility=0.1", "effects.charge.tolerance=1e-2"})},
        Kind{"charge_of_its_own", with_few({"effects.charge.mobility=0.1", "effects.charge.tolerance=1e-2",
                                            "effects.charge.density=\"max(0,0.04-(x-0.2)^2-y^2)\""})}),
    [](const auto& kind) { return kind.param.name; });

/// What a rank may bring to restore(): neighbours in the order of ids; the last rank of several has none.
Particles brought(const Particles& all, const base::Communicator& ranks) {
  const auto rank = static_cast<std::size_t>(ranks.rank());
  const std::size_t bringing = std::max<std::size_t>(1, static_cast<std::size_t>(ranks.size()) - 1);
  std::vector<std::size_t> own;
  for (std::size_t j = rank * all.size() / bringing; rank < bringing && j < (rank + 1) * all.size() / bringing; ++j)
    own.push_back(j);
  Particles some;
  some.dimension = all.dimension, some.spread = all.spread;
  some.path.resize(all.path.size());
  unpack(pack(all, own), some);
  return some;
}

class Resumed : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(SharedRun, Resumed,
                         testing::Values(Kind{"reaction", {"effects.reaction.rate=\"1+x\"", "time.step=0.001"}},
                                         Kind{"remesh", {"effects.remesh.every=3", "effects.reaction.rate=\"1+x\""}},
                                         Kind{"exchange", with_exchange({})},
                                         Kind{"charge",
                                              with_few({"effects.charge.mobility=0.1", "effects.charge.tolerance=1e-2",
                                                        "effects.charge.density=\"max(0,0.04-(x-0.2)^2-y^2)\""})}),
                         [](const auto& kind) { return kind.param.name; });

TEST_P(Resumed, GoesOnWithAnyNumberOfRanks) {
  const Case spec = spec_of(GetParam());
  Simulation alone(spec, 1);
  std::vector<Seen> expected;
  watch(alone, expected);
  alone.run();
  for (const auto& [before, after] : {std::pair{3, 2}, {1, 4}, {2, 1}}) {
    std::vector<Seen> seen;
    Particles kept;
    std::string state;
    on_ranks(before, [&](base::Communicator& ranks) {
      Simulation simulation(spec, 1, ranks);
      if (ranks.rank() == 0) watch(simulation, seen);
      simulation.on_progress([](const Progress& progress) { return progress.time < 0.35; });
      EXPECT_FALSE(simulation.run().complete);
      Particles all = simulation.all_particles();
      if (ranks.rank() == 0) kept = std::move(all), state = simulation.state();
    });
    on_ranks(after, [&](base::Communicator& ranks) {
      Simulation simulation(spec, 1, ranks);
      if (ranks.rank() == 0) watch(simulation, seen);
      simulation.restore(brought(kept, ranks), ranks.rank() == 0 ? state : "");
      EXPECT_TRUE(simulation.run().complete);
    });
    expect_same(seen, expected);
  }
}

/// A quarter of the particles and of the grid: the run is made many times.
std::vector<std::string> made_often(std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(),
                   {"particles.per_axis=501", "evaluate.per_axis=150", "evaluate.tile_particles=150"});
  return overrides;
}

// Whichever rank is asked, and whatever is under way.
TEST(SharedRunToo, IsAbandonedByAllWhereOneIsAskedToAndGoesOn) {
  for (const Kind& kind : {Kind{"transport", made_often({"time.step=0.01", characteristics})},
                           Kind{"adaptive", made_often({"time.method=\"dopri5\"", "time.tolerance=1e-6"})},
                           Kind{"remesh", made_often({"effects.remesh.every=2", "effects.reaction.rate=\"1+x\""})},
                           Kind{"exchange", made_often(with_exchange({}))},
                           Kind{"vortex", with_few({"effects.vortex.tolerance=1e-2", "output.times=[0, 0.5]"})}}) {
    const Case spec = spec_of(kind);
    Simulation alone(spec, 1);
    std::vector<Seen> expected;
    watch(alone, expected);
    EXPECT_NE(alone.run().transform_choice.find(" tiles"), std::string::npos);
    for (const int who : {0, 2}) {
      // To the end, if it is never asked; else only to the seam with the number `at` of that rank.
      std::vector<Seen> seen;
      Particles kept;
      std::string state;
      const auto seams_of_run = [&](int at) {
        int seams = 0;
        seen.clear();
        on_ranks(3, [&](base::Communicator& ranks) {
          Simulation simulation(spec, 1, ranks);
          if (ranks.rank() == 0) watch(simulation, seen);
          simulation.prepare();
          simulation.abandon_when([&, asked = ranks.rank() == who] { return asked && ++seams == at; });
          const bool complete = simulation.run().complete;
          EXPECT_EQ(complete, at == 0) << kind << ", seam " << at << " of rank " << who;
          Particles all = simulation.all_particles();
          if (ranks.rank() == 0) kept = std::move(all), state = simulation.state();
        });
        return seams;
      };
      const int seams = seams_of_run(0);
      ASSERT_GT(seams, 10);
      expect_same(seen, expected);
      for (const double part : {0.0, 0.3, 0.5, 0.8, 1.0}) {
        seams_of_run(1 + static_cast<int>(part * (seams - 1)));
        on_ranks(2, [&](base::Communicator& ranks) {
          Simulation simulation(spec, 1, ranks);
          if (ranks.rank() == 0) watch(simulation, seen);
          simulation.restore(ranks.rank() == 0 ? kept : Particles(), ranks.rank() == 0 ? state : "");
          EXPECT_TRUE(simulation.run().complete);
        });
        expect_same(seen, expected);
      }
    }
  }
}

/// Words that the message of one rank and that of three have in common.
void expect_to_fail(const Kind& kind, const std::string& words) {
  const Case spec = spec_of(kind);
  const auto message = [&](const std::exception_ptr& end) -> std::string {
    try {
      if (end) std::rethrow_exception(end);
    } catch (const NumericalError& error) {
      return error.what();
    }
    return "nothing";
  };
  const auto run = [&](base::Communicator& ranks) { Simulation(spec, 1, ranks).run(); };
  for (const int size : {1, 3})
    for (const auto& end : ends_on_ranks(size, run))
      EXPECT_NE(message(end).find(words), std::string::npos) << message(end);
}

TEST(SharedRunToo, EndsOnAllRanksWhereOneFails) {
  const std::string loses_roots = "velocity.u=[\"0.3+sqrt(0.47-x)\", \"0\"]";
  expect_to_fail({"blows up", with_few({loses_roots, "time.step=0.01"})}, "the velocity is");
  expect_to_fail({"vortex", with_few({loses_roots, "effects.vortex.tolerance=1e-2"})}, "the velocity is");
  // The velocity of a stage puts particles nowhere, and the next stage cannot sum.
  expect_to_fail({"adaptive", with_few({loses_roots, "effects.vortex.tolerance=1e-2", "time.method=\"dopri5\""})},
                 "the velocities that particles give each other cannot be summed");
}

}  // namespace
}  // namespace gaussdrift
