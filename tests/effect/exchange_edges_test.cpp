// Diffusion by particle exchange where the domain has edges: neighbours are also the images of particles.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "effect/scattered_sums.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "particle/images.hpp"
#include "particle/placing.hpp"
#include "particle/subset.hpp"
#include "ranks_of_threads.hpp"
#include "scene.hpp"
#include "sim/borders/edges.hpp"

namespace gaussdrift {
namespace {

Particles strewn_in(const Domain& domain, std::size_t count) {
  Particles particles;
  particles.dimension = 2;
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double part = std::fmod(static_cast<double>(j + 1) * (k == 0 ? 0.754877666 : 0.569840291), 1);
      particles.position[k].push_back(domain.min[k] + part * (domain.max[k] - domain.min[k]));
    }
    particles.alpha.push_back(1);
    // Negative ids are those of nodes beyond the lattice.
    particles.id.push_back(static_cast<std::int64_t>(j) - 50);
  }
  return particles;
}

// Against the sum over particles and images written out, and with the same bits on any number of ranks.
TEST(ScatteredSumsWithEdges, AreThoseOverAllImages) {
  const Case spec = scene_of({edges(R"("periodic",["closed","unbounded"])"), "particles.per_axis=21"});
  const Folding folding = folding_of(spec.domain);
  const Lattice lattice = seeding_lattice(spec.domain, 21);
  const Particles all = strewn_in(spec.domain, 500);
  const double width = 0.3;
  Eigen::MatrixXd weights(500, 2);
  for (Eigen::Index j = 0; j < 500; ++j) weights(j, 0) = 1 + std::sin(double(j)), weights(j, 1) = std::cos(double(j));
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(500, 2);
  for (std::size_t i = 0; i < 500; ++i)
    for (std::size_t j = 0; j < 500; ++j)
      for (int m = -3; m <= 3; ++m)
        for (const bool mirrored : {false, true}) {
          const double x = all.position[0][j] + 2 * m, y = mirrored ? -2 - all.position[1][j] : all.position[1][j];
          const double dx = all.position[0][i] - x, dy = all.position[1][i] - y;
          expected.row(static_cast<Eigen::Index>(i)) +=
              std::exp(-(dx * dx + dy * dy) / (width * width)) * weights.row(static_cast<Eigen::Index>(j));
        }
  fgtd::Options options;
  options.tolerance = 1e-12;
  base::Communicator alone;
  Eigen::MatrixXd one;
  for (const std::int64_t tile : {std::int64_t{1} << 40, std::int64_t{100}}) {
    const TileLimits limits{.particles = tile, .points = tile};
    ScatteredSums<2> sums("a test", all, lattice, width, limits, options, alone, folding);
    one = sums.of(weights);
    EXPECT_LT((one - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());
    for (const int size : {2, 3})
      on_ranks(size, [&](base::Communicator& ranks) {
        std::vector<std::size_t> chosen;
        for (std::size_t j = 0; j < all.size(); ++j)
          if (j * j % static_cast<std::size_t>(ranks.size()) == static_cast<std::size_t>(ranks.rank()))
            chosen.push_back(j);
        const Particles own = subset(all, chosen);
        Eigen::MatrixXd own_weights(static_cast<Eigen::Index>(chosen.size()), 2);
        for (std::size_t i = 0; i < chosen.size(); ++i)
          own_weights.row(static_cast<Eigen::Index>(i)) = weights.row(static_cast<Eigen::Index>(chosen[i]));
        ScatteredSums<2> shared("a test", own, lattice, width, limits, options, ranks, folding);
        const Eigen::MatrixXd found = shared.of(own_weights);
        for (std::size_t i = 0; i < chosen.size(); ++i)
          EXPECT_EQ(found.row(static_cast<Eigen::Index>(i)), one.row(static_cast<Eigen::Index>(chosen[i]))) << size;
      });
  }
}

// A density between walls, periodic along x, that only diffuses: each cosine decays at its own rate.
TEST(ExchangeWithEdges, DecaysAsItsCosinesDo) {
  const std::vector<std::string> diffusing{edges(R"("periodic","closed")"),
                                           "density.expression=\"2+cos(pi*x)+cos(pi*(y+1)/2)\"",
                                           "particles.per_axis=65",
                                           "particles.overlap=2",
                                           "effects.diffusion.D=0.05",
                                           "time.end=1",
                                           "time.step=0.005",
                                           "output.times=[1]"};
  const std::string no_shape = case_text({.velocity = at_rest,
                                          .density = "expression = \"1\"",
                                          .particles = "per_axis = 41",
                                          .time = "end = 0.5\nstep = 0.1",
                                          .evaluate = "per_axis = 33"});
  Simulation simulation(scene_of(with(diffusing, {"effects.diffusion.method=\"particle-exchange\""}), no_shape));
  const RunSummary summary = simulation.run();
  const Particles& particles = simulation.particles();
  EXPECT_NEAR(summary.frames.back().second.mass, summary.frames.front().second.mass, 1e-14);
  const double pi = std::numbers::pi, cell = std::pow(2.0 / 64, 2);
  double worst = 0;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    const double x = particles.position[0][j], y = particles.position[1][j];
    const double exact =
        2 + std::exp(-0.05 * pi * pi) * std::cos(pi * x) + std::exp(-0.05 * pi * pi / 4) * std::cos(pi * (y + 1) / 2);
    worst = std::max(worst, std::abs(particles.alpha[j] / cell - exact));
  }
  // The exchange multiplies the rate of a wave k by (1 - exp(-q)) / q, q = (eps k)^2 / 4: q = 9.6e-3 for cos(pi x), so
  // its decay of exp(-0.49) is wrong by 0.49 q / 2 exp(-0.49) = 1.4e-3.
  EXPECT_LT(worst, 2e-3);
}

TEST(ExchangeWithEdges, GoesThroughTheSeamWithTheFlow) {
  // The halo of a blob that is carried across a periodic edge and along a wall comes in at the other side.
  const std::vector<std::string> moving{edges(R"("periodic","closed")"),
                                        "velocity.u=[\"1.5\", \"0\"]",
                                        "density.center=[0.5, -0.8]",
                                        "particles.per_axis=41",
                                        "effects.diffusion.D=0.005",
                                        "time.step=0.05",
                                        "time.end=0.5",
                                        "output.times=[0.5]"};
  const auto run = [&](const std::vector<std::string>& more) {
    Simulation simulation(scene_of(with(moving, more)));
    return simulation.run().frames.back().second;
  };
  const FrameNumbers moved = run({"effects.diffusion.method=\"particle-exchange\""}),
                     rest = run({"effects.diffusion.method=\"particle-exchange\"", "velocity.u=[\"0\", \"0\"]"});
  EXPECT_NEAR(moved.maximum, rest.maximum,
              1e-6 * rest.maximum);  // the tolerance of the halo; the grid has a node 0.75 farther on
  EXPECT_NEAR(moved.mass, rest.mass, 1e-14);
}

TEST(ExchangeWithEdges, RefusesOpenOnes) {
  const std::string message = message_of<CaseError>([] {
    scene_of({edges(R"("open","periodic")"), "effects.diffusion.D=0.01",
              "effects.diffusion.method=\"particle-exchange\"", "particles.per_axis=21"});
  });
  EXPECT_NE(message.find("open edges"), std::string::npos) << message;
}

}  // namespace
}  // namespace gaussdrift
