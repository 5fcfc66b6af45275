#include "particle/seeding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.hpp"
#include "field/density.hpp"

namespace gaussdrift {
namespace {

const Lattice square = make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 300);

Particles seed_radial(const RadialDensity& density, int threads) {
  return seed(
      square, [&](const PointsView& x, double* values) { density.add(x, values); }, threads);
}

TEST(Seeding, CarriesOnlyTheConesParticles) {
  const Particles cone = seed_radial({RadialDensity::Profile::wendland, 2, {0.5, 0, 0}, 0.25, 1}, 0);
  EXPECT_EQ(cone.size(), 4386u);  // lattice points with rho_0 > 0
  EXPECT_EQ(std::count_if(cone.alpha.begin(), cone.alpha.end(), [](double alpha) { return alpha > 1e-15; }),
            4378);  // as the thesis has it
  for (const double alpha : cone.alpha) EXPECT_GT(alpha, 0);
}

TEST(Seeding, WeighsWithTheLatticeCell) {
  const RadialDensity density(RadialDensity::Profile::gaussian, 2, {0.1, 0.2, 0}, 0.2, 1);
  const Particles particles = seed_radial(density, 0);
  double mass = 0;
  for (const double alpha : particles.alpha) mass += alpha;
  EXPECT_NEAR(mass, std::numbers::pi * 0.04,
              1e-8);  // lattice sum of a Gaussian; its tail at the domain's edge is exp(-16)
}

TEST(Seeding, NumbersParticlesByLatticeIndexForAnyThreads) {
  const RadialDensity density(RadialDensity::Profile::disk, 2, {0.5, 0, 0}, 0.25, 1);
  const Particles one = seed_radial(density, 1), two = seed_radial(density, 2);
  EXPECT_EQ(one.id, two.id);
  EXPECT_EQ(one.position, two.position);
  for (std::size_t j = 0; j < one.size(); ++j) {
    EXPECT_EQ(one.position[0][j], square.coordinate(0, static_cast<std::size_t>(one.id[j]) % 300));
    EXPECT_EQ(one.position[1][j], square.coordinate(1, static_cast<std::size_t>(one.id[j]) / 300));
  }
}

TEST(Seeding, SaysWhereTheDensityIsNotFinite) {
  const Lattice lattice = make_lattice(2, {0, 0, 0}, {1, 1, 0}, 5);
  const auto pole = [](const PointsView& x, double* values) {
    for (std::size_t i = 0; i < x.count; ++i)
      values[i] += 1 / (std::abs(x.axis[0][i] - 0.25) + std::abs(x.axis[1][i] - 0.5));
  };
  try {
    seed(lattice, pole, 1);
    FAIL() << "a pole on the lattice was not noticed";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("inf at (0.25, 0.5)"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace gaussdrift
