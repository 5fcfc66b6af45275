// Every way in which a run on several ranks may end before its time: one message, no process left, whole files, and the
// run that goes on has the bits of one that never stopped. tests/ranks-long has those that take longer, or need two hosts.
#include <gtest/gtest.h>
#include <unistd.h>

#include <sstream>
#include <string>

#include "cli/common_ground.hpp"
#include "faults/whole_files.hpp"
#include "program/same_run.hpp"
#include "ranks/disturbed_ranks.hpp"
#include "ranks/turning_cone.hpp"
#include "ranks_of_threads.hpp"

namespace gaussdrift {
namespace {

const std::string long_run = "run long.toml --out part --threads 1";

class Ends : public testing::Test {
 protected:
  void SetUp() override {
    NEEDS_MPIRUN();
    write_file(folder / "long.toml", turning_cone("2e-5"));
    write_file(folder / "short.toml", turning_cone("0.01"));
  }

  /// What was written is whole, nobody is left, and it goes on on `ranks` ranks with the same bits.
  void goes_on(int ranks, const std::string& text = "long.toml") {
    EXPECT_EQ(left_in(folder), "");
    EXPECT_EQ(unreadable_in(folder / "part"), "");
    const Outcome rest = on_ranks_of_mpi(ranks, "'" PROGRAM "' resume part --threads 1", folder);
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    const Outcome alone = gaussdrift_in(folder, "run " + text + " --out whole");
    EXPECT_EQ(alone.exit_code, 0) << alone.err;
    expect_same(folder / "whole", folder / "part");
    EXPECT_EQ(left_in(folder), "");
  }

  std::string faults(const std::string& which) const {
    return "export OMP_WAIT_POLICY=passive LD_PRELOAD=" FAULTS_LIBRARY " FAULTS_FOLDER=" +
           (fs::canonical(folder.path()) / "part").string() + " FAULTS_REPORT=report.txt " + which;
  }

  long told(const char* what) const {
    std::istringstream report(read_file(folder / "report.txt"));
    std::string word;
    while (report >> word)
      if (word == what) break;
    long number = 0;
    report >> number;
    return number;
  }

  const ScratchFolder folder;
};

TEST_F(Ends, ByLackOfMemoryOnOneRankWhileOthersWait) {
  const std::string arguments = "run short.toml --out part --threads 1";
  const Outcome whole = on_ranks_of_mpi(3, with_one_rank(1, faults("FAULTS_NEW_ALL=1"), arguments), folder);
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const long allocations = told("allocations");
  ASSERT_GT(allocations, 1000);
  for (const long part : {60, 80, 95}) {  // of a hundred; the first half starts the program
    fs::remove_all(folder / "part");
    const std::string fault = "FAULTS_NEW_ALL=1 FAULTS_NEW_AT=" + std::to_string(allocations * part / 100);
    const Outcome outcome = on_ranks_of_mpi(3, with_one_rank(1, faults(fault), arguments), folder);
    EXPECT_EQ(outcome.exit_code, 3) << part << "\n" << outcome.err;
    EXPECT_EQ(times_in(outcome.err, "out of memory"), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find("rank 1 of 3"), std::string::npos) << outcome.err;
    EXPECT_EQ(left_in(folder), "");
    if (fs::exists(folder / "part")) {
      EXPECT_EQ(unreadable_in(folder / "part"), "");
    }
  }
}

TEST_F(Ends, ByTheKillOfARank) {
  const Outcome killed = when_there(folder, "part/density/density_0001.vti",
                                    ranks_of_mpi(3, with_one_rank(1, "", long_run)), "kill -9 $(cat rank_1.pid)");
  EXPECT_EQ(killed.exit_code, 128 + 9) << killed.err;
  goes_on(2);
}

TEST_F(Ends, ByAFullDisk) {
  const std::string arguments = "run short.toml --out part --threads 1";
  const Outcome whole = on_ranks_of_mpi(3, with_one_rank(0, faults(""), arguments), folder);
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const long calls = told("calls");
  ASSERT_GT(calls, 50);
  fs::remove_all(folder / "part");
  const std::string fault = "FAULTS_ERROR=28 FAULTS_LASTING=1 FAULTS_AT=" + std::to_string(calls / 2);
  const Outcome full = on_ranks_of_mpi(3, with_one_rank(0, faults(fault), arguments), folder);
  EXPECT_EQ(full.exit_code, 6) << full.err;
  EXPECT_EQ(times_in(full.err, "error: "), 1u) << full.err;
  EXPECT_NE(full.err.find("No space left on device"), std::string::npos) << full.err;
  EXPECT_NE(full.err.find("resume with: gaussdrift resume part"), std::string::npos) << full.err;
  goes_on(2, "short.toml");
}

// Open MPI sends the signal on, waits for a second, kills those that are left, and ends with 1 whatever they say.
TEST_F(Ends, BySignalToMpirun) {
  const Outcome ended =
      when_there(folder, "part/density/density_0001.vti",
                 "sh -c \"echo \\$\\$ > mpirun.pid; exec " + mpirun.substr(0, mpirun.find("timeout")) + MPIRUN +
                     " -q --oversubscribe --bind-to none -n 3 " PROGRAM " " + long_run + "\"",
                 "kill -TERM $(cat mpirun.pid)");
  EXPECT_NE(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(times_in(ended.err, "error: "), 0u) << ended.err;
  // mpirun kills the ranks a second later. Where that is enough they have said how to go on; else they go on all the same.
  const bool in_time = read_file(folder / "part/status.json").find("\"interrupted\"") != std::string::npos;
  EXPECT_GE(times_in(ended.err, "resume with: gaussdrift resume part"), in_time ? 1u : 0u) << ended.err;
  goes_on(4);
}

TEST_F(Ends, BySignalToOneRank) {
  const Outcome ended = when_there(folder, "part/density/density_0001.vti",
                                   ranks_of_mpi(3, with_one_rank(2, "", long_run)), "kill -TERM $(cat rank_2.pid)");
  EXPECT_EQ(ended.exit_code, 128 + 15) << ended.err;
  EXPECT_EQ(times_in(ended.err, "resume with: gaussdrift resume part"), 1u) << ended.err;
  EXPECT_NE(read_file(folder / "part/log.txt").find("(terminated)"), std::string::npos)
      << read_file(folder / "part/log.txt");
  goes_on(1);
}

TEST_F(Ends, BeforeItBeginsWhereARankDoesNotSeeTheFolder) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can hide a folder from a process";
  fs::create_directory(folder / "results");
  const std::string apart = "exec unshare --mount sh -c \"mount -t tmpfs none results && exec " PROGRAM
                            " run short.toml --out results/part\"";
  if (outcome_of(folder, "unshare --mount mount -t tmpfs none results").exit_code != 0)
    GTEST_SKIP() << "this machine lets nobody hide a folder from a process";
  const Outcome refused = on_ranks_of_mpi(3, with_one_rank(1, apart, "run short.toml --out results/part"), folder);
  EXPECT_EQ(refused.exit_code, 6) << refused.err;
  EXPECT_EQ(times_in(refused.err, "error: "), 1u) << refused.err;
  EXPECT_NE(refused.err.find("error: rank 1 on "), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("The folder has to lie on a file system that all hosts share."), std::string::npos)
      << refused.err;
  EXPECT_TRUE(fs::is_empty(folder / "results")) << "nothing is left there";
  EXPECT_EQ(left_in(folder), "");
}

TEST(Odd, MoreRanksThanTilesAndRanksWithoutParticles) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  write_file(folder / "cone.toml", turning_cone("0.01"));
  const auto expect = [&](int ranks, const std::string& set) {
    fs::remove_all(folder / "alone"), fs::remove_all(folder / "shared");
    const Outcome alone = gaussdrift_in(folder, "run cone.toml --out alone " + set);
    const Outcome shared = on_ranks_of_mpi(ranks, "'" PROGRAM "' run cone.toml --out shared " + set, folder);
    EXPECT_EQ(shared.exit_code, alone.exit_code) << shared.err;
    expect_same(folder / "alone", folder / "shared");
    return shared;
  };
  const Outcome one_tile = expect(4, "--set evaluate.tile_particles=100000");
  EXPECT_NE(one_tile.out.find("\nranks  4 on 1 host: the busiest took "), std::string::npos) << one_tile.out;
  expect(6, "--set evaluate.tile_particles=700");  // fewer tiles than ranks
  // All particles in 2 % of the domain.
  const Outcome dense =
      expect(4,
             "--set density.radius=0.16 --set density.center=[0.31,0.27] --set particles.per_axis=401 --set "
             "evaluate.tile_particles=300");
  EXPECT_NE(dense.out.find("\nranks  4 on 1 host: "), std::string::npos) << dense.out;
}

TEST(Odd, ProcessorsAreToldToDiffer) {
  on_ranks(3, [](base::Communicator& ranks) {
    const std::string same = cli::warning_of_different_arithmetic(ranks, "avx2, C library 2.36");
    EXPECT_EQ(same, "");
    const std::string other = cli::warning_of_different_arithmetic(
        ranks, ranks.rank() == 2 ? "avx512, C library 2.36" : "avx2, C library 2.36");
    if (ranks.rank() != 0) {
      EXPECT_EQ(other, "");
      return;
    }
    EXPECT_NE(other.find("has avx2, C library 2.36, rank 2 on "), std::string::npos) << other;
    EXPECT_NE(other.find("has avx512, C library 2.36. The last digits depend on which host computed them."),
              std::string::npos)
        << other;
  });
  EXPECT_NE(cli::arithmetic_here(), "");
}

}  // namespace
}  // namespace gaussdrift
