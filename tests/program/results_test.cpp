// What runs leave, looked at again: the page, pictures, differences; and the self-test.
#include <gtest/gtest.h>

#include "parsed_json.hpp"
#include "program.hpp"

namespace gaussdrift {
namespace {

const std::string scene = case_text({.velocity = "field = \"rotation\"",
                                     .density = shape_of("wendland", "0.5, 0", "0.25"),
                                     .particles = "per_axis = 60",
                                     .time = "end = 1\nstep = 0.1",
                                     .evaluate = "per_axis = 41",
                                     .output = R"(times = [0, 1]
images = ["heatmap"])"}) +
                          R"([case]
title = "Cone <with> \"marks\" & more"
)";

TEST(Report, IsLeftByARunAndMadeAgainFromItsFiles) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml").exit_code, 0);
  const fs::path run = folder / "output/a";
  const std::string page = read_file(run / "report.html");
  for (const char* part :
       {"Cone &lt;with&gt; &quot;marks&quot; &amp; more", "the largest error is", "<svg", "smoothing", "Conservation",
        "data:image/png;base64,", "per_axis = 60", "gaussdrift run run.toml"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("http:"), std::string::npos) << "nothing is fetched";
  EXPECT_EQ(page.find("https:"), std::string::npos) << "nothing is fetched";
  EXPECT_TRUE(fs::exists(run / "summary.png"));
  EXPECT_TRUE(fs::exists(run / "log.txt"));
  const auto report = parsed_json(read_file(run / "report.json"));
  EXPECT_EQ(report["provenance"]["case"].get<std::string>().rfind("fnv1a64:", 0), 0u);
  EXPECT_TRUE(report["budget"]["measured"].contains("smoothing"));
  fs::remove(run / "report.html");
  EXPECT_EQ(gaussdrift_in(folder, "report output/a").exit_code, 0);
  EXPECT_EQ(read_file(run / "report.html"), page);
}

TEST(Report, HasTheWarningsOfTheRun) {
  const ScratchFolder folder;
  std::string sheared = scene;
  sheared.replace(sheared.find("field = \"rotation\""), 18, "u = [\"9*y\", \"0\"]");
  write_file(folder / "b.toml", sheared);
  ASSERT_EQ(gaussdrift_in(folder, "run b.toml").exit_code, 0);
  for (const char* file : {"output/b/report.html", "output/b/log.txt", "output/b/summary.json"})
    EXPECT_NE(read_file(folder / file).find("no longer overlap there enough"), std::string::npos) << file;
}

TEST(Report, IsNotWrittenWhereTheCaseDoesNotWantIt) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --set output.report=none").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "output/a/report.html"));
  EXPECT_FALSE(fs::exists(folder / "output/a/summary.png"));
}

TEST(Report, SaysWhatTheFolderLacks) {
  const ScratchFolder folder;
  EXPECT_EQ(gaussdrift_in(folder, "report .").exit_code, 6);
  write_file(folder / "summary.json", "{");
  const Outcome damaged = gaussdrift_in(folder, "report .");
  EXPECT_EQ(damaged.exit_code, 6);
  EXPECT_NE(damaged.err.find("damaged"), std::string::npos);
  write_file(folder / "summary.json", R"({"frames": []})");
  EXPECT_EQ(gaussdrift_in(folder, "report .").exit_code, 6);
}

TEST(Render, IsRefusedByAProgramWithoutPictures) {
  if (draws_pictures) GTEST_SKIP() << "built with pictures";
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --set output.report=none").exit_code, 0);
  for (const char* command : {"render output/a", "reproduce figures 5.1"}) {
    const Outcome refused = gaussdrift_in(folder, command);
    EXPECT_EQ(refused.exit_code, 2) << command;
    EXPECT_EQ(refused.err.rfind("error: this program draws no pictures: ", 0), 0u) << refused.err;
  }
}

TEST(Render, DrawsAgainWithoutRunning) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --set output.report=none").exit_code, 0);
  const Outcome drawn = gaussdrift_in(folder, "render output/a --field error --times 1 --out pictures");
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_TRUE(fs::exists(folder / "pictures/error_error_0001.png"));
  EXPECT_FALSE(fs::exists(folder / "pictures/error_error_0000.png"));
  const Outcome wrong = gaussdrift_in(folder, "render output/a --style heatmup");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("did you mean heatmap?"), std::string::npos) << wrong.err;
  EXPECT_EQ(gaussdrift_in(folder, "render output/a --style slices").exit_code, 2);
  EXPECT_EQ(gaussdrift_in(folder, "render output/a --field rha").exit_code, 2);
  EXPECT_EQ(gaussdrift_in(folder, "render output/b").exit_code, 6);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out bare --set reference.kind=none").exit_code, 0);
  const Outcome absent = gaussdrift_in(folder, "render bare --field error");
  EXPECT_EQ(absent.exit_code, 6);
  EXPECT_NE(absent.err.find("\"error\""), std::string::npos) << absent.err;
}

/// A picture of the user has the name of one that is to be drawn: in images/ of the run, in a folder of --out, beside a
/// single density. It stays, and no other is drawn.
TEST(Render, ReplacesNoFileOfOthers) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --set output.report=none --set 'output.images=[]'").exit_code, 0);
  struct Place {
    const char *command, *strange, *before;  // `before` is drawn first
  };
  for (const Place& place :
       {Place{"render output/a --style heatmap", "output/a/images/heatmap_0001.png",
              "output/a/images/heatmap_0000.png"},
        Place{"render output/a --style heatmap --out drawn", "drawn/heatmap_0001.png", "drawn/heatmap_0000.png"},
        Place{"render output/a/density/density_0001.vti --style contour", "contour_0001.png", "contour_0001.png"}}) {
    fs::create_directories((folder / place.strange).parent_path());
    write_file(folder / place.strange, "mine");
    const Outcome refused = gaussdrift_in(folder, place.command);
    EXPECT_EQ(refused.exit_code, 6) << place.command;
    EXPECT_NE(refused.err.find(fs::path(place.strange).filename().string()), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("would be replaced; move it away"), std::string::npos) << refused.err;
    EXPECT_EQ(read_file(folder / place.strange), "mine");
    EXPECT_EQ(fs::exists(folder / place.before), std::string(place.before) == place.strange);
    fs::remove(folder / place.strange);
    EXPECT_EQ(gaussdrift_in(folder, place.command).exit_code, 0);
    EXPECT_TRUE(fs::exists(folder / place.before));
  }
  for (const char* again : {"render output/a --style heatmap", "render output/a --style heatmap --out drawn"})
    EXPECT_EQ(gaussdrift_in(folder, again).exit_code, 0) << again;
  EXPECT_EQ(gaussdrift_in(folder, "render output/a --out output/a").exit_code, 6);
}

TEST(Compare, MeasuresTheDifferenceOfTwoRuns) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  const std::string quick = " --set output.report=none --set 'output.images=[]'";
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out one" + quick).exit_code, 0);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out two --set time.step=0.05" + quick).exit_code, 0);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out three --set evaluate.per_axis=31" + quick).exit_code, 0);
  const auto same = parsed_json(gaussdrift_in(folder, "compare one one --json").out);
  EXPECT_EQ(same["largest"], 0.0);
  const auto other = parsed_json(gaussdrift_in(folder, "compare one two --json").out);
  // 10 steps of 0.1 lag by 8.3e-7 rad: 0.5 times that, times the largest slope of the cone, 2.1/R.
  EXPECT_GT(other["largest"].get<double>(), 1e-8);
  EXPECT_LT(other["largest"].get<double>(), 0.5 * 8.4e-7 * 2.1 / 0.25 + 1e-7);
  EXPECT_EQ(gaussdrift_in(folder, "compare one two --tolerance 1e-3").exit_code, 0);
  EXPECT_EQ(gaussdrift_in(folder, "compare one two --tolerance 1e-12").exit_code, 5);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out four --set 'domain.min=[0, -1]' --set 'domain.max=[2, 1]'" + quick)
                .exit_code,
            0);
  EXPECT_EQ(gaussdrift_in(folder, "compare one four").exit_code, 6) << "the same number of points elsewhere";
  const Outcome grids = gaussdrift_in(folder, "compare one three");
  EXPECT_EQ(grids.exit_code, 6);
  EXPECT_NE(grids.err.find("different grids"), std::string::npos) << grids.err;
}

TEST(Compare, OfDifferentTimesComparesThoseThatAgreeAndTellsTheOthers) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  const std::string quick = " --set output.report=none --set 'output.images=[]' --set 'output.times=";
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out three" + quick + "[0, 0.25, 1]'").exit_code, 0);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out four" + quick + "[0, 0.5, 0.75, 1]'").exit_code, 0);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out late" + quick + "[0.8, 0.9]'").exit_code, 0);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out last" + quick + "[1]'").exit_code, 0);

  const Outcome some = gaussdrift_in(folder, "compare three four --json");
  EXPECT_EQ(some.exit_code, 0) << some.err;
  const auto found = parsed_json(some.out);
  ASSERT_EQ(found["outputs"].size(), 2u);
  EXPECT_EQ(found["outputs"][0]["t"], 0.0);
  EXPECT_EQ(found["outputs"][1]["t"], 1.0);
  EXPECT_LT(found["largest"].get<double>(), 1e-6);  // the same but for where steps are cut
  ASSERT_EQ(found["not_compared"].size(), 3u);
  EXPECT_EQ(found["not_compared"][0]["t"], 0.25);
  EXPECT_EQ(found["not_compared"][2]["t"], 0.75);
  EXPECT_NE(some.err.find("(t = 0.25) is not compared: four has no output at that time"), std::string::npos)
      << some.err;
  EXPECT_NE(some.err.find("(t = 0.5) is not compared: three has no output"), std::string::npos) << some.err;
  EXPECT_EQ(gaussdrift_in(folder, "compare three four --tolerance 1e-6").exit_code, 0);

  const Outcome none = gaussdrift_in(folder, "compare three late");
  EXPECT_EQ(none.exit_code, 6);
  EXPECT_NE(none.err.find("no output time in common: the one has t = 0, 0.25, 1, the other t = 0.8, 0.9"),
            std::string::npos)
      << none.err;

  // One output on each side, whatever holds it: has it come back?
  const Outcome single = gaussdrift_in(folder, "compare last three/density/density_0000.vti");
  EXPECT_EQ(single.exit_code, 0) << single.err;
  EXPECT_NE(single.err.find("the times differ"), std::string::npos) << single.err;
  // A file and a folder: the output of its time.
  const auto one = parsed_json(gaussdrift_in(folder, "compare last four --json").out);
  EXPECT_EQ(one["outputs"].size(), 1u);
  EXPECT_EQ(one["not_compared"].size(), 3u);
}

TEST(Doctor, FindsThisMachineWell) {
  const ScratchFolder folder;
  const Outcome out = gaussdrift_in(folder, "doctor --json");
  const auto found = parsed_json(out.out);
  EXPECT_TRUE(found["Gauss sum"]["well"]);
  EXPECT_TRUE(found["file"]["well"]);
  EXPECT_EQ(out.exit_code == 0, found["picture"]["well"].get<bool>());
}

}  // namespace
}  // namespace gaussdrift
