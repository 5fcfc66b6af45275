// A rank cannot write its pieces of an output or of a checkpoint, or is killed while it does.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "faults/whole_files.hpp"
#include "program/same_run.hpp"
#include "ranks/disturbed_ranks.hpp"
#include "ranks/turning_cone.hpp"

namespace gaussdrift {
namespace {

const std::string in_pieces =
    "run cone.toml --out part --threads 1 --set output.piece_particles=100 --set evaluate.piece_points=4000";

/// Folders of a run that have pieces.
const std::vector<std::string> kinds{"density", "particles", "state"};

class Pieces : public testing::Test {
 protected:
  /// Rank 1 of three writes nothing but pieces. A checkpoint comes with every batch of steps.
  void SetUp() override {
    NEEDS_MPIRUN();
    write_file(folder / "cone.toml",
               turning_cone("0.02", "frames = 4\ncheckpoint = 1e-9\nvtk = [\"density\", \"particles\"]\n"));
    for (const std::string& kind : kinds) {
      fs::remove_all(folder / "whole");
      const Outcome whole = call(kind, "");
      ASSERT_EQ(whole.exit_code, 0) << whole.err;
      fs::rename(folder / "part", folder / "whole");
      std::istringstream report(read_file(folder / "report.txt"));
      std::string word;
      report >> word >> calls[kind];
      ASSERT_EQ(word, "calls");
      ASSERT_GT(calls[kind], 5) << kind;
    }
  }

  /// The run, with calls of rank 1 on files of that folder counted.
  Outcome call(const std::string& kind, const std::string& fault) const {
    fs::remove(folder / "report.txt");
    return on_ranks_of_mpi(3,
                           with_one_rank(1,
                                         "export OMP_WAIT_POLICY=passive LD_PRELOAD=" FAULTS_LIBRARY " FAULTS_FOLDER=" +
                                             (fs::canonical(folder.path()) / "part" / kind).string() +
                                             " FAULTS_REPORT=report.txt " + fault,
                                         in_pieces),
                           folder);
  }

  /// Faults at calls of each kind, so many thirds into the run. What was written is whole and the run goes on, with the same
  /// bits.
  void suffer(const std::string& error, int exit_code, std::size_t messages, const std::vector<int>& thirds) {
    for (const std::string& kind : kinds)
      for (const int third : thirds) {
        fs::remove_all(folder / "part");
        const Outcome outcome =
            call(kind, "FAULTS_AT=" + std::to_string(calls[kind] * third / 3) + " FAULTS_ERROR=" + error);
        const std::string report = read_file(folder / "report.txt");
        SCOPED_TRACE(report);
        ASSERT_TRUE(report.starts_with("struck")) << outcome.err;
        const bool hidden = report.find("unlink") != std::string::npos;  // of a hidden file that stays
        EXPECT_TRUE(outcome.exit_code == exit_code || (hidden && outcome.exit_code == 0)) << outcome.err;
        if (outcome.exit_code == exit_code) {
          EXPECT_EQ(times_in(outcome.err, "error: "), messages) << outcome.err;
        }
        EXPECT_EQ(left_in(folder), "");
        EXPECT_EQ(unreadable_in(folder / "part"), "");
        if (outcome.exit_code == 0) continue;
        const Outcome rest = on_ranks_of_mpi(2, "'" PROGRAM "' resume part --threads 1", folder);
        EXPECT_EQ(rest.exit_code, 0) << rest.err;
        EXPECT_EQ(times_in(rest.err, "is not used"), 0u) << rest.err;
        expect_same(folder / "whole", folder / "part");
      }
  }

  const ScratchFolder folder;
  std::map<std::string, long> calls;  // of rank 1, by kind
};

TEST_F(Pieces, OnAFullDiskOfOneRank) { suffer("28 FAULTS_LASTING=1", 6, 1, {1, 2}); }

// mpirun takes seconds to end the others.
TEST_F(Pieces, OfARankThatIsKilled) { suffer("kill", 128 + 9, 0, {2}); }

}  // namespace
}  // namespace gaussdrift
