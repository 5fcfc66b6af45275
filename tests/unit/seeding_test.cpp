#include "particle/seeding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "field/density/radial_density.hpp"
#include "gaussdrift/error.hpp"

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

std::vector<Carried> cone_alone() {
  static const RadialDensity cone{RadialDensity::Profile::wendland, 2, {0.5, 0, 0}, 0.25, 1};
  return {{"the initial density", [](const PointsView& x, double* values) { cone.add(x, values); }}};
}

// The thesis carries 4378 particles: those with alpha_j > 1e-15, which is 2.24e-11 of the largest.
TEST(Seeding, LeavesOutWhatTheThesisLeavesOut) {
  const double largest = 0.997829 * square.spacing * square.spacing;
  SeedReport report;
  const Particles cone = seed(square, cone_alone(), 1e-15 / largest, 0, &report);
  EXPECT_EQ(cone.size(), 4378u);
  for (const double alpha : cone.alpha) EXPECT_GT(alpha, 1e-15);
  EXPECT_EQ(report.left_out, 8u);
  EXPECT_LT(report.carried.front().part(), 8 * 1e-15 / 0.028);  // eight of them, of the mass of the cone
  EXPECT_GT(report.carried.front().part(), 0);
}

TEST(Seeding, CountsAndWeighsWhatItLeavesOutForAnyThreads) {
  const RadialDensity gaussian(RadialDensity::Profile::gaussian, 2, {0.1, 0.2, 0}, 0.2, 3);
  const std::vector<Carried> carried{
      {"the initial density", [&](const PointsView& x, double* values) { gaussian.add(x, values); }}};
  SeedReport none, one, two;
  const Particles all = seed(square, carried, 0, 2, &none), few = seed(square, carried, 1e-6, 1, &one),
                  same = seed(square, carried, 1e-6, 2, &two);
  EXPECT_EQ(none.left_out, 0u);
  EXPECT_EQ(few.id, same.id);
  EXPECT_EQ(one.carried.front().left_out, two.carried.front().left_out);
  EXPECT_EQ(few.size() + one.left_out, all.size());
  double heaviest = 0, total = 0, kept = 0;
  for (const double alpha : all.alpha) heaviest = std::max(heaviest, alpha), total += alpha;
  for (const double alpha : few.alpha) {
    EXPECT_GE(alpha, 1e-6 * heaviest);
    kept += alpha;
  }
  EXPECT_NEAR(one.carried.front().left_out, total - kept, 1e-13 * total);
  EXPECT_NEAR(one.carried.front().part(), 1e-6, 0.1e-6);  // the part of a plane Gaussian below 1e-6 of its height
}

TEST(Seeding, KeepsPointsThatHaveSomethingElse) {
  const Lattice lattice = make_lattice(2, {0, 0, 0}, {1, 1, 0}, 11);
  std::vector<Carried> carried{{"the initial density",
                                [](const PointsView& x, double* values) {
                                  for (std::size_t i = 0; i < x.count; ++i)
                                    values[i] += x.axis[0][i] < 0.45 ? 1 : 1e-14;
                                }},
                               {"the charge", [](const PointsView& x, double* values) {
                                  for (std::size_t i = 0; i < x.count; ++i) values[i] += x.axis[0][i] > 0.75 ? -2 : 0;
                                }}};
  SeedReport report;
  const Particles particles = seed(lattice, carried, 1e-12, 1, &report);
  EXPECT_EQ(particles.size(), (5u + 3u) * 11u);  // x = 0 ... 0.4 and 0.8 ... 1
  EXPECT_EQ(report.left_out, 3u * 11u);
  EXPECT_EQ(report.carried.back().left_out, 0);
  EXPECT_GT(report.carried.front().left_out, 0);
}

TEST(Seeding, WeighsWithTheLatticeCell) {
  const RadialDensity density(RadialDensity::Profile::gaussian, 2, {0.1, 0.2, 0}, 0.2, 1);
  const Particles particles = seed_radial(density, 0);
  double mass = 0;
  for (const double alpha : particles.alpha) mass += alpha;
  EXPECT_NEAR(mass, std::numbers::pi * 0.04,
              2.5e-9);  // lattice sum of a Gaussian; its tail at the domain's edge is exp(-16): 8.5e-10
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
