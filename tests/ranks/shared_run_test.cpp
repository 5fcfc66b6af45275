// Runs that several ranks share, started as a user does: the same files on any number of ranks, how they stop, go on and
// fail. tests/effect/shared_run_test.cpp asks the same of the library.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "case_text.hpp"
#include "program/same_run.hpp"
#include "ranks/mpirun.hpp"

namespace gaussdrift {
namespace {

/// The page's player shows particles where a run has them together: several ranks bring them together for pictures alone.
void expect_same_but_player(const fs::path& whole, const fs::path& other) {
  fs::remove(whole / "report.frames");
  fs::remove(other / "report.frames");
  expect_same(whole, other);
}

const std::string run = "'" PROGRAM "' run ";

/// Narrow blobs on a fine grid, so that there are several tiles; small all the same.
std::string small(const std::string& more = "") {
  return " --set particles.per_axis=201 --set particles.overlap=1 --set evaluate.per_axis=121 --set "
         "evaluate.tile_particles=200 --set 'output.images=[]' " +
         more;
}

std::vector<std::string> all_cases() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(SOURCE_DIR "/cases"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// A copy of a case with its data and without its checks, whose times need not be outputs of a shorter run.
std::string copy_of(const std::string& name, const ScratchFolder& folder) {
  for (const auto& entry : fs::directory_iterator(SOURCE_DIR "/cases"))
    if (entry.path().extension() != ".toml" && !fs::exists(folder / entry.path().filename().string()))
      fs::copy_file(entry.path(), folder / entry.path().filename().string());
  const std::string text = read_file(fs::path(SOURCE_DIR "/cases") / (name + ".toml"));
  write_file(folder / (name + ".toml"), text.substr(0, text.find("[[check]]")));
  return name + ".toml";
}

class EveryCase : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Shared, EveryCase, testing::ValuesIn(all_cases()),
                         [](const auto& name) { return name.param; });

TEST_P(EveryCase, HasTheSameFilesOnThreeRanksOrIsRefused) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  std::string more;
  if (GetParam() == "shear_diffusion") more = "--set time.step=0.02 ";  // narrow blobs exchange faster
  if (GetParam() == "uneven_diffusion") more = "--set particles.per_axis=101 --set particles.overlap=2 ";  // the same
  const auto is_one_of = [](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), GetParam()) != names.end();
  };
  if (is_one_of({"abc", "enright"})) more = "--set particles.per_axis=101 --set evaluate.per_axis=61 ";  // in space
  // Particles that move each other are summed at every stage.
  if (is_one_of({"charged_ball"})) more = "--set particles.per_axis=61 --set evaluate.per_axis=41 ";
  if (is_one_of({"periodic_abc"})) more = "--set particles.per_axis=12 --set evaluate.per_axis=16 ";
  if (is_one_of({"charged_cloud", "lamb_oseen"}))
    more = "--set particles.per_axis=101 --set evaluate.per_axis=61 --set evaluate.tile_particles=100 ";
  const std::string arguments = copy_of(GetParam(), folder) + small("--set time.end=0.2 --set output.frames=3 " + more);
  const Outcome three = on_ranks_of_mpi(3, run + arguments + "--out three", folder);
  if (three.exit_code == 3) {
    EXPECT_NE(three.err.find("3 ranks cannot share this case; start it on one rank"), std::string::npos) << three.err;
    EXPECT_FALSE(fs::exists(folder / "three"));
    return;
  }
  const Outcome alone = outcome_of(folder, run + arguments + "--out alone");
  EXPECT_EQ(three.exit_code, alone.exit_code) << three.err << alone.err;
  expect_same_but_player(folder / "alone", folder / "three");
}

TEST(SharedRun, HasTheSameFilesOnAnyNumberOfRanks) {
  NEEDS_MPIRUN();
  for (const std::string name : {"rotating_cone", "swirl", "decay"}) {
    const ScratchFolder folder;
    const std::string arguments = copy_of(name, folder) + small("--set time.end=0.3 --set output.frames=3 ");
    const Outcome alone = outcome_of(folder, run + arguments + "--out alone");
    for (const int ranks : {1, 2, 4, 8}) {
      const std::string out = "on_" + std::to_string(ranks);
      const Outcome shared = on_ranks_of_mpi(ranks, run + arguments + "--out " + out, folder);
      EXPECT_EQ(shared.exit_code, alone.exit_code) << shared.err;
      EXPECT_NE(shared.err.find(std::to_string(ranks) + (ranks == 1 ? " rank on 1 host" : " ranks on 1 host")),
                std::string::npos)
          << shared.err;
      expect_same_but_player(folder / "alone", folder / out);
    }
  }
}

// Pictures, particles, the page and a reference on the whole grid.
TEST(SharedRun, DrawsTheSamePictures) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  const std::string arguments = copy_of("rotating_cone", folder) +
                                " --set particles.per_axis=201 --set particles.overlap=0.8 --set "
                                "evaluate.per_axis=150 --set evaluate.tile_particles=300 --set time.end=0.1 --set "
                                "output.frames=2 ";
  outcome_of(folder, run + arguments + "--out alone");
  const Outcome shared = on_ranks_of_mpi(2, run + arguments + "--out shared", folder);
  EXPECT_NE(shared.exit_code, 3) << shared.err;
  EXPECT_NE(read_file(folder / "shared/summary.json").find(" tiles, the fullest by"), std::string::npos);
  expect_same_but_player(folder / "alone", folder / "shared");
}

TEST(SharedRun, StopsAndGoesOnWithAnotherNumberOfRanks) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  const std::string arguments =
      copy_of("rotating_cone", folder) + small(
                                             "--set time.end=3 --set time.step=0.0002 --set output.frames=3 "
                                             "--set output.piece_particles=300 ");
  const Outcome alone = outcome_of(folder, run + arguments + "--out alone");
  const Outcome stopped = on_ranks_of_mpi(3, run + arguments + "--out parts --stop-after 0.1", folder);
  EXPECT_EQ(stopped.exit_code, 7) << stopped.err;
  EXPECT_NE(stopped.err.find("resume with: gaussdrift resume parts"), std::string::npos) << stopped.err;
  EXPECT_TRUE(fs::exists(folder / "parts/state/0/particles_0003.raw")) << "checkpoints come in pieces, too";
  const Outcome two = on_ranks_of_mpi(2, "'" PROGRAM "' resume parts --stop-after 0.1", folder);
  EXPECT_EQ(two.exit_code, 7) << two.err;
  const Outcome rest = outcome_of(folder, "'" PROGRAM "' resume parts");
  EXPECT_EQ(rest.exit_code, alone.exit_code) << rest.err;
  expect_same_but_player(folder / "alone", folder / "parts");
}

// One rank would have to hold all particles.
TEST(SharedRun, ExplainsErrorsOfFewParticlesAlone) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  const std::string arguments =
      copy_of("rotating_cone", folder) + small("--set time.end=0.3 --set output.frames=2 --set output.vtk=[] ");
  const Outcome few = on_ranks_of_mpi(2, run + arguments + "--out few", folder);
  EXPECT_NE(few.exit_code, 3) << few.err;
  EXPECT_NE(read_file(folder / "few/summary.json").find("\"accuracy_table"), std::string::npos);
  EXPECT_EQ(times_in(few.err, "output.piece_particles"), 0u) << few.err;
  const Outcome many = on_ranks_of_mpi(2, run + arguments + "--out many --set output.piece_particles=300", folder);
  EXPECT_EQ(many.exit_code, few.exit_code) << many.err;
  EXPECT_EQ(times_in(many.err, "several ranks bring at most output.piece_particles = 300 together"), 1u) << many.err;
  EXPECT_EQ(read_file(folder / "many/summary.json").find("\"accuracy_table"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "many/report.html")) << "the page has the rest";
  const Outcome alone = outcome_of(folder, run + arguments + "--out alone --set output.piece_particles=300");
  EXPECT_EQ(times_in(alone.err, "output.piece_particles"), 0u) << alone.err;
}

TEST(SharedRun, OfACompleteFolderSaysSoOnce) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  const std::string arguments = copy_of("decay", folder) + small("--set time.end=0.1 --set output.frames=2 ");
  on_ranks_of_mpi(2, run + arguments + "--out there", folder);
  const Outcome again = on_ranks_of_mpi(2, "'" PROGRAM "' resume there", folder);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, "there is complete. --until T lengthens it.\n");
  const Outcome refused = on_ranks_of_mpi(2, run + arguments + "--out there", folder);
  EXPECT_EQ(refused.exit_code, 6) << refused.err;
  EXPECT_EQ(refused.err.find("error: "), refused.err.rfind("error: ")) << refused.err;
}

TEST(SharedRun, TellsAFailureOnce) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  // Particles that come to x = 0.85 have no velocity: those are on one rank.
  write_file(folder / "case.toml", case_text({.velocity = velocity_of({"1 + 0*sqrt(0.85 - x)", "0"}),
                                              .density = shape_of("wendland", "0.3, 0", "0.3"),
                                              .particles = "per_axis = 201\noverlap = 0.7",
                                              .time = "end = 1\nstep = 0.01",
                                              .evaluate = "per_axis = 201\ntile_particles = 200",
                                              .output = "frames = 5\nimages = []"}));
  const Outcome alone = outcome_of(folder, run + "case.toml --out alone");
  const Outcome shared = on_ranks_of_mpi(3, run + "case.toml --out shared", folder);
  EXPECT_EQ(alone.exit_code, 4);
  EXPECT_EQ(shared.exit_code, 4) << shared.err;
  EXPECT_EQ(shared.err.find("error: "), shared.err.rfind("error: ")) << shared.err;
  EXPECT_NE(shared.err.find("the velocity is (nan"), std::string::npos) << shared.err;
  EXPECT_EQ(bits_of(folder / "alone"), bits_of(folder / "shared")) << "what was written before is whole";
}

TEST(SharedPieces, AreTheSameFilesOnAnyNumberOfRanks) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  const std::string arguments = copy_of("rotating_cone", folder) +
                                small(
                                    "--set time.end=0.2 --set output.frames=2 --set evaluate.piece_points=1200 --set "
                                    "output.piece_particles=500 --set output.report=none ");
  ASSERT_EQ(outcome_of(folder, run + arguments + "--out alone").exit_code, 0);
  ASSERT_TRUE(fs::exists(folder / "alone/density/density_0001.pvti"));
  ASSERT_TRUE(fs::exists(folder / "alone/density/density_0001/0015.vti"));
  ASSERT_TRUE(fs::exists(folder / "alone/particles/particles_0001.pvtp"));
  ASSERT_TRUE(fs::exists(folder / "alone/particles/particles_0001/0003.vtp"));
  for (const int ranks : {1, 2, 3, 4}) {
    const std::string name = "on" + std::to_string(ranks);
    const Outcome shared = on_ranks_of_mpi(ranks, run + arguments + "--out " + name, folder);
    ASSERT_EQ(shared.exit_code, 0) << shared.err;
    expect_same_but_player(folder / "alone", folder / name);
  }
}

}  // namespace
}  // namespace gaussdrift
