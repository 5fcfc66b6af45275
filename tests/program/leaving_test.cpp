// Mass that leaves the domain, is used up or never was inside: what a user is told.
#include <gtest/gtest.h>

#include "parsed_json.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

nlohmann::json summary_of(const ScratchFolder& folder) {
  return parsed_json(read_file(folder / "output/blown/summary.json"));
}

/// A cone in a wind that blows it out of the domain by t = 0.7.
std::string blown(int dimension) {
  const bool space = dimension == 3;
  return case_text({.domain = space ? unit_cube : unit_square,
                    .velocity = space ? velocity_of({"1", "0", "0"}) : velocity_of({"1", "0"}),
                    .density = shape_of("wendland", space ? "0.5, 0.5, 0.5" : "0.5, 0.5", "0.2"),
                    .particles = "per_axis = 25",
                    .time = "end = 2\nstep = 0.1",
                    .evaluate = "per_axis = 15",
                    .output = "times = [0, 1, 2]\nimages = []\nvtk = []"});
}

TEST(Leaving, IsToldWithItsTimeWhereAllOfItHasLeft) {
  for (const int dimension : {2, 3}) {
    const ScratchFolder folder;
    write_file(folder / "blown.toml", blown(dimension));
    const Outcome run = gaussdrift_in(folder, "run blown.toml");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("warning: all of the mass has left the domain by t = 1"), std::string::npos) << run.err;
    EXPECT_NE(run.out.find("error  at t = 2 nothing is left to compare"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("nan"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("hint"), std::string::npos) << "no setting helps: " << run.out;
    const auto summary = summary_of(folder);
    EXPECT_EQ(summary["frames"][0]["outside"], 0);
    EXPECT_EQ(summary["frames"][2]["outside"], 1);
    EXPECT_TRUE(summary["frames"][0]["L1"].is_number());
    EXPECT_TRUE(summary["frames"][2]["L1"].is_null());
    EXPECT_NE(summary["frames"][2]["no_norms"].get<std::string>().find("left the domain"), std::string::npos);
    EXPECT_EQ(summary["worst"]["t"], 0);
    EXPECT_NE(summary["budget"]["measured"]["not_covered"].get<std::string>().find("left the domain"),
              std::string::npos);
    const std::string page = read_file(folder / "output/blown/report.html");
    EXPECT_NE(page.find("all of the mass has left the domain by t = 1"), std::string::npos);
    EXPECT_NE(page.find("At t = 2 nothing is left to compare"), std::string::npos);
    EXPECT_NE(page.find("<th>outside the domain"), std::string::npos);
    const std::string series = read_file(folder / "output/blown/series.csv");
    EXPECT_NE(series.find(",L1,L2,Linf,outside,"), std::string::npos) << series;
  }
}

TEST(Leaving, EndsTheSearchForSettingsAtOnceWithTheReason) {
  const ScratchFolder folder;
  write_file(folder / "blown.toml", blown(2));
  const Outcome run = gaussdrift_in(folder, "run blown.toml --accuracy 1e-3");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("at t = 2 nothing is left to compare (all of the mass has left the domain)"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(run.err.find("smoother"), std::string::npos) << run.err;
  const Outcome check = gaussdrift_in(folder, "check blown.toml");
  EXPECT_NE(check.out.find("errors     not predicted: at t = 2 nothing is left to compare"), std::string::npos)
      << check.out;
}

TEST(Leaving, OfAPartIsToldAsAPart) {
  const ScratchFolder folder;
  write_file(folder / "blown.toml", blown(2));
  const Outcome run = gaussdrift_in(folder, "run blown.toml --set time.end=0.55 --set output.times=[0,0.55]");
  EXPECT_NE(run.err.find("warning: at t = 0.55, "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("% of the mass is outside the domain"), std::string::npos) << run.err;
  const auto last = summary_of(folder)["frames"][1];
  EXPECT_GT(last["outside"], 0.5);  // the centre is a quarter of the radius beyond the edge
  EXPECT_LT(last["outside"], 0.9);
  EXPECT_TRUE(last["L1"].is_number());
  const Outcome check = gaussdrift_in(folder, "check blown.toml --set time.end=0.55 --set output.times=[0,0.55]");
  EXPECT_NE(check.out.find("of the mass is outside the domain at the last output"), std::string::npos) << check.out;
}

TEST(Leaving, FailsAnErrorCheckOfATimeWithNothingLeftByItsReason) {
  const ScratchFolder folder;
  write_file(folder / "blown.toml", blown(2) +
                                        "[[check]]\nwhat = \"L1\"\nmax = 0.5\nat = 2\n[[check]]\nwhat = \"mass\"\n"
                                        "min = 0.999\n");
  const Outcome run = gaussdrift_in(folder, "run blown.toml");
  EXPECT_EQ(run.exit_code, 5);
  EXPECT_NE(run.err.find("check failed: L1 at t = 2 must be at most 0.5 but is not known: nothing is left to compare"),
            std::string::npos)
      << run.err;
  EXPECT_NE(run.out.find("check  passed: mass = 1 at"), std::string::npos) << run.out;
}

TEST(Weights, ThatAllFallToNothingAreTold) {
  const ScratchFolder folder;
  write_file(folder / "blown.toml", blown(2) + "[effects.reaction]\nrate = \"1000\"\n");
  const Outcome run = gaussdrift_in(folder, "run blown.toml --set 'velocity.u=[\"0\",\"0\"]'");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("warning: every weight has fallen to 0 by t = 1"), std::string::npos) << run.err;
  EXPECT_NE(run.out.find("nothing is left to compare (every weight has fallen to 0)"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("hint"), std::string::npos) << run.out;
  const Outcome chosen = gaussdrift_in(folder, "run blown.toml --set 'velocity.u=[\"0\",\"0\"]' --accuracy 1e-2");
  EXPECT_EQ(chosen.exit_code, 3);
  EXPECT_NE(chosen.err.find("every weight has fallen to 0"), std::string::npos) << chosen.err;
}

TEST(Density, ThatStartsOutsideTheDomainIsTold) {
  const ScratchFolder folder;
  write_file(folder / "blown.toml", blown(2));
  const std::string sets =
      " --set density.shape=gaussian --set 'density.center=[-0.2,0.5]' --set time.end=0.5 --set output.times=[0,0.5]";
  const Outcome run = gaussdrift_in(folder, "run blown.toml" + sets);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("of the mass of the initial density lies outside the domain"), std::string::npos) << run.err;
  EXPECT_GT(summary_of(folder)["particles"]["mass_outside_at_start"], 0.8);  // erfc(-1)/2 = 0.92 of it
  EXPECT_EQ(run.out.find("hint"), std::string::npos) << "no setting helps: " << run.out;
  const Outcome check = gaussdrift_in(folder, "check blown.toml" + sets);
  EXPECT_NE(check.out.find("of the mass of the initial density lies outside the domain"), std::string::npos)
      << check.out;
  const Outcome gone = gaussdrift_in(folder, "run blown.toml --set 'density.center=[-0.5,0.5]'");
  EXPECT_EQ(gone.exit_code, 3);
  EXPECT_NE(gone.err.find("the initial density is 0 on every point of the particle lattice"), std::string::npos)
      << gone.err;
}

TEST(Threshold, IsToldWhereverParticlesAreCounted) {
  const ScratchFolder folder;
  write_file(folder / "blown.toml", blown(2));
  const std::string sets =
      " --set density.shape=gaussian --set density.radius=0.05 --set time.end=0.1 --set output.times=[0.1]";
  const Outcome run = gaussdrift_in(folder, "run blown.toml" + sets);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto summary = summary_of(folder);
  const auto& particles = summary["particles"];
  EXPECT_EQ(particles["threshold"], 1e-12);
  EXPECT_EQ(particles["carried"].get<int>() + particles["left_out"].get<int>(), particles["lattice_points"]);
  EXPECT_GT(particles["left_out"], 400);  // of 625: a Gaussian is 1e-12 at 5.26 radii
  EXPECT_LT(particles["mass_left_out"], 1e-10);
  EXPECT_GT(particles["mass_left_out"], 0);
  EXPECT_GT(summary["budget"]["measured"]["left_out"], 0);
  EXPECT_LT(summary["budget"]["measured"]["left_out"], 1e-9);
  EXPECT_NE(run.out.find("lattice points with less than 1e-12 of the largest weight"), std::string::npos) << run.out;
  EXPECT_NE(read_file(folder / "output/blown/report.html").find("(particles.threshold)"), std::string::npos);
  EXPECT_NE(read_file(folder / "output/blown/run.toml").find("threshold = 1e-12"), std::string::npos);
  const Outcome check = gaussdrift_in(folder, "check blown.toml" + sets);
  EXPECT_NE(check.out.find("are left out"), std::string::npos) << check.out;
  EXPECT_NE(gaussdrift_in(folder, "explain particles.threshold").out.find("1e-12"), std::string::npos);
  const Outcome all = gaussdrift_in(folder, "run blown.toml --force --set particles.threshold=0" + sets);
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(summary_of(folder)["particles"]["left_out"], 0);
  EXPECT_EQ(all.out.find("left out"), std::string::npos) << all.out;
}

}  // namespace
}  // namespace gaussdrift
