// The program as several ranks: how it starts, who does the work, what is told, and how all of them end.
#include <gtest/gtest.h>

#include <string>

#include "program/same_run.hpp"
#include "ranks/mpirun.hpp"

namespace gaussdrift {
namespace {

TEST(Communicator, OverMpiKeepsTheLaws) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  for (const auto& [ranks, options] : {std::pair(1, "67108864 1024"), std::pair(2, "67108864 1024"),
                                       std::pair(3, "64 1024"), std::pair(3, "1000 0")}) {
    const Outcome outcome = on_ranks_of_mpi(ranks, "'" ON_MPI "' laws " + std::string(options), folder);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
    EXPECT_EQ(times_in(outcome.out, std::to_string(ranks) + " ranks keep the laws\n"), 1u) << outcome.out;
  }
}

TEST(Ending, ThatAllAgreedOnIsToldOnce) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  const Outcome outcome = on_ranks_of_mpi(3, "'" ON_MPI "' end together", folder);
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_EQ(outcome.err, "error: the velocity is not finite\n");
}

TEST(Ending, OfOneRankEndsThoseThatWaitForIt) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  const auto expect = [&](const std::string& how, int code, const std::string& words) {
    const Outcome outcome = on_ranks_of_mpi(3, "'" ON_MPI "' end " + how, folder);
    EXPECT_EQ(outcome.exit_code, code) << how << "\n" << outcome.err;
    EXPECT_EQ(times_in(outcome.err, words), 1u) << outcome.err;
    EXPECT_EQ(times_in(outcome.err, "error: "), 1u) << outcome.err;
  };
  expect("memory", 3, "rank 1 of 3: error: out of memory; lower particles.per_axis or evaluate.per_axis\n");
  expect("alone", 6, "rank 1 of 3: error: the disk is full\n");
  expect("terminate", 3, "error: out of memory");
}

TEST(Launched, OnOneRankTheRunIsTheSame) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  write_file(folder / "cone.toml", small_case);
  const Outcome alone = gaussdrift_in(folder, "run cone.toml --out alone");
  EXPECT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(times_in(alone.err, " on 1 host"), 0u) << alone.err;
  const Outcome launched = outcome_of(folder, ranks_that_start_again(1, "'" PROGRAM "' run cone.toml --out launched"));
  EXPECT_EQ(launched.exit_code, 0) << launched.err;
  EXPECT_EQ(times_in(launched.err, "1 rank on 1 host\n"), 1u) << launched.err;
  expect_same(folder / "alone", folder / "launched");
}

TEST(Launched, OnSeveralRanksOtherVerbsSpeakOnce) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  const Outcome alone = gaussdrift_in(folder, "explain cutoff");
  const Outcome launched = outcome_of(folder, ranks_that_start_again(3, "'" PROGRAM "' explain cutoff"));
  EXPECT_EQ(launched.exit_code, 0) << launched.err;
  EXPECT_EQ(launched.out, alone.out);
  EXPECT_EQ(launched.err, "");
  const Outcome wrong = on_ranks_of_mpi(3, "'" PROGRAM "' chek cone.toml", folder);
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(times_in(wrong.err, "error: "), 1u) << wrong.err;
  const Outcome missing = on_ranks_of_mpi(2, "'" PROGRAM "' check nowhere.toml", folder);
  EXPECT_EQ(missing.exit_code, 6);
  EXPECT_EQ(missing.err, gaussdrift_in(folder, "check nowhere.toml").err);
}

TEST(Launched, MpiIsStartedUnderALauncherOnly) {
  if (std::string(MPI_IS_CALLED).empty()) GTEST_SKIP() << "the program is built without MPI, or with sanitizers";
  const ScratchFolder folder;
  const std::string preload = "LD_PRELOAD='" MPI_IS_CALLED "' ";
  EXPECT_EQ(gaussdrift_in(folder, "--version", preload).exit_code, 0);
  for (const std::string variable : {"OMPI_COMM_WORLD_SIZE=1", "PMIX_RANK=0", "PMI_RANK=0", "PMI_SIZE=1"}) {
    const Outcome outcome = gaussdrift_in(folder, "--version", preload + variable);
    EXPECT_EQ(outcome.exit_code, 99) << variable;
    EXPECT_EQ(outcome.err, "MPI is started\n") << variable;
  }
}

Outcome without_mpi(const ScratchFolder& folder, const std::string& before) {
  return outcome_of(folder, before + " '" WITHOUT_MPI "' --version");
}

TEST(WithoutMpi, SeveralCopiesAreRefused) {
  const ScratchFolder folder;
  for (const std::string variables : {"OMPI_COMM_WORLD_SIZE=4 OMPI_COMM_WORLD_RANK=0", "PMI_SIZE=4 PMI_RANK=0",
                                      "PMIX_RANK=0 SLURM_STEP_NUM_TASKS=4"}) {
    const Outcome first = without_mpi(folder, variables);
    EXPECT_EQ(first.exit_code, 2) << variables;
    EXPECT_EQ(first.out, "");
    EXPECT_EQ(first.err,
              "error: gaussdrift was started as 4 copies, but it is built without MPI, so they cannot work together.\n"
              "Install MPI (Debian: apt-get install libopenmpi-dev), configure with -D GAUSSDRIFT_MPI=ON and build "
              "again. Or start it once, without mpirun.\n");
  }
  const Outcome other = without_mpi(folder, "PMIX_RANK=1");  // the first one has told it
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.out + other.err, "");
}

TEST(WithoutMpi, OneCopyDoesItsWork) {
  const ScratchFolder folder;
  for (const std::string variables : {"", "OMPI_COMM_WORLD_SIZE=1 OMPI_COMM_WORLD_RANK=0", "PMI_SIZE=1 PMI_RANK=0"})
    EXPECT_EQ(without_mpi(folder, variables).exit_code, 0) << variables;
}

TEST(AnotherMpi, WhoseCopiesFindThemselvesAloneAreRefused) {
  NEEDS_MPIRUN();
  const ScratchFolder folder;
  const Outcome outcome = gaussdrift_in(folder, "--version", "PMI_SIZE=2 PMI_RANK=0");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(times_in(outcome.err, "error: gaussdrift was started as 2 copies, but each of them finds itself alone"), 1u)
      << outcome.err;
}

}  // namespace
}  // namespace gaussdrift
