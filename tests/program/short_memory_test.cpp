// Where memory or threads are short the program says so in a line, or goes on with less. It never crashes.
#include <gtest/gtest.h>

#include <algorithm>

#include "program/program.hpp"

namespace gaussdrift {
namespace {

#ifdef __SANITIZE_ADDRESS__  // it takes terabytes of address space
constexpr bool can_be_limited = false;
#else
constexpr bool can_be_limited = true;
#endif

const std::string with_pictures = case_text({.particles = "per_axis = 21",
                                             .time = "end = 0.1\nstep = 0.1",
                                             .evaluate = "per_axis = 11",
                                             .output = "frames = 2\nimages = [\"surface\"]"});

TEST(ShortMemory, ForPicturesIsToldInOneLine) {
#ifndef GAUSSDRIFT_PICTURES
  GTEST_SKIP() << "built without pictures";
#endif
  if (!can_be_limited) GTEST_SKIP() << "sanitized";
  const ScratchFolder folder;
  write_file(folder / "a.toml", with_pictures);
  for (const char* kilobytes : {"450000", "700000"}) {
    const Outcome run =
        gaussdrift_in(folder, "run a.toml --force", std::string("ulimit -c 0; ulimit -v ") + kilobytes + ";");
    EXPECT_EQ(run.exit_code, 3) << kilobytes << "\n" << run.err;
    EXPECT_NE(run.err.find("error: pictures need 720 MB of address space"), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
}

TEST(ShortMemory, ForThreadsIsNoFault) {
  if (!can_be_limited) GTEST_SKIP() << "sanitized";
  const ScratchFolder folder;
  write_file(folder / "a.toml", with_pictures);
  // The stack of a second thread has no room.
  const std::string limits = "ulimit -c 0; ulimit -s 4000000 && ulimit -v 900000;";
  const Outcome run = gaussdrift_in(
      folder, "run a.toml --threads 2 --set output.images=[] --set output.report=none --set particles.per_axis=201",
      limits);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err.find("libgomp"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace gaussdrift
