#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "parsed_json.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

// One row of a CSV file as numbers; row 0 is the first below the header.
std::vector<double> csv_row(const std::string& text, int row) {
  std::istringstream lines(text);
  std::string line;
  for (int i = -1; i <= row; ++i) std::getline(lines, line);
  std::vector<double> numbers;
  std::istringstream cells(line);
  for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::stod(cell));
  return numbers;
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

bool any_part_files(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".part") return true;
  return false;
}

TEST(Run, LeavesTheFolderThatTheDocumentationPromises) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome run = gaussdrift_in(folder, "run small.toml");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const fs::path output = folder / "output/small";
  for (const char* name :
       {"run.toml", "case.toml", "series.csv", "summary.json", "view.py", "density.pvd", "particles.pvd"})
    EXPECT_TRUE(fs::exists(output / name)) << name;
  for (const char* index : {"0000", "0001", "0002"}) {
    EXPECT_TRUE(fs::exists(output / "density" / ("density_" + std::string(index) + ".vti")));
    EXPECT_TRUE(fs::exists(output / "particles" / ("particles_" + std::string(index) + ".vtp")));
  }
  EXPECT_FALSE(any_part_files(output));
  EXPECT_EQ(read_file(output / "case.toml"), small_case);
  EXPECT_NE(run.out.find("density.pvd"), std::string::npos) << run.out;
}

TEST(Run, WritesNothingThatTheCaseDoesNotName) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  ASSERT_EQ(gaussdrift_in(folder, "run small.toml --set output.vtk=[]").exit_code, 0);
  const fs::path output = folder / "output/small";
  EXPECT_FALSE(fs::exists(output / "density.pvd"));
  EXPECT_FALSE(fs::exists(output / "particles.pvd"));
  EXPECT_FALSE(fs::exists(output / "images"));
  const auto summary = parsed_json(read_file(output / "summary.json"));
  ASSERT_EQ(summary["effects"].size(), 1u);
  EXPECT_EQ(summary["effects"][0]["name"], "transport");
  for (const auto& [stage, seconds] : summary["seconds"].items())
    EXPECT_EQ(stage.find("write density"), std::string::npos) << stage;
}

TEST(Run, KeepsHeightMassAndCentreOverATurn) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  ASSERT_EQ(gaussdrift_in(folder, "run small.toml --set time.step=0.001 --set evaluate.tolerance=1e-11").exit_code, 0);
  const std::string series = read_file(folder / "output/small/series.csv");
  const auto start = csv_row(series, 0), end = csv_row(series, 2);
  EXPECT_EQ(start[1], end[1]);             // mass: the weights do not change
  EXPECT_NEAR(start[3], end[3], 1e-11);    // height: to the transform's tolerance
  EXPECT_NEAR(start[4], end[4], 6.7e-16);  // centroid: back where it was, but for RK4's lag at 0.001,
  EXPECT_NEAR(start[5], end[5], 7.8e-14);  // 5.2e-14 a turn at the radius 1/2
  EXPECT_NEAR(end[4], 0.5, 1.8e-6);        // and at the cone's centre, up to the lattice sum: 6e-7
  EXPECT_LE(end[6], 1e-11);                // transform_error, measured against the direct sum
}

TEST(Run, OfItsOwnResolvedCaseGivesTheSameNumbers) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  ASSERT_EQ(gaussdrift_in(folder, "run small.toml --set particles.overlap=1.5 --out first").exit_code, 0);
  const Outcome again = gaussdrift_in(folder, "run first/run.toml --out second");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  for (const char* file : {"density/density_0002.vti", "particles/particles_0002.vtp"})
    EXPECT_EQ(read_file(folder / "first" / file), read_file(folder / "second" / file)) << file;
}

TEST(Run, GivesTheSameBitsForAnyThreads) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  for (const char* threads : {"1", "2", "4"})
    ASSERT_EQ(
        gaussdrift_in(folder, std::string("run small.toml --threads ") + threads + " --out run" + threads).exit_code,
        0);
  for (const char* threads : {"2", "4"})
    for (const char* file : {"density/density_0002.vti", "particles/particles_0002.vtp"})
      EXPECT_EQ(read_file(folder / "run1" / file), read_file(folder / ("run" + std::string(threads)) / file)) << file;
}

TEST(Run, PrintsNothingButJsonOnStandardOutputWhenAsked) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome run = gaussdrift_in(folder, "run small.toml --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto summary = parsed_json(run.out);
  EXPECT_EQ(summary["frames"].size(), 3u);
  EXPECT_EQ(summary["time"]["steps"], 126);  // ceil(pi / 0.05) = 63 steps to each of two landings
}

TEST(Run, DrawsThePicturesThatAreNamed) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome run = gaussdrift_in(
      folder, "run small.toml --set 'output.images=[\"surface\",\"contour\",\"heatmap\"]'", "unset DISPLAY;");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* style : {"surface", "contour", "heatmap"})
    for (const char* index : {"0000", "0001", "0002"}) {
      const std::string png = read_file(folder / ("output/small/images/" + std::string(style) + "_" + index + ".png"));
      EXPECT_EQ(png.substr(1, 3), "PNG") << style << index;
    }
}

TEST(Run, RefusesAFolderThatHoldsAnEarlierRun) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  ASSERT_EQ(gaussdrift_in(folder, "run small.toml").exit_code, 0);
  const std::string before = read_file(folder / "output/small/series.csv");
  write_file(folder / "output/small/notes.txt", "mine");
  const Outcome refused = gaussdrift_in(folder, "run small.toml --set time.step=0.1");
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_NE(
      refused.err.find("output/small is not empty; --force replaces the earlier run in it, --out DIR writes elsewhere"),
      std::string::npos)
      << refused.err;
  EXPECT_EQ(read_file(folder / "output/small/series.csv"), before);

  const Outcome forced = gaussdrift_in(folder, "run small.toml --force --set 'output.times=[0]'");
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_FALSE(fs::exists(folder / "output/small/density/density_0001.vti"));  // of the earlier run
  EXPECT_EQ(read_file(folder / "output/small/notes.txt"), "mine");             // not of a run, so not touched
}

TEST(Run, KeepsTheEarlierRunWhereTheNewOneCannotBegin) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  ASSERT_EQ(gaussdrift_in(folder, "run small.toml").exit_code, 0);
  const std::string before = read_file(folder / "output/small/series.csv");
  for (const auto& [wrong, code] :
       {std::pair{"--set 'density.center=[5,5]'", 3}, std::pair{"--set 'velocity.u=[\"log(-2-x)\",\"0\"]'", 4},
        std::pair{"--set time.step=0", 3}}) {
    EXPECT_EQ(gaussdrift_in(folder, std::string("run small.toml --force ") + wrong).exit_code, code) << wrong;
    EXPECT_EQ(read_file(folder / "output/small/series.csv"), before) << wrong;
    EXPECT_TRUE(fs::exists(folder / "output/small/density/density_0002.vti")) << wrong;
  }
}

TEST(Run, DoesNotForceItsWayIntoAFolderOfTheUser) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  fs::create_directories(folder / "mine/images");
  write_file(folder / "mine/images/photo.png", "a photo");
  const Outcome refused = gaussdrift_in(folder, "run small.toml --out mine --force");
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_NE(refused.err.find("mine holds no earlier run"), std::string::npos) << refused.err;
  EXPECT_EQ(read_file(folder / "mine/images/photo.png"), "a photo");

  // Beside a run it is not touched either.
  ASSERT_EQ(gaussdrift_in(folder, "run small.toml --out run").exit_code, 0);
  fs::create_directories(folder / "run/images");
  write_file(folder / "run/images/photo.png", "a photo");
  ASSERT_EQ(gaussdrift_in(folder, "run small.toml --out run --force").exit_code, 0);
  EXPECT_EQ(read_file(folder / "run/images/photo.png"), "a photo");
}

TEST(Run, SaysWhatCanBePromisedWhereTheDensityLeavesTheGrid) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const std::string leaving =
      "run small.toml --set 'velocity.u=[\"1\",\"0\"]' --set time.end=1 --set time.step=0.1 --out ";
  // At t = 0.5 half of the cone is outside, at 0.7 a thousandth of its height is left: the tolerance follows the grid's
  // maximum.
  ASSERT_EQ(gaussdrift_in(folder, leaving + "some --set 'output.times=[0, 0.5, 0.7]'").exit_code, 0);
  for (int row = 0; row < 3; ++row) EXPECT_LE(csv_row(read_file(folder / "some/series.csv"), row)[6], 1e-8) << row;
  // At t = 1 there is 1e-11 of it, less than double precision can promise relative to what lies near: that is said.
  const Outcome gone = gaussdrift_in(folder, leaving + "gone --set 'output.times=[0, 1]'");
  ASSERT_EQ(gone.exit_code, 0);
  EXPECT_NE(gone.err.find("cannot be promised"), std::string::npos) << gone.err;
}

TEST(Run, SaysWhatTookLongestFirstEffectsAmongIt) {
  const ScratchFolder folder;
  // 1100 charges that move each other: a large part of the seconds.
  write_file(folder / "small.toml", small_case + "report = \"none\"\n[effects.charge]\nmobility = 0.01\n");
  const Outcome run =
      gaussdrift_in(folder,
                    "run small.toml --set particles.per_axis=150 --set time.end=0.5 --set time.step=0.05 "
                    "--set 'output.times=[0, 0.5]' --set reference.kind=none");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // "(charge 0.06, files 0.06, other 0.00)": which comes first is a matter of the machine, that they descend is not.
  // What is left for "other" stands at the end, however much it is.
  const std::size_t begin = run.out.find(" threads (") + 10, end = run.out.find(')', begin);
  ASSERT_NE(end, std::string::npos) << run.out;
  std::istringstream stages(run.out.substr(begin, end - begin));
  std::vector<std::string> names;
  double last = std::numeric_limits<double>::infinity();
  for (std::string stage; std::getline(stages >> std::ws, stage, ',');) {
    const std::size_t blank = stage.rfind(' ');
    names.push_back(stage.substr(0, blank));
    const double seconds = std::stod(stage.substr(blank + 1));
    if (names.back() == "other") continue;
    EXPECT_LE(seconds, last) << run.out;
    last = seconds;
  }
  EXPECT_NE(std::find(names.begin(), names.end(), "charge"), names.end()) << run.out;
  const auto summary = parsed_json(read_file(folder / "output/small/summary.json"));
  EXPECT_GT(summary.at("seconds").at("effect charge"), 0.0);
}

TEST(Run, RefusesAFolderThatCannotBe) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome file_in_the_way = gaussdrift_in(folder, "run small.toml --out small.toml");
  EXPECT_EQ(file_in_the_way.exit_code, 6);
  EXPECT_NE(file_in_the_way.err.find("cannot use small.toml as output folder: it is a file"), std::string::npos)
      << file_in_the_way.err;
  const Outcome below_a_file = gaussdrift_in(folder, "run small.toml --out small.toml/below");
  EXPECT_EQ(below_a_file.exit_code, 6);
  EXPECT_NE(below_a_file.err.find("choose another folder with --out"), std::string::npos) << below_a_file.err;
}

TEST(Run, StopsAtAFullDiskAndKeepsWhatWasWritten) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  // No file may grow beyond 32 blocks of 512 bytes: settings and view.py fit, a frame of 40 x 40 doubles does not.
  const Outcome run = gaussdrift_in(folder, "run small.toml", "ulimit -f 32;");
  EXPECT_EQ(run.exit_code, 6) << run.err;
  EXPECT_NE(run.err.find("density_0000.vti"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("File too large"), std::string::npos) << run.err;  // the reason as the system gives it
  EXPECT_FALSE(any_part_files(folder / "output"));
  EXPECT_FALSE(fs::exists(folder / "output/small/density/density_0000.vti"));
  EXPECT_TRUE(fs::exists(folder / "output/small/run.toml"));
}

TEST(Run, ReportsAFieldThatIsNotFiniteAndKeepsTheFramesBefore) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  // Finite up to t = 4, between the second frame and the third.
  const Outcome run = gaussdrift_in(folder, "run small.toml --set 'velocity.u=[\"-y + 0*sqrt(4 - t)\", \"x\"]'");
  EXPECT_EQ(run.exit_code, 4);
  for (const char* part :
       {"the velocity is (", "nan", "in step 81", "at t = 4", "for particle ", "guard the expression"})
    EXPECT_NE(run.err.find(part), std::string::npos) << part << " in: " << run.err;
  const std::string collection = read_file(folder / "output/small/density.pvd");
  EXPECT_EQ(count(collection, "<DataSet"), 2) << collection;
  EXPECT_NE(collection.find("</VTKFile>"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "output/small/density/density_0001.vti"));
  EXPECT_EQ(csv_row(read_file(folder / "output/small/series.csv"), 1).size(), 13u);
}

TEST(Run, WritesNoVelocityThatIsNotFinite) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  // No step is taken, so only the frame itself looks at the field.
  const Outcome run = gaussdrift_in(
      folder,
      "run small.toml --set time.end=0 --set 'output.times=[0]' --set 'velocity.u=[\"x < 0.5 ? 0/0 : 0\", \"1\"]'");
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find("the velocity is (nan, 1) in step 0 at t = 0"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(folder / "output"));
}

TEST(Run, StopsWhereParticlesLeaveForInfinity) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const std::string blow_up =
      "run small.toml --set 'density.center=[0,0]' --set 'velocity.u=[\"x\",\"y\"]' --set output.frames=2 --set "
      "time.end=";
  const Outcome far = gaussdrift_in(folder, blow_up + "711 --out far");  // coordinates near the largest double
  EXPECT_EQ(far.exit_code, 4);
  const Outcome beyond = gaussdrift_in(folder, blow_up + "800 --out beyond");
  EXPECT_EQ(beyond.exit_code, 4);
  EXPECT_NE(beyond.err.find("left for infinity"), std::string::npos) << beyond.err;
}

TEST(Run, RefusesWhatDoesNotFitInMemory) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome refused = gaussdrift_in(
      folder, "run small.toml --memory 1GB --set evaluate.per_axis=46000 --set evaluate.piece_points=134217728");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find(" GB for 2.12e+09 grid points, "), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("lower evaluate.per_axis"), std::string::npos) << refused.err;
}

// GCC's run-time library shows the settings that it has found: first as it was called, then as it calls itself.
TEST(Run, ThreadsThatWaitSleepUnlessTheUserHasSaidHowTheyWait) {
  const ScratchFolder folder;
  const std::string sleep = "GOMP_SPINCOUNT = '0'";
  const Outcome usual = gaussdrift_in(folder, "--version", "unset OMP_WAIT_POLICY; OMP_DISPLAY_ENV=verbose");
  if (usual.err.find("GOMP_SPINCOUNT") == std::string::npos) GTEST_SKIP() << "threads of another run-time library";
  EXPECT_NE(usual.err.find(sleep), std::string::npos) << usual.err;
  const Outcome told = gaussdrift_in(folder, "--version", "OMP_WAIT_POLICY=active OMP_DISPLAY_ENV=verbose");
  EXPECT_EQ(told.err.find(sleep), std::string::npos) << told.err;
}

TEST(Run, TakesACaseWhoseNameIsNotUtf8) {
  const ScratchFolder folder;
  write_file(folder /
                 "b\xff"
                 "d.toml",
             small_case);
  const Outcome run = gaussdrift_in(folder,
                                    "run b\xff"
                                    "d.toml");
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(Run, OfItsOwnResolvedCaseWarnsOfNothing) {
  const ScratchFolder folder;
  write_file(folder / "named.toml",
             case_text({.params = "R = 0.25", .density = shape_of("wendland", "0.5, 0", "\"R\"")}));
  ASSERT_EQ(gaussdrift_in(folder, "run named.toml --out first").exit_code, 0);
  EXPECT_EQ(gaussdrift_in(folder, "check first/run.toml").err, "");
}

TEST(Run, ReportsADensityThatIsNotFinite) {
  const ScratchFolder folder;
  write_file(folder / "pole.toml", case_text({.density = "expression = \"1/x\""}));
  const Outcome run = gaussdrift_in(folder, "run pole.toml");
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find("the initial density is inf at (0"), std::string::npos) << run.err;
}

TEST(Run, SaysThatNothingCarriesWeight) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome run = gaussdrift_in(folder, "run small.toml --set 'density.center=[5, 5]'");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("0 on every point of the particle lattice"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace gaussdrift
