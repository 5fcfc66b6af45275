// Checkpoints that several ranks write together: the bytes of one rank, and nobody holds all particles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "gaussdrift/error.hpp"
#include "particle/placing.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"
#include "scratch_folder.hpp"
#include "sim/run_state.hpp"
#include "write/checkpoint.hpp"

namespace gaussdrift::write {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t in_a_piece = 7;

/// By id, with gaps; some columns as effects want them.
Particles some_particles(std::size_t count) {
  Particles particles;
  for (std::size_t j = 0; j < count; ++j) {
    particles.position[0].push_back(0.1 * static_cast<double>(j));
    particles.position[1].push_back(-static_cast<double>(j));
    particles.alpha.push_back(1.0 / static_cast<double>(j + 3));
    particles.id.push_back(static_cast<std::int64_t>(j * j) - 20);
  }
  particles.path.assign(2, std::vector<double>(count, 0.25));
  particles.volume.assign(count, 0.5);
  particles.spread = 0.1;
  return particles;
}

/// Scattered, and the last rank has none.
Particles of_rank(const Particles& all, const base::Communicator& ranks) {
  const std::size_t sharing = std::max<std::size_t>(1, static_cast<std::size_t>(ranks.size()) - 1);
  std::vector<std::size_t> own;
  for (std::size_t j = 0; j < all.size(); ++j)
    if (5 * j % 11 % sharing == static_cast<std::size_t>(ranks.rank())) own.push_back(j);
  Particles some;
  some.dimension = all.dimension, some.spread = all.spread;
  some.path.resize(all.path.size());
  unpack(pack(all, own), some);
  return some;
}

std::string state_on_ranks(std::string run, std::vector<std::string> outputs) {
  RunState parts{.run = std::move(run), .outputs = std::move(outputs)};
  return joined(parts);
}

/// Two checkpoints of so many particles. received: bytes, by rank.
void write_on(int size, const ScratchFolder& folder, std::size_t count, std::vector<double>* received = nullptr) {
  const Particles all = some_particles(count);
  if (received) received->assign(static_cast<std::size_t>(size), 0);
  on_ranks(size, [&](base::Communicator& ranks) {
    const InHaste always = [] { return true; };  // the disk is slow
    CheckpointWriter writer(folder.path(), {}, {.in_haste = always, .piece_particles = in_a_piece}, ranks);
    const Particles own = of_rank(all, ranks);
    const bool first = ranks.rank() == 0;
    writer.write(first ? "hash" : "", 1, 10, own, first ? state_on_ranks("first", {"one"}) : "");
    const CheckpointFacts facts =
        writer.write(first ? "hash" : "", 2, 20, own, first ? state_on_ranks("second", {"one", "two"}) : "");
    if (first) {
      EXPECT_EQ(facts.particles, count);
    }
    if (received)
      (*received)[static_cast<std::size_t>(ranks.rank())] = static_cast<double>(ranks.traffic().received) / 2;
  });
}

std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
  return files;
}

TEST(CheckpointOnRanks, HasTheBytesOfOneRank) {
  for (const std::size_t count : {50u, 14u, 3u}) {
    const ScratchFolder alone;
    write_on(1, alone, count);
    const auto expected = files_in(alone / "state");
    ASSERT_EQ(expected.size(), 2 * ((count + in_a_piece - 1) / in_a_piece + 2) + 1);
    for (const int size : {2, 3, 4, 8}) {
      const ScratchFolder shared;
      write_on(size, shared, count);
      EXPECT_EQ(files_in(shared / "state"), expected) << count << " particles, " << size << " ranks";
    }
  }
}

/// A particle has seven numbers. Rank 0 has a quarter of the pieces; the rest is what manifests and agreements take.
TEST(CheckpointOnRanks, NobodyReceivesAllParticles) {
  const ScratchFolder folder;
  constexpr double count = 7000, bytes = 7 * 8 * count;
  std::vector<double> received;
  write_on(4, folder, static_cast<std::size_t>(count), &received);
  for (std::size_t rank = 1; rank < received.size(); ++rank) EXPECT_LT(received[rank], 0.4 * bytes) << rank;
  // A line of JSON for each piece of seven particles.
  EXPECT_LT(received[0], 0.4 * bytes + 150 * count / in_a_piece);
}

TEST(CheckpointOnRanks, EachReadsSomePieces) {
  const ScratchFolder folder;
  write_on(3, folder, 50);
  const Particles all = some_particles(50);
  for (const int size : {1, 2, 4, 8, 11}) {
    std::vector<Particles> parts(static_cast<std::size_t>(size));
    on_ranks(size, [&](base::Communicator& ranks) {
      std::vector<std::string> refused;
      auto checkpoint = read_checkpoint(folder.path(), "hash", refused, ranks);
      ASSERT_TRUE(checkpoint);
      EXPECT_EQ(checkpoint->facts.time, 2);
      EXPECT_EQ(checkpoint->facts.particles, 50u);
      EXPECT_EQ(checkpoint->state, ranks.rank() == 0 ? state_on_ranks("second", {"one", "two"}) : "");
      const std::size_t pieces = 8,
                        most = (pieces + static_cast<std::size_t>(size) - 1) / static_cast<std::size_t>(size);
      EXPECT_LE(checkpoint->particles.size(), most * in_a_piece);
      parts[static_cast<std::size_t>(ranks.rank())] = std::move(checkpoint->particles);
    });
    Particles together;
    together.dimension = all.dimension, together.spread = all.spread;
    together.path.resize(all.path.size());
    for (const Particles& part : parts) {
      std::vector<std::size_t> whole(part.size());
      for (std::size_t j = 0; j < whole.size(); ++j) whole[j] = j;
      unpack(pack(part, whole), together);
    }
    expect_same(together, all);
  }
}

TEST(CheckpointOnRanks, ADamagedPieceMakesAllTakeTheOlder) {
  const ScratchFolder folder;
  write_on(3, folder, 50);
  std::string piece = read_file(folder / "state/1/particles_0006.raw");
  piece[5] = static_cast<char>(piece[5] ^ 1);
  write_file(folder / "state/1/particles_0006.raw", piece);
  on_ranks(3, [&](base::Communicator& ranks) {
    std::vector<std::string> refused;
    const auto checkpoint = read_checkpoint(folder.path(), "hash", refused, ranks);
    ASSERT_TRUE(checkpoint);
    EXPECT_EQ(checkpoint->facts.time, 1);
    ASSERT_EQ(refused.size(), ranks.rank() == 0 ? 1u : 0u);
    if (ranks.rank() == 0) {
      EXPECT_NE(refused[0].find("particles_0006.raw is damaged: its check sum is wrong"), std::string::npos)
          << refused[0];
    }
  });
}

/// A piece cannot take its name on one rank: all of them throw the same, and the one before stands.
TEST(CheckpointOnRanks, AFailureOfOneRankLeavesTheOneBefore) {
  const ScratchFolder folder;
  write_on(3, folder, 50);
  fs::remove(folder / "state/0/particles_0006.raw");
  fs::create_directories(folder / "state/0/particles_0006.raw/in the way");
  const Particles all = some_particles(50);
  const auto ends = ends_on_ranks(3, [&](base::Communicator& ranks) {
    CheckpointWriter writer(folder.path(), {}, {.piece_particles = in_a_piece}, ranks);
    writer.write("hash", 3, 30, of_rank(all, ranks), ranks.rank() == 0 ? state_on_ranks("third", {"one", "two"}) : "");
  });
  for (const std::exception_ptr& end : ends) {
    ASSERT_TRUE(end);
    try {
      std::rethrow_exception(end);
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("particles_0006.raw"), std::string::npos) << error.what();
    }
  }
  std::vector<std::string> refused;
  base::Communicator alone;
  EXPECT_EQ(read_checkpoint(folder.path(), "hash", refused, alone)->facts.time, 2);
  for (const auto& entry : fs::directory_iterator(folder / "state/0"))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path() << " is left over";
}

}  // namespace
}  // namespace gaussdrift::write
