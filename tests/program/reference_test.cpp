// What a run says about its error, and what follows from it.
#include <gtest/gtest.h>

#include <cmath>

#include "parsed_json.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

nlohmann::json summary_of(const ScratchFolder& folder, const std::string& run) {
  return parsed_json(read_file(folder / ("output/" + run + "/summary.json")));
}

TEST(Reference, MeasuresTheErrorOfARotatingCone) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome run = gaussdrift_in(folder, "run small.toml");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto summary = summary_of(folder, "small");
  EXPECT_EQ(summary["reference"]["kind"], "characteristics");
  EXPECT_EQ(summary["reference"]["untraced"], 0);
  EXPECT_TRUE(summary["seconds"].contains("reference"));
  ASSERT_EQ(summary["frames"].size(), 3u);
  for (const auto& frame : summary["frames"]) {
    // The cone smoothed by a Gaussian of eps/R = 0.2712, integrated apart on the points of the grid. The lattice of
    // particles differs from that by up to 4e-5.
    EXPECT_NEAR(frame["L1"].get<double>(), 0.29949, 1e-4);
    EXPECT_NEAR(frame["L2"].get<double>(), 0.25484, 1e-4);
    EXPECT_NEAR(frame["Linf"].get<double>(), 0.31416, 1e-4);
  }
  EXPECT_NEAR(summary["frames"][2]["L2"].get<double>(), summary["frames"][0]["L2"].get<double>(),
              3.3e-8);  // steps of 0.05: phase lag 3e-7 a turn, radius loss 1e-8; measured 1.1e-8
  EXPECT_NE(read_file(folder / "output/small/series.csv").find(",transform_error,L1,L2,Linf,"), std::string::npos);
  EXPECT_NE(read_file(folder / "output/small/density/density_0002.vti").find("rho_exact"), std::string::npos);
}

TEST(Reference, IsTheSameByAFormula) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  write_file(folder / "exact.toml", small_case + R"toml([reference]
kind = "exact"
rho = "max(0, 1 - hypot(x - cos(t)/2, y - sin(t)/2)/0.25)^4*(4*hypot(x - cos(t)/2, y - sin(t)/2)/0.25 + 1)"
)toml");
  ASSERT_EQ(gaussdrift_in(folder, "run small.toml").exit_code, 0);
  const Outcome run = gaussdrift_in(folder, "run exact.toml");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto traced = summary_of(folder, "small")["frames"], exact = summary_of(folder, "exact")["frames"];
  for (std::size_t k = 0; k < 3; ++k)
    for (const char* norm : {"L1", "L2", "Linf"})
      EXPECT_NEAR(traced[k][norm].get<double>(), exact[k][norm].get<double>(), 9e-12)
          << norm;  // 1e-12 a step; measured 3e-12
}

TEST(Reference, CostsNothingWhenItIsNotWanted) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome run = gaussdrift_in(folder, "run small.toml --set reference.kind=none");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto summary = summary_of(folder, "small");
  EXPECT_EQ(summary["reference"]["kind"], "none");
  EXPECT_FALSE(summary["seconds"].contains("reference"));
  EXPECT_FALSE(summary["frames"][0].contains("L1"));
  EXPECT_EQ(read_file(folder / "output/small/series.csv").find("L1"), std::string::npos);
  EXPECT_EQ(read_file(folder / "output/small/density/density_0000.vti").find("rho_exact"), std::string::npos);
}

TEST(Reference, SaysWhereTheExactDensityIsNotKnown) {
  const ScratchFolder folder;
  // Not a number left of x = -0.9, where no particle comes.
  const std::string cliff = case_text({.velocity = velocity_of({"0", "sqrt(x + 0.9)"}),
                                       .density = shape_of("wendland", "0.5, 0", "0.25"),
                                       .particles = "per_axis = 60",
                                       .evaluate = "per_axis = 40",
                                       .output = output_at("0.1")});
  write_file(folder / "cliff.toml", cliff + "[[check]]\nwhat = \"Linf\"\nmax = 1e9\n");
  const Outcome run = gaussdrift_in(folder, "run cliff.toml");
  EXPECT_EQ(run.exit_code, 5) << "a norm that leaves points out keeps no bound";
  EXPECT_NE(run.err.find("warning: the exact density is not known at "), std::string::npos) << run.err;
  EXPECT_EQ(summary_of(folder, "cliff")["reference"]["untraced"], 2 * 40) << "two of 40 columns";
}

TEST(Check, DecidesTheExitCodeAndIsToldBothWays) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case +
                                        "[[check]]\nwhat = \"Linf\"\nmax = 0.5\n"
                                        "[[check]]\nwhat = \"mass\"\nmin = \"1 - 1e-14\"\nmax = \"1 + 1e-14\"\n");
  const Outcome kept = gaussdrift_in(folder, "run small.toml");
  EXPECT_EQ(kept.exit_code, 0) << kept.err;
  EXPECT_NE(kept.out.find("check  passed: Linf = "), std::string::npos) << kept.out;
  EXPECT_NE(kept.out.find("check  passed: mass = 1 "), std::string::npos) << kept.out;
  const Outcome broken = gaussdrift_in(folder, "run small.toml --force --set particles.overlap=4");
  EXPECT_EQ(broken.exit_code, 5);
  EXPECT_NE(broken.err.find("check failed: Linf = "), std::string::npos) << broken.err;
  EXPECT_NE(broken.err.find("must be at most 0.5"), std::string::npos) << broken.err;
  const auto checks = summary_of(folder, "small")["checks"];
  ASSERT_EQ(checks.size(), 2u);
  EXPECT_EQ(checks[0]["passed"], false);
  EXPECT_EQ(checks[1]["passed"], true);
  EXPECT_TRUE(fs::exists(folder / "output/small/density.pvd")) << "the results are there to be looked at";
}

const std::string ball_case = case_text({.domain = "min = [-1, -1, -0.5]\nmax = [1, 1, 0.5]",
                                         .velocity = velocity_of({"-y", "x", "0"}),
                                         .density = shape_of("wendland", "0.4, 0, 0.1", "0.4"),
                                         .particles = "per_axis = 41",
                                         .time = "end = \"2*pi\"\nstep = 0.05",
                                         .evaluate = "per_axis = 31",
                                         .output = R"(times = [0, "pi/2", "2*pi"]
images = [])"});

TEST(SceneInSpace, LeavesFilesAndItsError) {
  const ScratchFolder folder;
  write_file(folder / "ball.toml", ball_case);
  const Outcome run = gaussdrift_in(folder, "run ball.toml");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const fs::path output = folder / "output/ball";
  for (const char* index : {"0000", "0001", "0002"}) {
    EXPECT_TRUE(fs::exists(output / "density" / ("density_" + std::string(index) + ".vti")));
    EXPECT_TRUE(fs::exists(output / "particles" / ("particles_" + std::string(index) + ".vtp")));
  }
  const auto frames = summary_of(folder, "ball")["frames"];
  for (const auto& frame : frames) {
    EXPECT_EQ(frame["mass"], frames[0]["mass"]);
    // 2 R^3 pi / 21 [Wendland], the lattice sum of a function with two derivatives at 8 points a radius
    EXPECT_NEAR(frame["mass"].get<double>(), 2 * std::acos(-1.0) * 0.064 / 21, 5e-7);
    EXPECT_NEAR(frame["centroid"][2].get<double>(), 0.1, 8e-17);  // six roundings
    EXPECT_LT(frame["Linf"].get<double>(), 0.5) << "smoothing: eps/R = 0.25";
  }
  EXPECT_NEAR(frames[2]["Linf"].get<double>(), frames[0]["Linf"].get<double>(), 3.3e-8);  // RK4 at 0.05, as above
  EXPECT_NEAR(frames[1]["centroid"][1].get<double>(), 0.4, 4e-9);                         // a quarter turn
}

TEST(SceneInSpace, LeavesThePicturesThatAreNamed) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "ball.toml", ball_case);
  const Outcome run = gaussdrift_in(folder,
                                    "run ball.toml --set 'output.images=[\"slices\", \"projection\", \"isosurface\", "
                                    "\"error\"]' --set 'output.times=[\"pi/2\"]'",
                                    "unset DISPLAY;");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* style : {"slices", "projection", "isosurface", "error"})
    EXPECT_TRUE(fs::exists(folder / ("output/ball/images/" + std::string(style) + "_0000.png"))) << style;
}

TEST(SceneInSpace, GivesTheSameBitsForAnyThreads) {
  const ScratchFolder folder;
  write_file(folder / "ball.toml", ball_case);
  for (const char* threads : {"1", "2", "4"})
    ASSERT_EQ(gaussdrift_in(folder, std::string("run ball.toml --set time.end=1 "
                                                "--set output.times=[1] --threads ") +
                                        threads + " --out run" + threads)
                  .exit_code,
              0);
  for (const char* threads : {"2", "4"})
    for (const char* file : {"density/density_0000.vti", "particles/particles_0000.vtp"})
      EXPECT_EQ(read_file(folder / "run1" / file), read_file(folder / ("run" + std::string(threads)) / file)) << file;
}

}  // namespace
}  // namespace gaussdrift
