// Particles in pieces: the same pieces on any number of ranks, and all particles together in the order of their ids.
#include "sim/particle_pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <random>
#include <stdexcept>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "particle/placing.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"

namespace gaussdrift {
namespace {

struct Piece {
  Particles particles;
  std::vector<double> velocity;
  int rank = 0;
};
using PiecesByNumber = std::map<std::size_t, Piece>;

Particles none() {
  Particles particles;
  particles.dimension = 2;
  return particles;
}

// Ids with gaps, of either sign, in no order; velocities tell whose they are.
Particles scattered(std::size_t count) {
  std::mt19937_64 random(5);
  Particles all;
  all.dimension = 2;
  for (std::size_t j = 0; j < count; ++j) {
    const auto id = static_cast<std::int64_t>(j * j) - 1000;
    all.id.push_back(id);
    all.alpha.push_back(1.0 / static_cast<double>(j + 1));
    all.position[0].push_back(static_cast<double>(id) / 7);
    all.position[1].push_back(-static_cast<double>(id));
  }
  std::vector<std::size_t> order(count);
  for (std::size_t j = 0; j < count; ++j) order[j] = j;
  std::shuffle(order.begin(), order.end(), random);
  Particles mixed = none();
  unpack(pack(all, order), mixed);
  return mixed;
}

std::vector<double> velocities_of(const Particles& particles) {
  std::vector<double> velocity;
  for (const std::int64_t id : particles.id) {
    velocity.push_back(static_cast<double>(id) + 0.5);
    velocity.push_back(static_cast<double>(id) / 3);
  }
  return velocity;
}

// The particles lie anywhere: here by their number, and the last rank has none.
PiecesByNumber handed_out(const Particles& all, std::size_t pieces, int size) {
  PiecesByNumber seen;
  std::mutex mutex;
  for (const auto& end : ends_on_ranks(size, [&](base::Communicator& ranks) {
         std::vector<std::size_t> own;
         for (std::size_t j = 0; j < all.size(); ++j)
           if (static_cast<int>(j) % std::max(1, size - 1) == ranks.rank()) own.push_back(j);
         Particles some = none();
         unpack(pack(all, own), some);
         hand_out_particles(some, velocities_of(some), {}, pieces, ranks, [&](const ParticlePiece& piece) {
           const std::lock_guard lock(mutex);
           EXPECT_FALSE(seen.contains(piece.number));
           seen[piece.number] = {*piece.particles, *piece.velocity, ranks.rank()};
         });
       }))
    if (end) std::rethrow_exception(end);
  return seen;
}

TEST(ParticlePieces, AreAllParticlesByIdOnAnyNumberOfRanks) {
  for (const std::size_t count : {97u, 5u, 1u}) {
    const Particles all = scattered(count);
    Particles sorted = all;
    sort_by_id(sorted);
    for (const std::size_t pieces : {1u, 2u, 5u})
      for (const int size : {1, 2, 3, 8}) {
        if (pieces > count) continue;
        const PiecesByNumber seen = handed_out(all, pieces, size);
        ASSERT_EQ(seen.size(), pieces);
        Particles together = none();
        int last = 0;
        for (const auto& [number, piece] : seen) {
          EXPECT_GE(piece.particles.size(), count / pieces) << "piece " << number;
          EXPECT_LE(piece.particles.size(), count / pieces + 1) << "piece " << number;
          EXPECT_TRUE(piece.particles.path.empty());
          EXPECT_EQ(piece.velocity, velocities_of(piece.particles));
          EXPECT_GE(piece.rank, last) << "neighbours are on one rank";
          last = piece.rank;
          std::vector<std::size_t> whole(piece.particles.size());
          for (std::size_t j = 0; j < whole.size(); ++j) whole[j] = j;
          unpack(pack(piece.particles, whole), together);
        }
        expect_same(together, sorted);
      }
  }
}

TEST(ParticlePieces, AreAsFewAsTheLimitAllows) {
  EXPECT_EQ(pieces_of_particles(0, 100), 1u);
  EXPECT_EQ(pieces_of_particles(100, 100), 1u);
  EXPECT_EQ(pieces_of_particles(101, 100), 2u);
  EXPECT_EQ(pieces_of_particles(std::size_t{1} << 40, 4194304), std::size_t{1} << 18);
}

TEST(ParticlePieces, AFailingReceiverEndsAllRanks) {
  const Particles all = scattered(30);
  const auto ends = ends_on_ranks(3, [&](base::Communicator& ranks) {
    hand_out_particles(all, velocities_of(all), {}, 4, ranks, [&](const ParticlePiece& piece) {
      if (piece.number == 2) throw FileError("the disk is full");
    });
  });
  for (const auto& end : ends) {
    ASSERT_TRUE(end);
    EXPECT_THROW(std::rethrow_exception(end), FileError);
  }
}

// What a run hands out, beside a run that does not.
class WatchOfPieces : public Observer {
 public:
  WatchOfPieces(std::map<int, PiecesByNumber>& seen, std::mutex& mutex, std::size_t& most_held)
      : seen_(seen), mutex_(mutex), most_held_(most_held) {}
  std::string name() const override { return "watch"; }
  bool takes_particle_pieces() const override { return true; }
  void particle_piece(const Frame& frame, const ParticlePiece& piece) override {
    const std::lock_guard lock(mutex_);
    seen_[frame.index][piece.number] = {*piece.particles, *piece.velocity, 0};
  }
  void frame(const Frame& frame) override {
    const std::lock_guard lock(mutex_);
    most_held_ = std::max(most_held_, frame.particles->size());
  }

 private:
  std::map<int, PiecesByNumber>& seen_;
  std::mutex& mutex_;
  std::size_t& most_held_;
};

TEST(ParticlePieces, OfARunAreItsParticlesAndNobodyGathersThem) {
  const std::vector<std::string> case_of_tiles = {"particles.per_axis=301",     "density.shape=\"wendland\"",
                                                  "density.center=[0.4, 0.05]", "density.radius=0.2",
                                                  "velocity.u=[\"-y\", \"x\"]", "output.times=[0, 0.3]",
                                                  "evaluate.per_axis=150",      "evaluate.tile_particles=300",
                                                  "particles.overlap=1",        "output.vtk=[\"particles\"]"};
  std::vector<std::string> with_pieces = case_of_tiles;
  with_pieces.emplace_back("output.piece_particles=400");
  Simulation plain(scene_of(case_of_tiles), 1);
  std::vector<std::pair<Particles, std::vector<double>>> expected;
  plain.observe("test", [&](const Frame& frame) {
    EXPECT_EQ(frame.particle_pieces, 1u);
    expected.emplace_back(*frame.particles, *frame.velocity);
  });
  plain.run();
  const Case spec = scene_of(with_pieces);
  for (const int size : {1, 2, 5}) {
    std::map<int, PiecesByNumber> seen;
    std::mutex mutex;
    std::size_t most_held = 0;
    for (const auto& end : ends_on_ranks(size, [&](base::Communicator& ranks) {
           Simulation simulation(spec, 1, ranks);
           simulation.observe(std::make_unique<WatchOfPieces>(seen, mutex, most_held));
           simulation.run();
         }))
      if (end) std::rethrow_exception(end);
    ASSERT_EQ(seen.size(), expected.size());
    for (const auto& [output, pieces] : seen) {
      const auto& [particles, velocity] = expected[static_cast<std::size_t>(output)];
      ASSERT_GE(pieces.size(), 5u);
      std::size_t before = 0;
      for (const auto& [number, piece] : pieces) {
        EXPECT_LE(piece.particles.size(), 400u);
        for (std::size_t j = 0; j < piece.particles.size(); ++j) {
          ASSERT_EQ(piece.particles.id[j], particles.id[before + j]);
          for (std::size_t k = 0; k < 2; ++k) {
            ASSERT_EQ(piece.particles.position[k][j], particles.position[k][before + j]);
            ASSERT_EQ(piece.velocity[2 * j + k], velocity[2 * (before + j) + k]);
          }
          ASSERT_EQ(piece.particles.alpha[j], particles.alpha[before + j]);
        }
        before += piece.particles.size();
      }
      EXPECT_EQ(before, particles.size());
    }
    if (size > 1) {
      EXPECT_LT(most_held, expected.front().first.size()) << "rank 0 has a part of them alone";
    }
  }
}

}  // namespace
}  // namespace gaussdrift
