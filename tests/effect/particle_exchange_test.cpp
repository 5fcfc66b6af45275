// Diffusion and remeshing against exact covariances: under a linear flow u = A x and
// diffusion D a Gaussian stays one, its centre moves with the flow and Sigma' = A Sigma + Sigma A^T + 2 D I.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "effect/particle_exchange.hpp"
#include "gaussdrift/error.hpp"
#include "scene.hpp"
#include "sim/scene.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {
namespace {

constexpr double sigma0 = 0.02;  // variance of the Gaussian of radius 0.2

// The covariance of the density's diffusing part: that of the weights, and what blobs have spread.
Moments covariance(const Particles& particles) {
  Moments m = moments_of(particles);
  m.xx += particles.spread / 2;
  m.yy += particles.spread / 2;
  return m;
}

// Largest |rho - exact| on the grid at the end, relative to the largest exact value.
template <class Exact>
double density_error(const Case& spec, const Particles& end, const Exact& exact) {
  const Scene scene = make_scene(spec);
  const DensityGrid density =
      evaluate_density(end, spread_cutoff(scene.cutoff, end.dimension, end.spread), scene.evaluation, {});
  double error = 0, largest = 0;
  for (std::size_t i = 0; i < density.rho.size(); ++i) {
    const double value = exact(scene.evaluation.coordinate(0, i % scene.evaluation.points[0]),
                               scene.evaluation.coordinate(1, i / scene.evaluation.points[0]));
    error = std::max(error, std::abs(density.rho[i] - value));
    largest = std::max(largest, std::abs(value));
  }
  return error / largest;
}

const std::string core = "effects.diffusion.method=core-spreading",
                  exchange = "effects.diffusion.method=particle-exchange";

struct Sheared {
  double xx, xy, yy;
};
Sheared sheared_exactly(double gamma, double D, double t) {
  return {sigma0 + 2 * D * t + gamma * gamma * t * t * sigma0 + 2. / 3 * D * gamma * gamma * t * t * t,
          gamma * t * sigma0 + D * gamma * t * t, sigma0 + 2 * D * t};
}
const std::vector<std::string> shear{"velocity.u=[\"y\", \"0\"]",
                                     "effects.diffusion.D=0.01",
                                     "density.center=[0, 0]",
                                     "domain.min=[-2, -1.5]",
                                     "domain.max=[2, 1.5]",
                                     "particles.per_axis=81",
                                     "time.end=1",
                                     "output.times=[1]"};
Moments after_shear(const std::vector<std::string>& more) {
  std::vector<std::string> overrides = shear;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return covariance(particles_at_end(scene_of(overrides), 1));
}

TEST(CoreSpreading, IsCuredByRemeshing) {
  // What spreads between two remeshings, over T = 1/n each, goes into weights that are sheared from then on. What
  // misses is the shear within: D gamma T in total for xy, of first order in T.
  const auto missing = [](int n) {
    const Moments m = after_shear({core, "time.step=" + std::to_string(0.2 / n), "effects.remesh.every=5"});
    return std::pair{sheared_exactly(1, 0.01, 1).xy - m.xy, sheared_exactly(1, 0.01, 1).xx - m.xx};
  };
  const auto [xy_1, xx_1] = missing(1);
  EXPECT_NEAR(xy_1, 0.01, 1.1e-9) << "one interval alone: nothing is deformed";
  const auto [xy_2, xx_2] = missing(2);
  const auto [xy_4, xx_4] = missing(4);
  EXPECT_NEAR(xy_2, 0.01 / 2, 1.8e-10);
  EXPECT_NEAR(xy_4, 0.01 / 4, 2.2e-9);
  // xx receives 2 D T gamma^2 (1 - i T)^2 from the i-th interval: 0.25 D and 0.4375 D of 2/3 D.
  EXPECT_NEAR(xx_1, 0.01 * 2 / 3, 2.4e-9);
  EXPECT_NEAR(xx_2, 0.01 * (2. / 3 - 0.25), 2e-9);
  EXPECT_NEAR(xx_4, 0.01 * (2. / 3 - 0.4375), 8.4e-9);  // what the nodes left out, at 1e-6 of the largest weight
}

// --- particle exchange -----------------------------------------------------------------------------------------------

TEST(ParticleExchange, HasTheExactVarianceAtRest) {
  const Particles end = particles_at_end(scene_of({"effects.diffusion.D=0.02", exchange, "time.step=0.05"}));
  const Moments m = moments_of(end), start = moments_of(particles_at_end(scene_of({})));
  EXPECT_NEAR(m.mass, start.mass, 5e-14 * start.mass);  // the mass stays to rounding: 1.7e-14
  EXPECT_NEAR(m.xx, start.xx + 2 * 0.02 * 0.5,
              2.1e-9);          // weights below the halo's tolerance of 1e-6 are held back: 7e-10
  EXPECT_NEAR(m.xy, 0, 7e-18);  // a rounding of xx
  EXPECT_EQ(end.spread, 0);
  for (const double alpha : end.alpha) EXPECT_GE(alpha, -1e-9 * start.mass);  // no undershoot beyond that of the sums
}

TEST(ParticleExchange, FollowsAShear) {
  // The covariance is integrated with the order of the splitting, 2.
  const Sheared exact = sheared_exactly(1, 0.01, 1);
  const std::string all = "particles.threshold=0";  // what it leaves out, 1e-12 of the largest weight, is more
  const Moments coarse = after_shear({exchange, all, "time.step=0.1"}),
                fine = after_shear({exchange, all, "time.step=0.05"});
  EXPECT_NEAR(fine.yy, exact.yy, 2.3e-10);  // halo, as above: 8e-11
  EXPECT_NEAR(fine.xy, exact.xy, 8e-11);
  EXPECT_NEAR(fine.xx, exact.xx, 2e-5);
  EXPECT_LT(std::abs(fine.xx - exact.xx), 0.35 * std::abs(coarse.xx - exact.xx) + 3e-6);
}

TEST(ParticleExchange, ConvergesWithTheSquareOfTheCoreRadius) {
  // The density alpha_j / h^2 at the particles, which stand still, against the exact puff: without the blobs'
  // smoothing.
  const auto error = [](int per_axis) {
    const Particles end =
        particles_at_end(scene_of({"effects.diffusion.D=0.01", exchange, "density.radius=0.25",
                                   "particles.per_axis=" + std::to_string(per_axis), "time.step=0.02"}),
                         1);
    const double width = 0.0625 + 4 * 0.01 * 0.5, h = 2.0 / (per_axis - 1);
    double largest = 0;
    for (std::size_t j = 0; j < end.size(); ++j) {
      const double x = end.position[0][j], y = end.position[1][j];
      const double exact = 0.0625 / width * std::exp(-(x * x + y * y) / width);
      largest = std::max(largest, std::abs(end.alpha[j] / (h * h) - exact));
    }
    return largest;
  };
  EXPECT_NEAR(std::log2(error(31) / error(61)), 2, 0.2);  // eps = 0.133 and 0.067 of a width 0.25: the next term
}

TEST(ParticleExchange, LetsItsHaloGrow) {
  Simulation simulation(scene_of({"effects.diffusion.D=0.02", exchange, "time.step=0.05", "density.shape=disk"}));
  simulation.prepare();
  const std::size_t before = simulation.particles().size();
  std::size_t on_lattice = 0;
  for (const double alpha : simulation.particles().alpha) on_lattice += alpha != 0;
  EXPECT_GT(before, on_lattice) << "a halo without weight surrounds the disk";
  simulation.run();
  EXPECT_GT(simulation.particles().size(), before);
}

TEST(ParticleExchange, HaloFollowsTheFlow) {
  // Particles added late stand where the flow has carried their nodes: on a rotation, at the node turned.
  const Case spec = scene_of(
      {"velocity.u=[\"-y\", \"x\"]", "effects.diffusion.D=0.02", exchange, "time.step=0.05", "density.shape=disk"});
  const Particles end = particles_at_end(spec);
  const Nodes nodes(make_scene(spec).seeding);
  for (std::size_t j = 0; j < end.size(); ++j) {
    const Vector x = nodes.position(nodes.index(end.id[j]));
    const double c = std::cos(0.5), s = std::sin(0.5);
    EXPECT_NEAR(end.position[0][j], c * x[0] - s * x[1], 1e-7);  // ten steps of rk4, each 0.05^5/120
    EXPECT_NEAR(end.position[1][j], s * x[0] + c * x[1], 1e-7);
  }
}

TEST(ParticleExchange, UsesVolumesInADivergentFlow) {
  // u = 0.8 (x, y): Sigma' = 1.6 Sigma + 2 D. Volumes grow by exp(1.6 t); with volumes of the start the rate would be
  // wrong by that factor.
  const double a = 0.8, D = 0.01, t = 0.5, growth = std::exp(2 * a * t);
  const Particles end = particles_at_end(scene_of({"velocity.u=[\"0.8*x\", \"0.8*y\"]", "effects.diffusion.D=0.01",
                                                   exchange, "time.step=0.0125", "particles.per_axis=61"}));
  const Moments m = moments_of(end);
  EXPECT_NEAR(m.xx, sigma0 * growth + D / a * (growth - 1),
              1.5e-6);  // splitting of order 2; overlap falls to 1.34: 5e-7
  const double cell = std::pow(2.0 / 60, 2);
  for (const double volume : end.volume)
    EXPECT_NEAR(volume, cell * growth, 1.2e-14 * cell);  // rk4, div u by formula: rounding, 4e-15
}

TEST(ParticleExchange, WorksWithRemeshing) {
  const Sheared exact = sheared_exactly(1, 0.01, 1);
  const Moments m = after_shear({exchange, "time.step=0.05", "effects.remesh.every=5"});
  EXPECT_NEAR(m.yy, exact.yy, 1.3e-8);  // halo: 4.3e-9
  EXPECT_NEAR(m.xy, exact.xy, 9e-9);
  EXPECT_NEAR(m.xx, exact.xx, 2.5e-5);  // 1/2 of the splitting's 1.7e-5
}

TEST(ParticleExchange, RefusesAnUnstableStepAndNamesTheLongest) {
  // eps = 0.1: 2 eps^2 / (4 D) = 0.005 for D = 1, but for the lattice sum, which is 1 within 1e-16.
  try {
    particles_at_end(scene_of({"effects.diffusion.D=1", exchange, "time.step=0.1"}));
    FAIL() << "an unstable step was taken";
  } catch (const InputError& error) {
    const std::string text = error.what();
    // Rounded down, so that it is one; the sum of the lattice is a little more than 1.
    EXPECT_NE(text.find("time.step = 0.1 is not stable with [effects.diffusion]. Use time.step <= 0.00"),
              std::string::npos)
        << text;
    const std::string longest = text.substr(text.find("<= ") + 3);
    EXPECT_NEAR(std::stod(longest), 0.005, 1.1e-5);
    EXPECT_NO_THROW(particles_at_end(
        scene_of({"effects.diffusion.D=1", exchange, "time.step=" + longest.substr(0, longest.size() - 1),
                  "time.end=0.005", "output.times=[0]"})));
  }
}

TEST(ParticleExchange, RefusesAHaloThatFitsNowhereBeforeMakingIt) {
  // 373 lattice steps deep in space: 4e8 particles around each.
  EXPECT_THROW(particles_at_end(
                   scene_of({exchange, "particles.overlap=100", "domain.min=[-1,-1,-1]", "domain.max=[1,1,1]",
                             "velocity.u=[\"0\",\"0\",\"0\"]", "density.center=[0,0,0]", "effects.diffusion.D=0.01"})),
               InputError);
  // One particle's halo fits, those of all do not.
  const Case spec = scene_of({exchange, "effects.diffusion.D=0.01"});
  const Scene scene = make_scene(spec);
  Particles particles = seed_scene(scene, 1);
  ParticleExchange effect(scene.seeding, scene.core_radius, *scene.velocity, [](Particles&) {},
                          {.coefficient = 0.01, .most_particles = particles.size() + 10});
  EXPECT_THROW(effect.begin(particles, 0), NumericalError);
  EXPECT_LE(particles.size(), 41u * 41u);  // nothing was added
}

TEST(ParticleExchange, GivesTheSameBitsForAnyThreads) {
  const Case spec = scene_of({"velocity.u=[\"-y\", \"0.5*x\"]", "effects.diffusion.D=0.02", exchange,
                              "effects.reaction.rate=x", "effects.remesh.every=4"});
  const Particles one = particles_at_end(spec, 1), two = particles_at_end(spec, 2);
  EXPECT_EQ(one.id, two.id);
  EXPECT_EQ(one.position, two.position);
  EXPECT_EQ(one.alpha, two.alpha);
}

TEST(ParticleExchange, WorksIn3D) {
  const std::string text = case_text({.domain = cube,
                                      .velocity = velocity_of({"0.2", "0", "0"}),
                                      .density = shape_of("gaussian", "0, 0, 0", "0.3"),
                                      .particles = "per_axis = 17",
                                      .time = "end = 0.3\nstep = 0.1",
                                      .evaluate = "per_axis = 5",
                                      .output = output_at("0.3")}) +
                           R"([effects.diffusion]
D = 0.02
method = "particle-exchange"
tolerance = 1e-4
)";
  const Particles end = particles_at_end(scene_of({}, text));
  Case still = scene_of({}, text);
  still.effects = {};
  const Moments before = moments_of(particles_at_end(still)), after = moments_of(end);
  EXPECT_NEAR(after.mass, before.mass, 2.3e-14 * before.mass);
  EXPECT_NEAR(after.xx - before.xx, 2 * 0.02 * 0.3, 2.5e-7);  // of the halo's tolerance, 1e-4: 8e-8
}

// --- divergent flow
// ----------------------------------------------------------------------------------------------------

TEST(DivergentFlow, CarriesMassAndDensityFollows) {
  // u = 0.6 (x, y): rho(x, t) = rho_0(x e^{-0.6 t}) e^{-1.2 t}; remeshing changes nothing of it.
  for (const auto& remesh : {std::string("case.title=none"), std::string("effects.remesh.every=3")}) {
    const Case spec = scene_of({"velocity.u=[\"0.6*x\", \"0.6*y\"]", "particles.cutoff=gauss6", "particles.per_axis=81",
                                "time.step=0.05", remesh});
    const double error = density_error(spec, particles_at_end(spec), [](double x, double y) {
      const double shrink = std::exp(-0.6 * 0.5);
      return std::exp(-(x * x + y * y) * shrink * shrink / 0.04) * shrink * shrink;
    });
    EXPECT_LT(error, 1.3e-4) << remesh;  // 4e-5: smoothing of order 6 with eps/R = 0.25 relative to the wider Gaussian
  }
}

}  // namespace
}  // namespace gaussdrift
