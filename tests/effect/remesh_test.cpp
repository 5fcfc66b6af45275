// Remeshing: kernels and their moments, mass to rounding, volumes, and the density that stays.
#include "effect/remesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "gaussdrift/error.hpp"
#include "particle/seeding.hpp"
#include "scene.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {
namespace {

class EveryKernel : public ::testing::TestWithParam<std::string_view> {};

TEST_P(EveryKernel, KeepsItsMoments) {
  const RemeshKernel& kernel = find_remesh_kernel(GetParam());
  std::vector<double> w;
  std::int64_t first = 0;
  for (const double x : {0.0, 0.1, -0.37, 0.5, 7.92, 1 - 1e-12}) {
    kernel.share(x, 0, first, w);
    for (int k = 0; k <= kernel.moments; ++k) {
      double moment = 0, size = 0;
      for (std::size_t i = 0; i < w.size(); ++i) {
        const double term = w[i] * std::pow(static_cast<double>(first) + static_cast<double>(i) - x, k);
        moment += term, size += std::abs(term);
      }
      // Rounding, relative to the terms that cancel; coefficients of the polynomials reach 1e4. gauss8 is summed on
      // nodes half its width apart: its transform at 2 pi is 8e-14, and each power of x differentiates that, which
      // brings a factor 4 pi.
      const double aliasing = GetParam() == "gauss8" && k > 0 ? 2e-13 * std::pow(4 * std::numbers::pi, k) : 0;
      EXPECT_NEAR(moment, k == 0 ? 1 : 0, 1e-11 * (1 + size) + aliasing) << k << " at " << x;
    }
  }
}

TEST_P(EveryKernel, TakesUpASpread) {
  const RemeshKernel& kernel = find_remesh_kernel(GetParam());
  std::vector<double> w;
  std::int64_t first = 0;
  const double spread = 3;
  ASSERT_GE(spread, kernel.takes_spread);
  kernel.share(0.3, spread, first, w);
  double sum = 0, second = 0, fourth = 0;
  for (std::size_t i = 0; i < w.size(); ++i) {
    const double x = static_cast<double>(first) + static_cast<double>(i) - 0.3;
    sum += w[i], second += w[i] * x * x, fourth += w[i] * std::pow(x, 4);
  }
  EXPECT_NEAR(sum, 1, 6.7e-16);
  EXPECT_NEAR(second, spread / 2, 1.1e-13);  // moments of the heat kernel: s^2/2 and 3 s^4/4; cut off, rounding
  EXPECT_NEAR(fourth, 3 * spread * spread / 4, 3.3e-11);
}

TEST(RemeshKernel, PiecewiseOnesInterpolateAndAreContinuous) {
  for (const char* name : {"lambda44", "lambda66", "m4prime"}) {
    const RemeshKernel& kernel = find_remesh_kernel(name);
    std::vector<double> at, before;
    std::int64_t first = 0, first_before = 0;
    kernel.share(5, 0, first, at);
    kernel.share(5 - 1e-13, 0, first_before, before);
    ASSERT_EQ(first, first_before + 1);
    for (std::size_t i = 0; i < at.size(); ++i) {
      EXPECT_NEAR(at[i], first + static_cast<std::int64_t>(i) == 5 ? 1 : 0, 2.2e-16)
          << name << i;  // rounding of the solver
      if (i + 1 < at.size()) {
        EXPECT_NEAR(before[i + 1], at[i], 2.3e-13) << name << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, EveryKernel, ::testing::ValuesIn(base::names_of(remesh_kernels())),
                         [](const auto& name) { return std::string(name.param); });

TEST(RemeshKernel, M4PrimeIsMonaghans) {
  const RemeshKernel& kernel = find_remesh_kernel("m4prime");
  const auto monaghan = [](double x) {
    x = std::abs(x);
    return x < 1 ? 1 - 2.5 * x * x + 1.5 * x * x * x : 0.5 * (2 - x) * (2 - x) * (1 - x);
  };
  std::vector<double> w;
  std::int64_t first = 0;
  kernel.share(0.3, 0, first, w);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(w[static_cast<std::size_t>(i)], monaghan(i - 1 - 0.3), 1.7e-16);
}

const Lattice square = make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 41);

Particles scattered(int dimension, std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1.3, 1.3), weight(-0.3, 1);  // some beyond the lattice
  Particles particles;
  particles.dimension = dimension;
  for (std::size_t j = 0; j < count; ++j) {
    for (int k = 0; k < dimension; ++k) particles.position[k].push_back(place(random));
    particles.alpha.push_back(weight(random));
    particles.id.push_back(static_cast<std::int64_t>(j));
  }
  return particles;
}

double moment(const Particles& particles, const std::array<int, 3>& power) {
  double sum = 0;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    double product = particles.alpha[j];
    for (int k = 0; k < particles.dimension; ++k) product *= std::pow(particles.position[k][j], power[k]);
    sum += product;
  }
  return sum;
}

TEST(Remesh, KeepsMassAndMomentsOfAnyParticles) {
  for (const int dimension : {2, 3}) {
    const Lattice lattice = make_lattice(dimension, {-1, -1, -1}, {1, 1, 1}, 12);
    for (const RemeshKernel& kernel : remesh_kernels()) {
      Remesh remesh(lattice, {.kernel = std::string(kernel.name), .tolerance = 0});
      Particles particles = scattered(dimension, 300);
      const Particles before = particles;
      remesh.remesh(particles);
      for (int a = 0; a <= kernel.moments; ++a)
        for (int b = 0; a + b <= kernel.moments; ++b)
          EXPECT_NEAR(moment(particles, {a, b, 0}), moment(before, {a, b, 0}), 7e-10)
              << kernel.name << a << b;  // 300 weights, powers up to 3^7 at the far nodes, kernels right to 1e-12
      EXPECT_NEAR(moment(particles, {0, 0, 0}), moment(before, {0, 0, 0}),
                  3.8e-13);  // rounding of 300 weights: 1.3e-13
    }
  }
}

TEST(Remesh, KeepsMassToRoundingWhereItLeavesNodesOut) {
  Remesh remesh(square, {.tolerance = 1e-3});
  Particles particles = particles_at_end(scene_of({"velocity.u=[\"y\", \"0\"]"}));
  const double before = moment(particles, {0, 0, 0});
  remesh.remesh(particles);
  EXPECT_NEAR(moment(particles, {0, 0, 0}), before, 2.6e-15 * before);  // a sum of a thousand weights: 9e-16
  EXPECT_LT(particles.size(), 1000u);                                   // 345 nodes
}

TEST(Remesh, NamesNodesUniquelyInsideAndOutside) {
  const Nodes nodes(square);
  EXPECT_EQ(nodes.id({3, 2, 0}), 3 + 2 * 41);
  for (const NodeIndex& index :
       {NodeIndex{0, 0, 0}, NodeIndex{40, 40, 0}, NodeIndex{-1, 0, 0}, NodeIndex{41, 3, 0}, NodeIndex{-1000, 77, 0}})
    EXPECT_EQ(nodes.index(nodes.id(index)), index);
  EXPECT_LT(nodes.id({-1, 0, 0}), 0);
  const Nodes space(make_lattice(3, {0, 0, 0}, {1, 2, 3}, 9));
  for (const NodeIndex& index : {NodeIndex{2, 5, 8}, NodeIndex{-5, 6, 700}, NodeIndex{3, -3, 3}})
    EXPECT_EQ(space.index(space.id(index)), index);
  EXPECT_THROW(space.id({1 << 21, 0, 0}), NumericalError);
}

TEST(Remesh, RefusesParticlesTooScattered) {
  Remesh remesh(square, {.memory_limit = 100'000});
  Particles particles = scattered(2, 3000);
  for (auto& x : particles.position)
    for (double& value : x) value *= 100;
  EXPECT_THROW(remesh.remesh(particles), NumericalError);
}

TEST(Remesh, MovesASpreadIntoTheWeights) {
  Remesh remesh(square, {});
  Particles particles = particles_at_end(scene_of({}));
  const Moments before = moments_of(particles);
  particles.spread = 4 * square.spacing * square.spacing;  // s = 2 h
  remesh.remesh(particles);
  const Moments after = moments_of(particles);
  EXPECT_EQ(particles.spread, 0);
  EXPECT_NEAR(after.mass, before.mass, 8.6e-15 * before.mass);
  EXPECT_NEAR(after.xx, before.xx + 2 * square.spacing * square.spacing, 1e-9);  // variance s^2/2; weights left out
  EXPECT_NEAR(after.xy, 0, 3.5e-18);                                             // a rounding of xx

  particles.spread = square.spacing * square.spacing;  // too sharp for a piecewise kernel: stays with the blobs
  Remesh piecewise(square, {.kernel = "lambda44"});
  piecewise.remesh(particles);
  EXPECT_EQ(particles.spread, square.spacing * square.spacing);
  EXPECT_NEAR(moments_of(particles).xx, after.xx, 4.2e-17);
}

TEST(Remesh, SeesTheStretchOfNeighbours) {
  Remesh remesh(square, {});
  EXPECT_NEAR(remesh.largest_stretch(particles_at_end(scene_of({}))), 1, 2.7e-15);
  Remesh again(square, {});
  // A shear u = 4 y over t = 0.5 moves a neighbour above by 2 spacings.
  EXPECT_NEAR(again.largest_stretch(particles_at_end(scene_of({"velocity.u=[\"4*y\", \"0\"]"}))), std::sqrt(5.0),
              1e-13);
}

// The largest error against the exact density after the strain u = (x, -y) has drawn it by e^{1.2} = 3.3 and thinned it
// as much: rho_0(x e^{-t}, y e^t).
double error_after_strain(const std::vector<std::string>& more) {
  std::vector<std::string> overrides{
      "velocity.u=[\"x\", \"-y\"]",    "time.end=1.2",           "time.step=0.05",          "output.times=[1.2]",
      "particles.cutoff=gauss4",       "particles.per_axis=241", "domain.min=[-1.2, -0.8]", "domain.max=[1.2, 0.8]",
      "reference.kind=characteristics"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return Simulation(scene_of(overrides)).run().frames.back().second.error->linf;
}

TEST(Remesh, CuresALostOverlap) {
  // Neighbours end up 3.3 spacings apart, the overlap of 2 has fallen to 0.6: gauss4 ripples by 2 (1 + q) exp(-q) with
  // q = (0.6 pi)^2, a quarter of the density. Smoothing, (eps / 2 w)^4 with eps = 0.02 and the width w = 0.06, is 1e-3.
  EXPECT_GT(error_after_strain({}), 0.1);
  EXPECT_LT(error_after_strain({"effects.remesh.stretch=1.5"}), 2e-3);
  // Piecewise kernels want to be used before particles have moved apart.
  EXPECT_LT(error_after_strain({"effects.remesh.stretch=1.1", "effects.remesh.kernel=lambda44"}), 2e-2);
}

TEST(Remesh, HappensEverySoManySteps) {
  Simulation simulation(scene_of({"effects.remesh.every=2", "velocity.u=[\"1\", \"0\"]"}));
  const RunSummary summary = simulation.run();  // 5 steps
  ASSERT_EQ(summary.effects.size(), 2u);
  EXPECT_EQ(summary.effects[1].name, "remesh");
  const Numbers& numbers = summary.effects[1].numbers;
  EXPECT_EQ(std::find_if(numbers.begin(), numbers.end(), [](const auto& n) { return n.first == "remeshings"; })->second,
            2);
  EXPECT_NEAR(summary.frames.back().second.mass, summary.frames.front().second.mass, 2.5e-16);
}

}  // namespace
}  // namespace gaussdrift
