#include "particle/tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "base/communicator.hpp"
#include "field/density/radial_density.hpp"
#include "particle/placing.hpp"
#include "particle/seeding.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"
#include "sim/tiled_density.hpp"

namespace gaussdrift {
namespace {

// Clustered, of either sign, some of them beyond the box [-1, 1]^d.
Particles cloud(int dimension, std::size_t count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> near(0, 0.15), far(0, 0.6);
  Particles particles;
  particles.dimension = dimension;
  for (std::size_t j = 0; j < count; ++j) {
    for (int k = 0; k < dimension; ++k) particles.position[k].push_back(j % 5 ? 0.4 + near(random) : far(random));
    particles.alpha.push_back(j % 7 ? 1.0 / static_cast<double>(count) : -0.5 / static_cast<double>(count));
    particles.id.push_back(static_cast<std::int64_t>(3 * j));
  }
  return particles;
}

Lattice box(int dimension, int per_axis) { return make_lattice(dimension, {-1, -1, -1}, {1, 1, 0.7}, per_axis); }

class EveryDimension : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Tiles, EveryDimension, ::testing::Values(2, 3));

TEST_P(EveryDimension, FillTheGridAndHoldAllParticles) {
  const Lattice lattice = box(GetParam(), GetParam() == 2 ? 333 : 101);
  const Particles particles = cloud(GetParam(), 5000);
  const TileLimits limits{.particles = 300, .points = 30'000, .reaches = 2};
  const Tiles tiles(lattice, 0.02, particles.view(), limits);
  ASSERT_GT(tiles.list().size(), 8u);
  std::vector<int> times(lattice.size(), 0);
  std::int64_t held = 0;
  for (const Tile& tile : tiles.list()) {
    held += tile.particles;
    std::size_t longest = 0;
    for (std::size_t l = 0; l < tile.points[2]; ++l)
      for (std::size_t j = 0; j < tile.points[1]; ++j)
        for (std::size_t i = 0; i < tile.points[0]; ++i)
          ++times[tile.first[0] + i +
                  lattice.points[0] * (tile.first[1] + j + lattice.points[1] * (tile.first[2] + l))];
    for (int k = 0; k < GetParam(); ++k) {
      EXPECT_GE(static_cast<double>(tile.points[k]) * lattice.spacing, 2 * 0.02);
      EXPECT_GE(tile.points[k], 16u);
      longest = std::max(longest, tile.points[k]);
    }
    // Too large a tile cannot be halved.
    const bool too_large = tile.particles > limits.particles || static_cast<std::int64_t>(tile.size()) > limits.points;
    EXPECT_TRUE(!too_large || longest < 2 * 16u + 2);
  }
  EXPECT_EQ(held, static_cast<std::int64_t>(particles.size()));
  EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](int n) { return n == 1; }));
}

TEST_P(EveryDimension, TakeAllThatReachesThem) {
  const Lattice lattice = box(GetParam(), GetParam() == 2 ? 200 : 60);
  const Particles particles = cloud(GetParam(), 2000);
  const double reach = 0.07;
  const Tiles tiles(lattice, reach, particles.view(), {.particles = 100, .points = 1 << 20, .reaches = 1});
  std::vector<char> all(tiles.list().size(), 1);
  const auto gathered = tiles.gather(particles.view(), all, 0);
  for (std::size_t t = 0; t < tiles.list().size(); ++t) {
    const Tile& tile = tiles.list()[t];
    std::vector<std::size_t> expected;
    for (std::size_t j = 0; j < particles.size(); ++j) {
      bool within = true;
      for (int k = 0; k < GetParam(); ++k) {
        const double x = particles.position[k][j], low = lattice.coordinate(k, tile.first[k]),
                     high = lattice.coordinate(k, tile.first[k] + tile.points[k] - 1);
        within = within && x >= low - reach && x <= high + reach;
      }
      if (within) expected.push_back(j);
    }
    EXPECT_EQ(gathered[t], expected);
  }
}

// Work is shared by this number, so that tiles among others count for what they take from them.
TEST_P(EveryDimension, TellAboutHowManyParticlesReachThem) {
  const Lattice lattice = box(GetParam(), 400);
  const Particles particles = cloud(GetParam(), 50'000);
  const Tiles tiles(lattice, 0.01, particles.view(), {.particles = 500, .points = 1 << 28, .reaches = 8});
  ASSERT_GT(tiles.list().size(), 8u);
  const auto reaching = tiles.gather(particles.view(), std::vector<char>(tiles.list().size(), 1), 1);
  double told = 0, found = 0, wrong = 0;
  for (std::size_t t = 0; t < reaching.size(); ++t) {
    const auto number = static_cast<double>(reaching[t].size());
    EXPECT_GE(tiles.list()[t].sources, static_cast<double>(tiles.list()[t].particles) * (1 - 1e-12));
    told += tiles.list()[t].sources, found += number, wrong += std::abs(tiles.list()[t].sources - number);
  }
  EXPECT_GT(found, 1.05 * 50'000) << "few are near a border";
  EXPECT_NEAR(told, found, 0.1 * found);
  EXPECT_LT(wrong, 0.15 * found);
}

TEST_P(EveryDimension, FollowFromTheParticlesAlone) {
  const Lattice lattice = box(GetParam(), GetParam() == 2 ? 200 : 60);
  const Particles particles = cloud(GetParam(), 3000);
  const TileLimits limits{.particles = 100, .points = 1 << 20, .reaches = 2};
  const Tiles one(lattice, 0.02, particles.view(), limits);
  on_ranks(3, [&](base::Communicator& ranks) {
    std::vector<std::size_t> some;
    for (std::size_t j = 0; j < particles.size(); ++j)
      if ((j * 7 + j / 11) % 3 == static_cast<std::size_t>(ranks.rank())) some.push_back(particles.size() - 1 - j);
    Particles own;
    own.dimension = GetParam();
    unpack(pack(particles, some), own);
    const Tiles tiles(lattice, 0.02, own.view(), limits, [&](std::vector<std::int64_t>& counts) { ranks.sum(counts); });
    ASSERT_EQ(tiles.list().size(), one.list().size());
    for (std::size_t t = 0; t < one.list().size(); ++t) {
      EXPECT_EQ(tiles.list()[t].first, one.list()[t].first);
      EXPECT_EQ(tiles.list()[t].points, one.list()[t].points);
      EXPECT_EQ(tiles.list()[t].particles, one.list()[t].particles);
    }
  });
}

TEST(Tiles, OfUsualCasesAreOne) {
  const Particles particles = cloud(2, 200'000);
  EXPECT_EQ(Tiles(box(2, 2000), 0.01, particles.view(), usual_tiles(2)).list().size(), 1u);
  EXPECT_GT(Tiles(box(2, 2000), 0.01, cloud(2, 300'000).view(), usual_tiles(2)).list().size(), 1u);
  EXPECT_GE(Tiles(make_lattice(3, {}, {1, 1, 1}, 256), 0.01, cloud(3, 10).view(), usual_tiles(3)).list().size(), 8u);
}

TEST(Tiles, AreNotDividedBelowAFewReaches) {
  const Particles particles = cloud(2, 5000);
  const Tiles tiles(box(2, 200), 0.2, particles.view(), {.particles = 10, .points = 100});
  EXPECT_EQ(tiles.list().size(), 1u);  // 8 reaches are 1.6, and the box has sides of 2
}

TEST(ShareOfTiles, IsEvenAndInOrder) {
  std::vector<double> work;
  for (int i = 0; i < 100; ++i) work.push_back(1 + i % 3);
  for (const int ranks : {1, 2, 3, 7}) {
    const std::vector<int> owner = share_tiles(work, ranks);
    EXPECT_TRUE(std::is_sorted(owner.begin(), owner.end()));
    std::vector<double> load(static_cast<std::size_t>(ranks), 0.0);
    for (std::size_t t = 0; t < owner.size(); ++t) load[static_cast<std::size_t>(owner[t])] += work[t];
    const double mean = std::accumulate(work.begin(), work.end(), 0.0) / ranks;
    for (const double own : load) EXPECT_NEAR(own, mean, 3);
  }
  EXPECT_EQ(share_tiles({5}, 4), std::vector<int>{2});
}

TEST(Placing, LosesAndDoublesNothing) {
  const Lattice lattice = box(2, 200);
  Particles particles = cloud(2, 3000);
  particles.path = {std::vector<double>(3000)};
  particles.volume.assign(3000, 0.0);
  for (std::size_t j = 0; j < 3000; ++j)
    particles.path[0][j] = 0.5 * static_cast<double>(j), particles.volume[j] = 1. / 3;
  const TileLimits limits{.particles = 100, .points = 1 << 20, .reaches = 2};
  for (const int size : {1, 2, 5}) {
    on_ranks(size, [&](base::Communicator& ranks) {
      std::vector<std::size_t> some;  // at first anywhere
      for (std::size_t j = 0; j < 3000; ++j)
        if (j % static_cast<std::size_t>(size) == static_cast<std::size_t>(ranks.rank())) some.push_back(j);
      Particles own;
      own.dimension = 2;
      own.path.resize(1);
      unpack(pack(particles, some), own);
      const Tiles tiles(lattice, 0.02, own.view(), limits,
                        [&](std::vector<std::int64_t>& counts) { ranks.sum(counts); });
      std::vector<double> work;
      for (const Tile& tile : tiles.list()) work.push_back(static_cast<double>(tile.particles));
      const std::vector<int> owner = share_tiles(work, size);
      place_particles(own, tiles, owner, ranks);
      for (std::size_t j = 0; j < own.size(); ++j) EXPECT_EQ(owner[tiles.of(own.view().at(j))], ranks.rank());
      EXPECT_TRUE(std::is_sorted(own.id.begin(), own.id.end()));
      const Particles all = gather_particles(own, ranks);
      if (ranks.rank() != 0) {
        EXPECT_EQ(all.size(), 0u);
        return;
      }
      expect_same(all, particles);
    });
  }
}

double largest(const std::vector<double>& values) {
  double result = 0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

class EveryCutoffTiled : public ::testing::TestWithParam<std::tuple<int, const char*, double>> {};
INSTANTIATE_TEST_SUITE_P(, EveryCutoffTiled,
                         ::testing::Combine(::testing::Values(2, 3), ::testing::Values("gauss2", "gauss6"),
                                            ::testing::Values(1e-3, 1e-11)));

TEST_P(EveryCutoffTiled, KeepsItsErrorRelativeToTheMaximum) {
  const auto [dimension, name, tolerance] = GetParam();
  const Lattice lattice = box(dimension, dimension == 2 ? 150 : 40);
  const Particles particles = cloud(dimension, 1000);
  const Cutoff cutoff = make_cutoff(name, dimension, dimension == 2 ? 0.02 : 0.05);
  const DensityOptions options{.tolerance = tolerance,
                               .tiles = TileLimits{.particles = 100, .points = 1 << 22, .reaches = 1}};
  ASSERT_GT(tiles_of(particles, cutoff, lattice, options).list().size(), 4u);
  DensityReport report;
  const DensityGrid tiled = evaluate_density(particles, cutoff, lattice, options, &report);
  const DensityGrid exact = evaluate_density(particles, cutoff, lattice, {.tolerance = 1e-12, .method = "direct"});
  double error = 0;
  for (std::size_t i = 0; i < exact.rho.size(); ++i) error = std::max(error, std::abs(exact.rho[i] - tiled.rho[i]));
  EXPECT_LE(error, std::max(tolerance, 2e-13) * largest(exact.rho));
  EXPECT_LE(report.measured_error, tolerance);
  EXPECT_GT(report.sample, 4u);
}

TEST(TiledDensity, HasTheSameBitsOnAnyNumberOfRanks) {
  for (const int dimension : {2, 3}) {
    const Lattice lattice = box(dimension, dimension == 2 ? 150 : 40);
    const Particles particles = cloud(dimension, 1000);
    const Cutoff cutoff = make_cutoff("gauss4", dimension, dimension == 2 ? 0.02 : 0.05);
    const DensityOptions options{.threads = 1, .tiles = TileLimits{.particles = 100, .points = 1 << 22, .reaches = 1}};
    DensityReport alone;
    const DensityGrid expected = evaluate_density(particles, cutoff, lattice, options, &alone);
    for (const int size : {2, 3, 8}) {
      on_ranks(size, [&](base::Communicator& ranks) {
        std::vector<std::size_t> some;
        for (std::size_t j = 0; j < particles.size(); ++j)
          if (j % static_cast<std::size_t>(size) == static_cast<std::size_t>(ranks.rank())) some.push_back(j);
        Particles own;
        own.dimension = dimension;
        unpack(pack(particles, some), own);
        const Tiles tiles =
            tiles_of(own, cutoff, lattice, options, [&](std::vector<std::int64_t>& counts) { ranks.sum(counts); });
        const std::vector<int> owner = share_tiles(std::vector<double>(tiles.list().size(), 1.0), size);
        place_particles(own, tiles, owner, ranks);
        const Particles felt = felt_from_elsewhere(own, tiles, owner, ranks);
        std::vector<char> owned;
        for (const int rank : owner) owned.push_back(rank == ranks.rank());
        DensityReport report;
        const auto densities = evaluate_tiles({own, felt}, tiles, owned, cutoff, lattice, options, ranks, report);
        for (const auto& [tile, rho] : densities) {
          DensityGrid whole = expected;
          std::vector<std::vector<double>> no_derivatives;
          place(rho, tiles.list()[tile], whole, no_derivatives);
          EXPECT_EQ(whole.rho, expected.rho) << "tile " << tile << " on " << size << " ranks";
        }
        EXPECT_EQ(report.measured_error, alone.measured_error);
        EXPECT_EQ(report.requested_tolerance, alone.requested_tolerance);
        EXPECT_EQ(report.achievable, alone.achievable);
        EXPECT_EQ(report.sample, alone.sample);
        EXPECT_EQ(report.choice, alone.choice);
      });
    }
  }
}

}  // namespace
}  // namespace gaussdrift
