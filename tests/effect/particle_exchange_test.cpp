// Particle strength exchange against closed forms: mass, covariance at rest, in a shear and in a divergent flow, and
// what it does beyond the Laplacian.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "scene.hpp"

namespace gaussdrift {
namespace {

const std::vector<std::string> exchange{"effects.diffusion.D=0.01",
                                        "effects.diffusion.method=particle-exchange",
                                        "reference.kind=none",
                                        "density.radius=0.2",
                                        "effects.diffusion.halo=0.3",
                                        "particles.per_axis=33",
                                        "time.step=0.05"};

std::vector<std::string> with_exchange(const std::vector<std::string>& more) {
  std::vector<std::string> all = exchange;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// The second moment of the kernel is that of the Laplacian exactly, so covariances of weights grow as they should but
// for quadrature and the tail of the density outside the domain, exp(-25), and the splitting where something flows.
TEST(ParticleExchange, GrowsTheCovarianceAtRest) {
  const Particles end = particles_at_end(scene_of(with_exchange({})));
  const Moments m = moments_of(end);
  const double start = 0.02, grown = 2 * 0.01 * 0.5;
  EXPECT_NEAR(m.xx, start + grown, 1e-8);  // 1e-10 of the transforms in 10 steps, weighted by squares of up to 2
  EXPECT_NEAR(m.yy, start + grown, 1e-8);
  EXPECT_NEAR(m.xy, 0, 1e-8);
}

TEST(ParticleExchange, KeepsMass) {
  const double before = moments_of(particles_at_end(scene_of({}))).mass;
  const double after = moments_of(particles_at_end(scene_of(with_exchange({})))).mass;
  EXPECT_NEAR(after, before, 1e-9 * before);  // 1e-10 a transform, 10 steps of 4 D tau / eps^2 = 0.13
}

TEST(ParticleExchange, FollowsAShear) {
  // The covariance that core spreading lacks: xx = s0 (1 + t^2) + 2 D t + 2/3 D t^3, xy = s0 t + D t^2 for u = (y, 0).
  const double s0 = 0.02, D = 0.01, t = 1;
  const Moments m = moments_of(particles_at_end(scene_of(
      with_exchange({"velocity.u=[\"y\", \"0\"]", "time.end=1", "output.times=[1]", "effects.diffusion.halo=0.8"}))));
  constexpr double splitting =
      2e-5;  // trapezoidal sums of 2/3 D t^3 with steps of 0.05: D tau^2 t / 3 = 8e-6, and the lattice
  EXPECT_NEAR(m.xx, s0 * (1 + t * t) + 2 * D * t + 2. / 3 * D * t * t * t, splitting);
  EXPECT_NEAR(m.xy, s0 * t + D * t * t, splitting);
  EXPECT_NEAR(m.yy, s0 + 2 * D * t, splitting);
}

TEST(ParticleExchange, FollowsADivergentFlow) {
  // u = a (x, y): covariance s' = 2 a s + 2 D an axis, s = (s0 + D/a) e^{2 a t} - D/a, and volumes grow by e^{2 a t}.
  const double s0 = 0.02, D = 0.01, a = 0.4, t = 0.5;
  const Particles end = particles_at_end(scene_of(with_exchange({"velocity.u=[\"0.4*x\", \"0.4*y\"]"})));
  const Moments m = moments_of(end);
  const double exact = (s0 + D / a) * std::exp(2 * a * t) - D / a;
  EXPECT_NEAR(m.xx, exact, 2e-5);  // splitting, as above
  EXPECT_NEAR(m.yy, exact, 2e-5);
  for (std::size_t j = 0; j < end.size(); j += 97)
    EXPECT_NEAR(end.volume[j], 0.00390625 * std::exp(2 * a * t), 1e-8 * 0.00390625);  // rk4
}

// What the exchange does beyond the Laplacian, at the first order that shows: its symbol along x,
// 4 D / eps^2 (exp(-q^2 eps^2 / 4) - 1) = -D q^2 + D eps^2 q^4 / 8 - ..., makes the fourth cumulant grow at the rate
// 3 D eps^2, where that of the heat equation stays.
TEST(ParticleExchange, IsTheLaplacianToSecondOrderInTheCoreRadius) {
  const auto fourth_cumulant = [](const std::vector<std::string>& more) {
    const Particles particles = particles_at_end(scene_of(with_exchange(more)));
    const Moments m = moments_of(particles);
    double fourth = 0;
    for (std::size_t j = 0; j < particles.size(); ++j)
      fourth += particles.alpha[j] * std::pow(particles.position[0][j] - m.centroid[0], 4) / m.mass;
    return fourth - 3 * m.xx * m.xx;
  };
  const double D = 0.01, t = 0.5;
  for (const double overlap : {1.5, 2.0, 3.0}) {
    const double eps = overlap * 2 / 32;
    const double found =
        fourth_cumulant({"particles.overlap=" + std::to_string(overlap), "effects.diffusion.halo=0.6"});
    // 1e-10 of the transforms, weighted by fourth powers of up to 1.6^4, in 10 steps of up to 4 D tau / eps^2 = 0.23
    EXPECT_NEAR(found, 3 * D * eps * eps * t, 1e-7) << "eps = " << eps;
  }
}

TEST(ParticleExchange, RefusesAStepThatIsNotStable) {
  try {
    particles_at_end(scene_of(with_exchange({"time.step=0.5", "effects.diffusion.D=0.1"})));
    FAIL() << "4 D tau / eps^2 = 20 was taken for stable";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("not stable for [effects.diffusion]"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("longest stable step is 0.07"), std::string::npos) << error.what();
  }
}

TEST(ParticleExchange, SaysWhenWeightReachesTheEdge) {
  try {
    particles_at_end(scene_of(with_exchange({"effects.diffusion.halo=0.1", "density.radius=0.05", "density.shape=disk",
                                             "particles.overlap=1", "effects.diffusion.D=0.02"})));
    FAIL() << "a halo of two points was enough";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("raise effects.diffusion.halo"), std::string::npos) << error.what();
  }
}

TEST(ParticleExchange, GivesTheSameBitsForAnyThreads) {
  const std::vector<std::string> short_run = with_exchange({"velocity.u=[\"y\", \"0\"]", "time.step=0.1"});
  EXPECT_EQ(particles_at_end(scene_of(short_run), 1).alpha, particles_at_end(scene_of(short_run), 2).alpha);
}

}  // namespace
}  // namespace gaussdrift
