// A method of the Gauss transform that would take very long is refused before anything is summed.
#include <gtest/gtest.h>

#include <string>

#include "program/program.hpp"

namespace gaussdrift {
namespace {

/// Three quarters of a million particles and sixteen million points: 10^13 pairs, which take hours.
const std::string large = " --threads 2 --set particles.per_axis=4000 --set evaluate.per_axis=4000 ";

TEST(SlowMethod, IsRefusedByCheckWithTheWayOut) {
  const ScratchFolder folder;
  write_file(folder / "c.toml", small_case);
  const Outcome refused = gaussdrift_in(folder, "check c.toml --set evaluate.method=direct" + large);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("evaluate.method = \"direct\" would take about "), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find(" for each density on 2 threads, and only densities of up to 5 minutes are begun. Use "
                             "evaluate.method = \"auto\", which takes about "),
            std::string::npos)
      << refused.err;
  EXPECT_NE(refused.err.find("), or raise evaluate.most_seconds."), std::string::npos) << refused.err;

  const Outcome wanted =
      gaussdrift_in(folder, "check c.toml --set evaluate.method=direct --set evaluate.most_seconds=1e6" + large);
  EXPECT_EQ(wanted.exit_code, 0) << wanted.err;
  const Outcome automatic = gaussdrift_in(folder, "check c.toml" + large);
  EXPECT_EQ(automatic.exit_code, 0) << automatic.err;
}

/// Narrow blobs in space, for which `spread` gives way to all pairs.
const std::string narrow_blobs = case_text({.domain = cube,
                                            .velocity = velocity_of({"-y", "x", "0"}),
                                            .density = "expression = \"exp(-(x^2 + y^2 + z^2)/0.06)\"",
                                            .particles = "per_axis = 300\noverlap = 0.3",
                                            .time = "end = 1\nstep = 0.5",
                                            .evaluate = "per_axis = 400\ntolerance = 1e-12\nmethod = \"spread\"",
                                            .output = "times = [0]\nimages = []"});

TEST(SlowMethod, IsNotTriedByCheck) {
  const ScratchFolder folder;
  write_file(folder / "c.toml", narrow_blobs);
  const Outcome refused = gaussdrift_in(folder, "check c.toml --threads 2");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("\"spread\" would take about "), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find(" days for each density on 2 threads"), std::string::npos) << refused.err;
  const Outcome wanted = gaussdrift_in(folder, "check c.toml --set evaluate.most_seconds=1e7 --threads 2");
  EXPECT_EQ(wanted.exit_code, 0) << wanted.err;
  EXPECT_NE(wanted.out.find("summed by auto, because spread would take "), std::string::npos) << wanted.out;
}

TEST(SlowMethod, IsRefusedByRunBeforeAFileIsWritten) {
  const ScratchFolder folder;
  write_file(folder / "c.toml", small_case);
  const std::string run = "run c.toml --threads 2 --out out --set evaluate.method=hermite";
  const Outcome refused = gaussdrift_in(folder, run + " --set evaluate.most_seconds=1e-9");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("evaluate.method = \"hermite\" would take about "), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
  const Outcome wanted = gaussdrift_in(folder, run);
  EXPECT_EQ(wanted.exit_code, 0) << wanted.err;
}

TEST(SlowMethod, OfAutoIsRefusedWhereALimitIsGiven) {
  const ScratchFolder folder;
  write_file(folder / "c.toml", small_case);
  for (const std::string verb : {"check", "run"}) {
    const Outcome refused = gaussdrift_in(folder, verb + " c.toml --set evaluate.most_seconds=1e-9");
    EXPECT_EQ(refused.exit_code, 3) << verb;
    EXPECT_NE(refused.err.find("are begun. Lower evaluate.per_axis or particles.per_axis, or raise "
                               "evaluate.most_seconds."),
              std::string::npos)
        << refused.err;
  }
}

}  // namespace
}  // namespace gaussdrift
