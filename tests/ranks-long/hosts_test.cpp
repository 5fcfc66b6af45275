// Runs that ranks on two hosts share: the same bits, and how they end when a rank or the wire between them dies.
#include <gtest/gtest.h>

#include <string>

#include "faults/whole_files.hpp"
#include "program/same_run.hpp"
#include "ranks-long/two_hosts.hpp"
#include "ranks/turning_cone.hpp"

namespace gaussdrift {
namespace {

class Hosts : public testing::Test {
 protected:
  void SetUp() override {
    NEEDS_MPIRUN();
    if (!hosts.why_not().empty()) GTEST_SKIP() << hosts.why_not();
  }

  void goes_on_here(const std::string& file) {
    EXPECT_EQ(unreadable_in(folder / "part"), "");
    const Outcome rest = on_ranks_of_mpi(2, "'" PROGRAM "' resume part --threads 1", folder);
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    const Outcome alone = gaussdrift_in(folder, "run " + file + " --out whole --threads 2");
    EXPECT_EQ(alone.exit_code, 0) << alone.err;
    expect_same(folder / "whole", folder / "part");
  }

  const TwoHosts hosts;
  const ScratchFolder folder;
};

TEST_F(Hosts, HaveTheBitsOfOne) {
  write_file(folder / "cone.toml", turning_cone("0.01"));
  const Outcome alone = gaussdrift_in(folder, "run cone.toml --out alone");
  EXPECT_EQ(alone.exit_code, 0) << alone.err;
  const Outcome shared = outcome_of(folder, hosts.on_both(folder, "'" PROGRAM "' run cone.toml --out shared"));
  EXPECT_EQ(shared.exit_code, 0) << shared.err;
  EXPECT_EQ(times_in(shared.err, "4 ranks on 2 hosts\n"), 1u) << shared.err;
  EXPECT_NE(shared.out.find("\nranks  4 on 2 hosts: "), std::string::npos) << shared.out;
  expect_same(folder / "alone", folder / "shared");
  EXPECT_EQ(left_in(folder), "");
}

// The other host's ranks do not see what happens here: only mpirun can end them.
TEST_F(Hosts, EndTogetherWhenARankOnTheOtherIsKilled) {
  write_file(folder / "long.toml", turning_cone("2e-5"));
  const std::string command = hosts.on_both(folder, with_one_rank(3, "", "run long.toml --out part --threads 1"));
  write_file(folder / "command.sh", command);
  const Outcome killed =
      when_there(folder, "part/density/density_0001.vti", "sh command.sh", "kill -9 $(cat rank_3.pid)");
  EXPECT_EQ(killed.exit_code, 128 + 9) << killed.err;
  EXPECT_EQ(left_in(folder), "");
  goes_on_here("long.toml");
}

// As docs/distributed.md says; with Open MPI's own numbers ranks beyond the cut are there for minutes.
TEST_F(Hosts, EndWhenTheWireIsCut) {
  const std::string output = "times = [0, 0.002, 100]\ncheckpoint = 0.1\n";
  write_file(folder / "long.toml", turning_cone("1e-5", output));
  write_file(folder / "command.sh",
             hosts.on_both(folder, "'" PROGRAM "' run long.toml --set time.end=100 --out part --threads 1",
                           "--mca oob_tcp_keepalive_time 5 --mca oob_tcp_keepalive_intvl 2 --mca "
                           "oob_tcp_keepalive_probes 3"));
  const Outcome cut = when_there(folder, "part/state/0/manifest.json", "sh command.sh", hosts.cut_the_wire());
  EXPECT_NE(cut.exit_code, 0);
  EXPECT_NE(cut.exit_code, 124) << "it would have gone on: " << cut.err;
  EXPECT_EQ(left_in(folder, 300), "");
  EXPECT_EQ(unreadable_in(folder / "part"), "");
  const Outcome rest = on_ranks_of_mpi(2, "'" PROGRAM "' resume part --stop-after 0.1", folder);
  EXPECT_EQ(rest.exit_code, 7) << rest.err;
  EXPECT_NE(rest.err.find("goes on at t = "), std::string::npos) << rest.err;
}

}  // namespace
}  // namespace gaussdrift
