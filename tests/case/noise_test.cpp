// The noise of a random walk in the error budget, against what runs with other seeds really miss.
#include "accuracy/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "accuracy/causes.hpp"
#include "case_text.hpp"
#include "gaussdrift/read_case.hpp"

namespace gaussdrift::accuracy {
namespace {

/// rho = 1 in a closed square; its error is that of chance alone.
Case even(const std::vector<std::string>& overrides) {
  const CaseTables tables{.domain = unit_square + "\nedges = [\"closed\", \"periodic\"]",
                          .velocity = at_rest,
                          .density = "expression = \"1\"",
                          .particles = "per_axis = 51\noverlap = 4",
                          .time = "end = 0.4\nstep = 0.05",
                          .evaluate = "per_axis = 41",
                          .reference = "kind = \"exact\"\nrho = \"1\""};
  std::vector<std::string> all{"effects.diffusion.method=random-walk"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return parse_case(case_text(tables), "even.toml", all).spec;
}

/// Means over seeds of the noise that the budget tells, and of the largest error of the density.
struct Means {
  double told = 0, found = 0;
};
Means over_seeds(const std::string& diffusion) {
  constexpr int seeds = 20;
  Means means;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Case spec = even({diffusion, "effects.diffusion.seed=" + std::to_string(seed)});
    LastFrame::Kept last;
    Simulation simulation(spec, 1);
    simulation.observe(std::make_unique<LastFrame>(last, spec.output.times.back()));
    const double error = simulation.run().frames.back().second.error->linf;
    const Budget budget = measure_budget(spec, make_scene(spec), last, Effort::share_of_run, 1);
    EXPECT_TRUE(budget.known()) << budget.not_covered;
    EXPECT_EQ(budget.total, error);
    // Relative to the largest density, which is not 1.
    means.told += budget.noise * (1 + error) / seeds, means.found += error / seeds;
    if (seed > 1) continue;
    EXPECT_EQ(budget.dominates, name_of_noise);
    EXPECT_FALSE(budget.advice.empty());
    const auto json = to_json(budget);
    EXPECT_EQ(json["noise"].get<double>(), budget.noise);
    EXPECT_FALSE(json.contains("smoothing"));
    EXPECT_NE(to_text(budget).find("noise of the walk"), std::string::npos);
    EXPECT_EQ(to_text(budget).find("quadrature"), std::string::npos);
  }
  return means;
}

TEST(NoiseOfAWalk, IsToldAsLargeAsOtherSeedsFindIt) {
  // Largest values of a field of noise differ by a sixth from seed to seed, so their means over 20 by a twentieth.
  const Means far = over_seeds("effects.diffusion.D=0.05");
  EXPECT_NEAR(far.told / far.found, 1, 0.15) << far.told << " " << far.found;
  // Walkers that have gone as far as a blob is wide: 4 D t = eps^2. Without the part of chance it would be 1.4.
  const Means near = over_seeds("effects.diffusion.D=0.004");
  EXPECT_NEAR(near.told / near.found, 1, 0.15) << near.told << " " << near.found;
  EXPECT_LT(near.found, 0.85 * far.found);
}

TEST(NoiseOfAWalk, IsNoCauseWhereNobodyWalks) {
  EXPECT_TRUE(moves_by_chance(even({"effects.diffusion.D=0.05"})));
  const CaseTables tables{.reference = "kind = \"characteristics\""};
  const Case spec = parse_case(case_text(tables), "plain.toml").spec;
  EXPECT_FALSE(moves_by_chance(spec));
  const auto json = to_json(predict_budget(spec, make_scene(spec), Effort::whatever, 1));
  EXPECT_FALSE(json.contains("noise") || json.contains("others"));
  EXPECT_TRUE(json.contains("smoothing"));
}

}  // namespace
}  // namespace gaussdrift::accuracy
