// Cases as large as those that people give to several ranks: the same bits without MPI and on 1 to 8 ranks.
#include <gtest/gtest.h>

#include <string>

#include "case_text.hpp"
#include "parsed_json.hpp"
#include "program/same_run.hpp"
#include "ranks/mpirun.hpp"

namespace gaussdrift {
namespace {

/// Tiles and particles of a run, as its summary has them.
struct Size {
  std::size_t tiles = 0, particles = 0;
};

Size size_of(const fs::path& run) {
  const auto summary = parsed_json(read_file(run / "summary.json"));
  const auto chosen = summary["evaluate"]["chosen"].get<std::string>();  // "16 tiles, the fullest by ..."
  const bool tiles = chosen.find(" tiles, the fullest by") != chosen.npos;
  return {tiles ? std::stoul(chosen) : 1, summary["particles"]["carried"].get<std::size_t>()};
}

/// Calls look(size) once; then every number of ranks has to give the same files.
template <class Look>
void expect_same_bits(const std::string& text, const Look& look) {
  const ScratchFolder folder;
  write_file(folder / "large.toml", text);
  const std::string run = "run large.toml --threads 1 --out ";
  const Outcome alone = gaussdrift_in(folder, run + "alone");
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  look(size_of(folder / "alone"));
  for (const int ranks : {1, 2, 3, 4, 8}) {
    const Outcome shared = on_ranks_of_mpi(ranks, "'" PROGRAM "' " + run + "shared", folder);
    ASSERT_EQ(shared.exit_code, 0) << shared.err;
    expect_same(folder / "alone", folder / "shared");
    fs::remove_all(folder / "shared");
  }
}

// All particles in 2 % of the plane, and there most of them in the middle.
TEST(LargeCases, AMillionParticlesInADenseCone) {
  NEEDS_MPIRUN();
  const std::string text = case_text({.velocity = velocity_of({"-y+0.1*x", "x"}),
                                      .density = shape_of("wendland", "0.4, 0.05", "0.16"),
                                      .particles = "per_axis = 7101\noverlap = 1.5",
                                      .time = "end = 0.1\nstep = 0.1",
                                      .evaluate = "per_axis = 801\ntile_particles = 60000",
                                      .reference = not_compared,
                                      .output = "times = [0.1]\nimages = []\nreport = \"none\"\nvtk = [\"density\"]"});
  expect_same_bits(text, [](const Size& size) {
    EXPECT_GE(size.particles, 1'000'000u);
    EXPECT_GE(size.tiles, 16u);
  });
}

TEST(LargeCases, AGridOfMoreThan256PointsOnEachAxisInSpace) {
  NEEDS_MPIRUN();
  const std::string text = case_text({.domain = cube,
                                      .velocity = velocity_of({"-y", "x", "0.2"}),
                                      .density = shape_of("wendland", "0.3, 0.1, -0.05", "0.4"),
                                      .particles = "per_axis = 201\noverlap = 1",
                                      .time = "end = 0.1\nstep = 0.1",
                                      .evaluate = "per_axis = 260\ntolerance = 1e-6",
                                      .reference = not_compared,
                                      .output = "times = [0.1]\nimages = []\nreport = \"none\"\nvtk = [\"density\"]"});
  expect_same_bits(text, [](const Size& size) { EXPECT_GE(size.tiles, 8u); });
}

}  // namespace
}  // namespace gaussdrift
