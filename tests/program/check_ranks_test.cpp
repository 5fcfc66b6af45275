// gaussdrift check --ranks: what a run on N ranks would be like, without having them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "accuracy/rank_forecast.hpp"
#include "parsed_json.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

nlohmann::json ranks_of(const ScratchFolder& folder, const std::string& more) {
  const Outcome outcome = gaussdrift_in(folder, "check cone.toml --json " + more);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return parsed_json(outcome.out).value("ranks", nlohmann::json());
}

// 16 tiles and a cone in 2 % of the domain.
const std::string dense =
    " --set density.radius=0.16 --set particles.per_axis=401 --set particles.overlap=1 --set evaluate.per_axis=201 "
    "--set evaluate.tile_particles=100 --set 'output.images=[]'";

TEST(CheckRanks, IsSilentWhereNobodyAsks) {
  const ScratchFolder folder;
  write_file(folder / "cone.toml", small_case);
  EXPECT_TRUE(ranks_of(folder, "").is_null());
  EXPECT_EQ(gaussdrift_in(folder, "check cone.toml").out.find("\nranks "), std::string::npos);
  EXPECT_EQ(gaussdrift_in(folder, "check cone.toml --ranks 0").exit_code, 2);
}

TEST(CheckRanks, OfOneTileSaysThatOthersAreIdle) {
  const ScratchFolder folder;
  write_file(folder / "cone.toml", small_case);
  const auto ranks = ranks_of(folder, "--ranks 4");
  EXPECT_EQ(ranks.at("tiles"), 1);
  EXPECT_EQ(ranks.at("idle"), 3);
  EXPECT_EQ(ranks.at("most_useful_ranks"), 1);
  EXPECT_EQ(ranks.at("gathered_bytes"), 0);
  EXPECT_EQ(ranks.at("received_bytes"), 0);
  const Outcome text = gaussdrift_in(folder, "check cone.toml --ranks 4");
  EXPECT_NE(text.out.find("\nranks      4 ranks: 1 tile, 3 ranks idle; with more than 1 some are idle\n"),
            std::string::npos)
      << text.out;
  EXPECT_NE(text.out.find("computed from the particles at the start, not measured"), std::string::npos) << text.out;
}

TEST(CheckRanks, SpreadsADenseCone) {
  const ScratchFolder folder;
  write_file(folder / "cone.toml", small_case);
  const auto one = ranks_of(folder, "--ranks 1" + dense), four = ranks_of(folder, "--ranks 4" + dense);
  EXPECT_GE(four.at("tiles"), 16);
  EXPECT_EQ(one.at("tiles"), four.at("tiles")) << "tiles do not depend on the ranks";
  EXPECT_EQ(four.at("idle"), 0);
  EXPECT_GE(four.at("most_useful_ranks"), 4);
  EXPECT_EQ(one.at("balance"), 1);
  EXPECT_GE(four.at("balance"), 1);
  EXPECT_LT(four.at("balance"), 1.3);
  EXPECT_EQ(one.at("gathered_bytes"), 0);
  EXPECT_GT(four.at("gathered_bytes"), 0);
  EXPECT_LT(four.at("gathered_bytes"), 8 * 201 * 201);
  EXPECT_GT(four.at("received_bytes"), 0);
  EXPECT_LT(four.at("memory_bytes_largest_other"), four.at("memory_bytes_rank_0"));
}

// A grid of 101 x 101 points is halved four times, and each piece is a tile at least.
TEST(CheckRanks, SharesTheTilesOfPieces) {
  const ScratchFolder folder;
  write_file(folder / "cone.toml", small_case);
  const auto ranks = ranks_of(
      folder, "--ranks 4 --set evaluate.per_axis=101 --set evaluate.piece_points=1000 --set 'output.images=[]'");
  EXPECT_EQ(ranks.at("tiles"), 16);
  EXPECT_EQ(ranks.at("idle"), 0);
}

// Rank 0 has the one tile. Three quarters of its velocities, of 16 bytes, come from the others, and so do places, weights
// and numbers, 32 bytes, of three quarters of the particles that it sums for, in the worst case.
TEST(CheckRanks, TellsWhatParticlesThatMoveEachOtherSend) {
  const ScratchFolder folder;
  write_file(folder / "cone.toml", small_case);
  EXPECT_EQ(ranks_of(folder, "--ranks 4").at("pair_velocity_bytes"), 0);
  write_file(folder / "cone.toml", small_case + "\n[effects.vortex]\n");
  EXPECT_EQ(ranks_of(folder, "--ranks 1").at("pair_velocity_bytes"), 0);
  const Outcome outcome = gaussdrift_in(folder, "check cone.toml --json --ranks 4");
  const auto check = parsed_json(outcome.out);
  EXPECT_EQ(check.at("ranks").at("refused"), "");
  const double particles = check.at("particles");
  EXPECT_GT(particles, 100);
  EXPECT_DOUBLE_EQ(check.at("ranks").at("pair_velocity_bytes"), 0.75 * (16 + 32.0 / 4) * particles);
}

// The trial sees a part of these particles; the tiles are about as many as a run finds.
TEST(CheckRanks, OfALargeCaseIsSampled) {
  const ScratchFolder folder;
  write_file(folder / "cone.toml", small_case);
  const auto ranks = ranks_of(folder, "--ranks 4 --set particles.per_axis=8000 --set evaluate.per_axis=1000");
  EXPECT_EQ(ranks.at("particles_counted"), false);
  EXPECT_GE(ranks.at("tiles"), 4);  // 3.1e6 particles, at most 262144 in a tile that can be halved
  EXPECT_EQ(ranks.at("idle"), 0);
}

TEST(CheckRanks, FindsTheMostUsefulNumber) {
  EXPECT_EQ(accuracy::most_useful_ranks({1, 1, 1, 1}), 4u);
  EXPECT_EQ(accuracy::most_useful_ranks({5}), 1u);
  EXPECT_EQ(accuracy::most_useful_ranks({0, 0}), 1u);
  EXPECT_EQ(accuracy::most_useful_ranks({8, 1, 1}), 2u) << "of three, the first would have nothing";
}

}  // namespace
}  // namespace gaussdrift
