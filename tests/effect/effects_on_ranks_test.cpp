// Effects in which particles see each other, on ranks that have them in any way: the bits of one rank, in space too.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "effect/remesh.hpp"
#include "effect/scattered_sums.hpp"
#include "particle/placing.hpp"
#include "particle/seeding.hpp"
#include "particle/subset.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"

namespace gaussdrift {
namespace {

/// Particles that have left their nodes, some of them the lattice.
Particles strewn(const Lattice& lattice, double part) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  Particles all;
  all.dimension = lattice.dimension;
  for (std::size_t id = 0; id < lattice.size(); ++id) {
    if (any(random) > 2 * part - 1) continue;
    std::size_t rest = id;
    for (int k = 0; k < lattice.dimension; ++k) {
      const auto index = static_cast<double>(rest % lattice.points[k]);
      rest /= lattice.points[k];
      all.position[k].push_back(lattice.origin[k] + lattice.spacing * (index + 0.7 * any(random) - 3));
    }
    all.alpha.push_back(any(random));
    all.id.push_back(static_cast<std::int64_t>(id));
  }
  return all;
}

/// Every `size`-th of them, without an order in space.
Particles part_of(const Particles& all, const base::Communicator& ranks) {
  std::vector<std::size_t> chosen;
  for (std::size_t j = 0; j < all.size(); ++j)
    if (j * j % static_cast<std::size_t>(ranks.size()) == static_cast<std::size_t>(ranks.rank())) chosen.push_back(j);
  return subset(all, chosen);
}

Lattice lattice_in(int dimension) {
  const double low = -1, high = 1;
  return make_lattice(dimension, {low, low, low}, {high, high, high}, dimension == 2 ? 100 : 40);
}

class OnRanks : public testing::TestWithParam<int> {};  // the dimension
INSTANTIATE_TEST_SUITE_P(Effects, OnRanks, testing::Values(2, 3));

TEST_P(OnRanks, RemeshingHasTheBitsOfOneRank) {
  const Lattice lattice = lattice_in(GetParam());
  const Particles all = strewn(lattice, 0.3);
  const Remesh::Options options{.kernel = "lambda44"};
  Remesh one(lattice, options);
  Particles expected = all;
  one.remesh(expected);
  EXPECT_GT(expected.size(), all.size());
  for (const int size : {2, 3, 4, 8})
    on_ranks(size, [&](base::Communicator& ranks) {
      // Oblique parts: no block of nodes and no particle lies where its rank is.
      Remesh remesh(lattice, options, ranks, [&](const Vector& x) {
        return static_cast<int>(std::floor(50 + 3.1 * x[0] + 5.3 * x[1] + 2.7 * x[2])) % ranks.size();
      });
      Particles own = part_of(all, ranks);
      remesh.remesh(own);
      EXPECT_LT(own.size(), expected.size());
      const Particles together = gather_particles(own, ranks);
      if (ranks.rank() == 0) expect_same(together, expected);
      EXPECT_EQ(remesh.numbers(), one.numbers());
    });
}

TEST_P(OnRanks, TheStretchOfNeighboursIsThatOfOneRank) {
  const Lattice lattice = lattice_in(GetParam());
  const Particles all = strewn(lattice, 0.3);
  const double expected = Remesh(lattice, {}).largest_stretch(all);
  EXPECT_GT(expected, 1.5);
  for (const int size : {2, 3, 4, 8})
    on_ranks(size, [&](base::Communicator& ranks) {
      Remesh remesh(lattice, {}, ranks, [](const Vector&) { return 0; });
      EXPECT_EQ(remesh.largest_stretch(part_of(all, ranks)), expected) << size;
    });
}

template <int d>
void sums_have_the_bits_of_one_rank() {
  const Lattice lattice = lattice_in(d);
  const Particles all = strewn(lattice, 0.3);
  const double width = 0.35 * lattice.spacing;
  const TileLimits limits{.particles = 200, .points = 1'000'000'000};
  fgtd::Options options;
  options.tolerance = 1e-9;
  options.threads = 1;
  const auto weights_of = [](const Particles& particles) {
    Eigen::MatrixXd weights(static_cast<Eigen::Index>(particles.size()), 2);
    for (Eigen::Index j = 0; j < weights.rows(); ++j) {
      weights(j, 0) = particles.alpha[static_cast<std::size_t>(j)];
      weights(j, 1) = std::cos(static_cast<double>(particles.id[static_cast<std::size_t>(j)]));
    }
    return weights;
  };
  base::Communicator alone;
  const TileLimits one{.particles = 1'000'000'000, .points = 1'000'000'000};
  ScatteredSums<d> at_once("a test", all, lattice, width, one, options, alone);
  ScatteredSums<d> in_tiles("a test", all, lattice, width, limits, options, alone);
  const Eigen::MatrixXd expected = in_tiles.of(weights_of(all)), again = in_tiles.of(expected.col(0));
  // The tolerance is relative to what all weights together could give.
  EXPECT_LT((expected - at_once.of(weights_of(all))).cwiseAbs().maxCoeff(), 2e-9 * weights_of(all).cwiseAbs().sum());
  EXPECT_NE(expected, at_once.of(weights_of(all))) << "there are several tiles";
  for (const int size : {2, 3, 4, 8})
    on_ranks(size, [&](base::Communicator& ranks) {
      const Particles own = part_of(all, ranks);
      ScatteredSums<d> sums("a test", own, lattice, width, limits, options, ranks);
      const Eigen::MatrixXd first = sums.of(weights_of(own)), second = sums.of(first.col(0));
      for (std::size_t i = 0, j = 0; j < own.size(); ++i) {
        if (all.id[i] != own.id[j]) continue;
        const auto here = static_cast<Eigen::Index>(j), there = static_cast<Eigen::Index>(i);
        EXPECT_EQ(first.row(here), expected.row(there));
        EXPECT_EQ(second.row(here), again.row(there));
        ++j;
      }
    });
}

TEST_P(OnRanks, SumsAtParticlesHaveTheBitsOfOneRank) {
  if (GetParam() == 2)
    sums_have_the_bits_of_one_rank<2>();
  else
    sums_have_the_bits_of_one_rank<3>();
}

}  // namespace
}  // namespace gaussdrift
