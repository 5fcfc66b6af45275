// `check` looks at samples: how much it looks at does not grow with the case, and what it says of the case is right.
// Work is counted, in values of density and velocity, not timed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "accuracy/forecast.hpp"
#include "accuracy/picture_seconds.hpp"
#include "accuracy/target.hpp"
#include "accuracy/trial.hpp"
#include "case/built_in.hpp"
#include "case_text.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "render/styles.hpp"

namespace gaussdrift::accuracy {
namespace {

/// A bump of radius 0.2 that is carried once to the right, in 2D or 3D.
std::string text_of(int dimension) {
  const bool space = dimension == 3;
  return case_text({.domain = space ? unit_cube : unit_square,
                    .velocity = space ? velocity_of({"0.1", "0", "0"}) : velocity_of({"0.1", "0"}),
                    .density = shape_of("wendland", space ? "0.5, 0.5, 0.5" : "0.5, 0.5", "0.2"),
                    .time = "end = 1\nstep = 0.5",
                    .evaluate = "per_axis = 20",
                    .reference = not_compared,
                    .output = "frames = 2\nimages = []\nreport = \"none\""});
}

Case bump(std::vector<std::string> overrides, int dimension = 2) {
  return gaussdrift::parse_case(text_of(dimension), "bump.toml", overrides).spec;
}

TEST(Trial, OfAFewParticlesIsTheCase) {
  const Case spec = bump({"particles.per_axis=101"});
  const Trial trial = make_trial(spec, 400'000, 0);
  const Particles all = seed_scene(make_scene(spec), 0);
  EXPECT_TRUE(trial.whole);
  EXPECT_EQ(trial.particles.alpha, all.alpha);
  EXPECT_EQ(trial.particles.position[1], all.position[1]);
  EXPECT_EQ(trial.carried, static_cast<double>(all.size()));
  EXPECT_EQ(trial.grid.points, trial.scene.evaluation.points);
}

// A constant is 1 up to its edges, because their images are summed, too.
TEST(Check, SumsImagesBeyondEdgesAndTellsWhatDoesNotFitThem) {
  const auto told = [](const std::string& velocity) {
    std::string text = text_of(2);
    const auto replace = [&](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace(shape_of("wendland", "0.5, 0.5", "0.2"), "expression = \"1\"");
    replace(velocity_of({"0.1", "0"}), velocity);
    const Case spec =
        gaussdrift::parse_case(text, "one.toml", {"domain.edges=[\"periodic\", \"closed\"]", "particles.per_axis=41"})
            .spec;
    return forecast(spec, 1);
  };
  const Forecast fits = told(velocity_of({"0.1", "0"})), leaks = told(velocity_of({"0.1", "x"}));
  EXPECT_NEAR(fits.density_minimum, 1, 1e-6);
  EXPECT_NEAR(fits.density_maximum, 1, 1e-6);
  EXPECT_TRUE(fits.step_warnings.empty());
  ASSERT_GE(leaks.step_warnings.size(), 2u);
  EXPECT_NE(leaks.step_warnings[0].find("not periodic along x"), std::string::npos) << leaks.step_warnings[0];
  EXPECT_NE(leaks.step_warnings[1].find("goes through a closed edge"), std::string::npos) << leaks.step_warnings[1];
}

// A lattice of up to 2 10^9 points: the density is asked for at a few hundred thousand of them.
TEST(Trial, CountsParticlesFromASample) {
  struct Large {
    int dimension, per_axis;
    double radius;
  };
  for (const Large& large : {Large{2, 5001, 0.2}, Large{2, 40'001, 0.2}, Large{2, 40'001, 0.004}, Large{3, 1001, 0.2},
                             Large{3, 1001, 0.03}}) {
    const Trial trial = make_trial(
        bump({"particles.per_axis=" + std::to_string(large.per_axis), "density.radius=" + std::to_string(large.radius)},
             large.dimension),
        100'000, 0);
    const double ball = large.dimension == 2 ? std::numbers::pi : 4 * std::numbers::pi / 3;
    const double exact = ball * std::pow(large.radius * (large.per_axis - 1), large.dimension);
    EXPECT_NEAR(trial.carried / exact, 1, 0.03) << large.per_axis << ", radius " << large.radius;
    EXPECT_LE(trial.particles.size(), 100'000u);
    EXPECT_LE(trial.looked_at, 1'500'000u) << large.per_axis << ", radius " << large.radius;
    // The mass is that of the case: weights have grown with the cells.
    double mass = 0;
    for (const double alpha : trial.particles.alpha) mass += alpha;
    EXPECT_NEAR(mass / trial.scene.density->mass().value(), 1, 0.02);
  }
}

TEST(Trial, SaysThatItMetNothing) {
  EXPECT_THROW(make_trial(bump({"particles.per_axis=40001", "density.radius=2e-5"}), 100'000, 0), InputError);
  EXPECT_THROW(make_trial(bump({"density.center=[0.51, 0.51]", "density.radius=1e-3"}), 100'000, 0), InputError);
}

TEST(Trial, IsThinnedOutToSelfSimilarOnes) {
  const Case spec = bump({"particles.per_axis=201", "effects.diffusion.D=1e-4"});
  Trial trial = make_trial(spec, 400'000, 0);
  const double carried = trial.carried;
  thin_out(trial, 1000, 0);
  EXPECT_FALSE(trial.whole);
  EXPECT_LE(trial.particles.size(), 1000u);
  EXPECT_GE(trial.particles.size(), 200u);
  EXPECT_EQ(trial.carried, carried);
  const double times = static_cast<double>(trial.part.stride);
  EXPECT_NEAR(trial.scene.core_radius, 2 * trial.scene.seeding.spacing, 1e-15);
  EXPECT_NEAR(trial.spec.effects.find("diffusion")->number("D"), 1e-4 * times * times, 1e-18);  // D/eps^2 stays
}

TEST(Check, OfALargeCaseSamplesAndSaysSo) {
  const Forecast whole = forecast(bump({"particles.per_axis=301"}), 0);
  EXPECT_TRUE(whole.whole);
  EXPECT_TRUE(whole.left_out.empty());
  const Forecast large = forecast(bump({"particles.per_axis=30001"}), 0);
  EXPECT_FALSE(large.whole);
  EXPECT_LE(large.looked_at, 1'500'000u);
  EXPECT_EQ(large.lattice_points, 30'001u * 30'001u);
  EXPECT_NEAR(static_cast<double>(large.particles), 1e4 * static_cast<double>(whole.particles),
              0.02 * static_cast<double>(large.particles));
  EXPECT_EQ(large.left_out.size(), 1u);
  EXPECT_EQ(large.budget.not_covered.find("a prediction follows all particles"), 0u) << large.budget.not_covered;
  EXPECT_NEAR(large.memory_bytes() / (1e4 * whole.particles_at_end * 122), 1, 0.3);  // files in pieces
}

// 800 terms, and paths that fly apart at the rate 4000: following them took 45 s of processor, the run 0.05 s.
TEST(Check, LeavesOutErrorsThatTakeLongerThanTheRun) {
  std::string terms = "0";
  for (int i = 0; i < 800; ++i) terms += "+5*x";
  const Case spec = bump({"velocity.u=[\"" + terms + "\", \"0\"]", "reference.kind=\"characteristics\""});
  EXPECT_GT(make_scene(spec).velocity->cost(), 20);  // of a formula with a sine or two
  const Forecast told = forecast(spec, 0);
  EXPECT_TRUE(told.budget.too_dear) << told.budget.not_covered;
  EXPECT_LE(told.work_of_errors, 3e7);
  EXPECT_LE(told.paths_traced * 20, 2e7);
}

// A vortex for 10^6 units of time: one path from the end to the start takes 10^7 steps.
TEST(Check, TracesAPartOfALongRun) {
  const Case spec = built_in("swirl_remesh", {"params.T=1e6", "particles.per_axis=14", "evaluate.per_axis=14"});
  const Forecast told = forecast(spec, 0);
  EXPECT_EQ(told.steps, 20'000'000u);
  EXPECT_LE(told.paths_traced, 2e7);
  // 5 outputs of 196 points, twice and a half the last: some 10^5 steps of 12 rates of 40 ns each at least.
  EXPECT_GT(told.reference_seconds, 1e-3);
}

TEST(Check, PredictsErrorsWhereTheyTakeLessThanTheRun) {
  const Forecast told = forecast(built_in("rotating_cone", {}), 0);
  EXPECT_TRUE(told.budget.known()) << told.budget.not_covered;
  EXPECT_NEAR(told.budget.total, 0.024, 0.001);  // published: the cone's height falls by that
  EXPECT_TRUE(told.whole);
}

/// Numbers of particles at the outputs of a run.
struct CountParticles : Observer {
  explicit CountParticles(std::vector<double>& counted) : counts(counted) {}
  std::string name() const override { return "count"; }
  void frame(const Frame& frame) override { counts.push_back(static_cast<double>(frame.particles->size())); }
  std::vector<double>& counts;
};

// What a run takes follows from its steps and its particles. Seconds themselves are compared by hand (method.md).
TEST(Check, CountsTheStepsAndTheParticlesOfTheRun) {
  struct Counted {
    std::string name;
    std::vector<std::string> overrides;
  };
  for (const Counted& counted : {
           // Steps chosen by their error, counted in a part of the run.
           Counted{"taylor_green", {"particles.per_axis=60", "evaluate.per_axis=21", "time.method=\"dopri5\""}},
           // Particles that remeshing adds, from every other point of the lattice.
           Counted{"swirl_remesh",
                   {"params.T=2", "particles.per_axis=201", "effects.remesh.stretch=1.2", "evaluate.per_axis=21"}},
           Counted{"shear_diffusion", {"evaluate.per_axis=21"}},
       }) {
    const Case spec = built_in(counted.name, counted.overrides);
    const Forecast told = forecast(spec, 1);
    std::vector<double> counts;
    Simulation simulation(spec, 1);
    simulation.observe(std::make_unique<CountParticles>(counts));
    const RunSummary taken = simulation.run();
    const auto expect_near = [&](double predicted, double counted_in_run, const char* what) {
      EXPECT_LT(predicted / counted_in_run, 1.3) << counted.name << ", " << what;
      EXPECT_GT(predicted / counted_in_run, 1 / 1.3) << counted.name << ", " << what;
    };
    expect_near(static_cast<double>(told.steps), static_cast<double>(taken.steps), "steps");
    double mean = 0;
    for (const double count : counts) mean += count / static_cast<double>(counts.size());
    expect_near(told.particles_at_end, mean, "particles");
    expect_near(told.particles_at_most, *std::max_element(counts.begin(), counts.end()), "particles at most");
  }
}

// Vortex blobs that have spread are summed pair by pair, six times as dear as at the start: what is tried has to be all
// of the particles, for fewer are summed by another method.
TEST(Check, TriesAllParticlesThatMoveEachOtherWhereTheyAreFew) {
  const Forecast told = forecast(built_in("lamb_oseen", {}), 0);
  EXPECT_EQ(told.tried_in_steps, told.particles);
  // Of 130 000 in space, as many as still take the tree.
  const Forecast many = forecast(built_in("charged_ball", {"particles.per_axis=161", "evaluate.per_axis=21"}), 0);
  EXPECT_GE(many.tried_in_steps, 9'000u);
  EXPECT_LE(many.tried_in_steps, 80'000u);
}

TEST(Pictures, CostByStyleNumberAndSize) {
  Case spec = built_in("rotating_cone", {});
  const auto seconds = [&](const char* style, std::size_t points, std::size_t outputs, Redrawn again = {}) {
    spec.output.images = {render::find_style(style).about};
    spec.output.times.assign(outputs, 0.0);
    return seconds_of_pictures(spec, points, again);
  };
  // Ratios alone, which are those of the constants; the two timings of the machine may differ by a half.
  const double one = seconds("heatmap", 10'000, 1), many = seconds("heatmap", 10'000, 101);
  EXPECT_NEAR(many / one, (0.11 + 101 * 0.03) / (0.11 + 0.03), 11);
  EXPECT_GT(seconds("surface", 90'000, 10), 1.2 * seconds("heatmap", 90'000, 10));
  EXPECT_LT(seconds("surface", 10'000'000, 10), 2 * seconds("surface", 90'000, 10));
  EXPECT_GT(seconds("error", 10'000, 100, {.error = true}), 1.2 * seconds("error", 10'000, 100));
  spec.output.images.clear();
  EXPECT_EQ(seconds_of_pictures(spec, 10'000, {}), 0);
}

TEST(Check, OfAnAbsurdCaseSaysThatItDoesNotFit) {
  const Forecast told = forecast(bump({"particles.per_axis=46000"}), 0);
  EXPECT_GT(told.memory_bytes(), 2.5e10);
  EXPECT_LT(told.memory_bytes(), 5e10);
}

TEST(Accuracy, SearchesForABoundedWhileAndSaysWhatItLeftOut) {
  const Case cone = built_in("rotating_cone", {});
  const AccuracyChoice free = choose_for_accuracy(cone, 1e-2, 0);
  EXPECT_TRUE(free.left_out.empty()) << free.left_out;
  EXPECT_LE(free.work, most_work_of_search);
  EXPECT_GE(free.lattices, 4u);
  // With a tenth of that work there is less to choose from, or nothing.
  const double little = 0.1 * free.work;
  try {
    const AccuracyChoice bounded = choose_for_accuracy(cone, 1e-2, 0, {}, little);
    EXPECT_LE(bounded.work, little);
    EXPECT_LT(bounded.lattices, free.lattices);
    EXPECT_NE(to_text(bounded).find("the search is bounded"), std::string::npos) << to_text(bounded);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("the search is bounded"), std::string::npos) << error.what();
  }
  EXPECT_THROW(choose_for_accuracy(cone, 1e-2, 0, {}, 1e4), InputError);
}

}  // namespace
}  // namespace gaussdrift::accuracy
