// Started by mpirun from the tests: on_mpi laws ROUND TOLD_BY_ALL asks MPI what every Communicator does, with rounds of
// so many bytes; on_mpi end HOW ends as the program does when something goes wrong.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

#include "cli/ending.hpp"
#include "cli/terminal.hpp"
#include "communicator_laws.hpp"
#include "mpi/ranks.hpp"

namespace gaussdrift {
namespace {

base::Communicator* ranks = nullptr;

TEST(Mpi, ExchangeBringsEachLetterToItsRank) { laws::exchange(*ranks); }
TEST(Mpi, SumAndMaximumAreThoseOfAll) { laws::sum_and_maximum(*ranks); }
TEST(Mpi, ExtremesOfDoublesKeepNaNAndInfinity) { laws::extremes_of_doubles(*ranks); }
TEST(Mpi, BroadcastComesFromAnyRankAndGatherGoesToTheFirst) { laws::broadcast_and_gather(*ranks); }
TEST(Mpi, ExactSumsHaveTheSameBits) { laws::exact_sums(*ranks); }
TEST(Mpi, AgreesThatNothingIsWrong) { laws::agreement_that_all_is_well(*ranks); }
TEST(Mpi, AgreesOnTheErrorOfTheLowestRankThatHasOne) { laws::agreement_on_trouble(*ranks); }
TEST(Mpi, AbandonsTogether) { laws::abandonment(*ranks); }
TEST(Mpi, IsOnOneHost) {
  EXPECT_EQ(ranks->hosts(), 1);
  EXPECT_EQ(ranks->host(), 0);
}

/// Failures of all ranks; each has told its own.
int failures() {
  std::int64_t failed = RUN_ALL_TESTS();
  ranks->sum(std::span(&failed, 1));
  if (ranks->rank() == 0 && failed == 0) cli::say("{} ranks keep the laws\n", ranks->size());
  return failed ? 1 : 0;
}

ExitCode end(const std::string& how) {
  const bool culprit = ranks->rank() == 1;
  if (how == "together")
    ranks->agree_on([&] {
      if (culprit) throw NumericalError("the velocity is not finite");
    });
  if (culprit && how == "memory") throw std::bad_alloc();
  if (culprit && how == "alone") throw FileError("the disk is full");
  if (culprit && how == "terminate") std::thread([] { throw std::bad_alloc(); }).join();
  ranks->barrier();  // the others wait here
  return ExitCode::ok;
}

}  // namespace
}  // namespace gaussdrift

int main(int argc, char** argv) {
  using namespace gaussdrift;
  testing::InitGoogleTest(&argc, argv);
  if (argc < 3) return 2;
  mpi::Exchange how;
  if (argc == 4) how = {.round = std::stoul(argv[2]), .told_by_all = std::stoi(argv[3])};
  const std::unique_ptr<base::Communicator> all = mpi::start(how);
  ranks = all.get();
  return argv[1] == std::string("laws") ? failures() : cli::end_of(*ranks, [&] { return end(argv[2]); });
}
