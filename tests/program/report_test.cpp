// The page of a run in unusual circumstances, and times and order of the files that the verbs read.
#include <gtest/gtest.h>

#include "parsed_json.hpp"
#include "program.hpp"

namespace gaussdrift {
namespace {

/// small_case with two outputs, quick; `more` are options of run.
void run_cone(const ScratchFolder& folder, const std::string& more = "") {
  write_file(folder / "a.toml", small_case);
  const Outcome out = gaussdrift_in(
      folder, "run a.toml --set time.end=1 --set 'output.times=[0.25, 1]' --set output.report=none " + more);
  ASSERT_EQ(out.exit_code, 0) << out.err;
}

std::vector<double> times_compared(const ScratchFolder& folder, const std::string& a, const std::string& b) {
  const Outcome out = gaussdrift_in(folder, "compare " + a + " " + b + " --json");
  EXPECT_EQ(out.exit_code, 0) << out.err;
  std::vector<double> times;
  const auto document = nlohmann::json::parse(out.out, nullptr, false);
  if (!document.is_discarded())
    for (const auto& row : document["outputs"]) times.push_back(row["t"].get<double>());
  return times;
}

TEST(WrittenDensities, HaveTheTimesOfTheirFiles) {
  const ScratchFolder folder;
  run_cone(folder);
  const std::string run = "output/a", last = run + "/density/density_0001.vti";
  EXPECT_EQ(times_compared(folder, last, last), std::vector<double>{1});
  // A run that was killed has no summary; one that was killed earlier still lists fewer outputs than there are.
  fs::remove(folder / run / "summary.json");
  EXPECT_EQ(times_compared(folder, run, run), (std::vector<double>{0.25, 1}));
  fs::remove(folder / run / "density.pvd");
  EXPECT_EQ(times_compared(folder, run, run), (std::vector<double>{0.25, 1}));
  const Outcome apart = gaussdrift_in(folder, "compare " + run + "/density/density_0000.vti " + last);
  EXPECT_EQ(apart.exit_code, 0);  // two files may be compared whatever their times: has it come back?
  EXPECT_NE(apart.err.find("density_0000.vti is at t = 0.25, " + last + " at t = 1"), std::string::npos) << apart.err;
}

TEST(WrittenDensities, AreInTheOrderOfTheirNumbersAndDrawnUnderThem) {
  const ScratchFolder folder;
  run_cone(folder);
  const fs::path density = folder / "output/a/density";
  fs::rename(density / "density_0000.vti", density / "density_9999.vti");
  fs::rename(density / "density_0001.vti", density / "density_10000.vti");  // before it by name
  EXPECT_EQ(times_compared(folder, "output/a", "output/a"), (std::vector<double>{0.25, 1}));
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const Outcome drawn = gaussdrift_in(folder, "render output/a/ --style heatmap --times 1");
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_TRUE(fs::exists(folder / "output/a/images/heatmap_10000.png"));
  EXPECT_FALSE(fs::exists(folder / "output/a/images/heatmap_9999.png"));
}

TEST(WrittenDensities, OnUnequalSpacingsAreRefused) {
  const ScratchFolder folder;
  write_file(
      folder / "odd.vti",
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 1 0 1 0 "
      "0\" Origin=\"0 0 0\" Spacing=\"1 2 1\"><Piece Extent=\"0 1 0 1 0 0\"><PointData><DataArray "
      "type=\"Float64\" Name=\"rho\" format=\"ascii\">1 2 3 4</DataArray></PointData></Piece></ImageData>"
      "</VTKFile>\n");
  const Outcome out = gaussdrift_in(folder, "compare odd.vti odd.vti");
  EXPECT_EQ(out.exit_code, 6);
  EXPECT_NE(out.err.find("is not equally spaced"), std::string::npos) << out.err;
}

TEST(Page, TellsWhatIsNotOnItAndWhy) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  const std::string run = "run a.toml --force --set time.end=1 --set 'output.times=[0, 1]' ";
  const auto page = [&](const std::string& more) {
    const Outcome out = gaussdrift_in(folder, run + more);
    EXPECT_EQ(out.exit_code, 0) << out.err;
    gaussdrift_in(folder, "report output/a");
    return read_file(folder / "output/a/report.html");
  };
  const std::string sampled = page("--set reference.points=100");
  EXPECT_NE(sampled.find("of the 1600 grid points, those around the maximum among them"), std::string::npos);
  EXPECT_NE(sampled.find("pictures of the exact density and the error: only "), std::string::npos);
  const std::string alone = page("--set reference.kind=none --set 'output.vtk=[]'");
  EXPECT_NE(alone.find("errors: the density was compared with nothing"), std::string::npos);
  EXPECT_NE(alone.find("data:image"), std::string::npos) << "drawn from the frames of the page";
  const std::string still = page("--set reference.kind=none --set 'output.vtk=[]' --set output.report=still");
  EXPECT_NE(still.find("pictures: the run wrote no density files"), std::string::npos);
  EXPECT_NE(still.find("the run, played: there are neither frames of it"), std::string::npos);
  EXPECT_EQ(still.find("data:image"), std::string::npos);
  const std::string once = page("--set 'output.times=[1]'");
  EXPECT_NE(once.find("the run was compared at one time only"), std::string::npos);
  const auto report = parsed_json(read_file(folder / "output/a/report.json"));
  EXPECT_FALSE(report["not_on_the_page"].empty());
}

TEST(Page, BeginsWithASentenceThatCanBeActedOnAndLinksWhatIsThere) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  const Outcome out =
      gaussdrift_in(folder, "run a.toml --set case.label=dye --set time.end=1 --set 'output.times=[0, 1]'");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const std::string page = read_file(folder / "output/a/report.html");
  const auto summary = parsed_json(read_file(folder / "output/a/summary.json"));
  const double error = summary["frames"].back()["Linf"].get<double>();
  const std::size_t begin = page.find("<b>Right to ");
  ASSERT_NE(begin, std::string::npos);
  const std::string sentence = page.substr(begin, page.find("<br>", begin) - begin);
  EXPECT_NEAR(std::stod(sentence.substr(12)), 100 * error, 0.06 * 100 * error) << sentence;  // two digits
  EXPECT_NE(sentence.find("of the highest dye</b>"), std::string::npos) << sentence;
  EXPECT_NE(page.find("<a href=\"series.csv\">"), std::string::npos);
  EXPECT_EQ(page.find("<a href=\"tracks.csv\">"), std::string::npos);
}

TEST(Page, ShowsTheLimitsOfACheckWithDigitsThatTellThemFromItsValue) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case + "[[check]]\nwhat = \"mass\"\nmin = 0.999999\nmax = 1.000001\n");
  const Outcome out = gaussdrift_in(folder, "run a.toml --set time.end=1 --set 'output.times=[0, 1]'");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const std::string page = read_file(folder / "output/a/report.html");
  EXPECT_NE(page.find("<td class=n>0.999999<td class=n>1.000001<td>passed"), std::string::npos);
  EXPECT_NE(page.find("A check without <code>at</code> is made at every output"), std::string::npos);
}

TEST(Page, TellsAllAdviceWhatItsCurvesShowAndWhatIsNotPredicted) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  const Outcome out = gaussdrift_in(folder, "run a.toml --set time.end=1 --set 'output.times=[0, 1]'");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const fs::path run = folder / "output/a";
  const std::string page = read_file(run / "report.html");
  EXPECT_NE(page.find("relative error</text>"), std::string::npos);
  EXPECT_NE(page.find("(output.images); gaussdrift report draws them all the same.</ul>"), std::string::npos);

  auto summary = parsed_json(read_file(run / "summary.json"));
  summary["budget"]["advice"] = {"a longer step is as accurate", "more overlap helps"};
  summary["budget"]["predicted"] = {{"not_covered", "it would take too long"}};
  write_file(run / "summary.json", summary.dump());
  ASSERT_EQ(gaussdrift_in(folder, "report output/a").exit_code, 0);
  const std::string changed = read_file(run / "report.html");
  EXPECT_NE(changed.find("Advice: a longer step is as accurate; more overlap helps."), std::string::npos);
  EXPECT_NE(changed.find("Not predicted: it would take too long."), std::string::npos);
}

TEST(Page, TellsAboutPointsWhoseExactDensityIsNotKnown) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  const Outcome out = gaussdrift_in(folder,
                                    "run a.toml --set time.end=1 --set 'output.times=[0, 1]' --set 'velocity.u=[\"1\", "
                                    "\"0\"]' --set reference.kind=exact --set "
                                    "'reference.rho=\"sqrt(0.9 - x)\"' --set 'output.images=[\"heatmap\"]'");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const std::string page = read_file(folder / "output/a/report.html");
  EXPECT_NE(page.find("points of the last output the exact density is not known, and the norms leave them out"),
            std::string::npos);
}

TEST(Page, ThatCannotBeWrittenCostsNeitherTheRunNorItsChecks) {
  const ScratchFolder folder;
  // Every < is 4 bytes of the page and stands there three times: it alone is more than a file may have.
  write_file(folder / "a.toml", small_case + "vtk = []\n[[check]]\nwhat = \"Linf\"\nmax = 1e-9\n[case]\ntitle = \"" +
                                    std::string(3000, '<') + "\"\n");
  const Outcome out = gaussdrift_in(folder, "run a.toml --set time.end=1 --set 'output.times=[0, 1]'", "ulimit -f 32;");
  EXPECT_EQ(out.exit_code, 5) << out.err;
  EXPECT_NE(out.err.find("there is no page about this run"), std::string::npos) << out.err;
  EXPECT_NE(out.err.find("check failed"), std::string::npos) << out.err;
  EXPECT_TRUE(fs::exists(folder / "output/a/summary.json"));
  EXPECT_NE(read_file(folder / "output/a/log.txt").find("there is no page"), std::string::npos);
  EXPECT_EQ(gaussdrift_in(folder, "report output/a", "ulimit -f 32;").exit_code, 6) << "asked for, it is an error";
}

TEST(Page, ThatCannotBeWrittenIsExitCode6) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case + "vtk = []\n[case]\ntitle = \"" + std::string(3000, '<') + "\"\n");
  const Outcome out = gaussdrift_in(folder, "run a.toml --set time.end=1 --set 'output.times=[0, 1]'", "ulimit -f 32;");
  EXPECT_EQ(out.exit_code, 6) << out.err;
  EXPECT_NE(out.err.find("error: there is no page about this run: cannot write output/a/report.html"),
            std::string::npos)
      << out.err;
  EXPECT_NE(out.out.find("done   "), std::string::npos);
  for (const char* file : {"summary.json", "report.json", "log.txt"})
    EXPECT_TRUE(fs::exists(folder / "output/a" / file)) << file;
}

TEST(Page, ThatIsWrittenInPartIsExitCode6AndHasTheOtherFiles) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out a --set 'output.images=[\"heatmap\"]'").exit_code, 0);
  for (const std::string blocked : {"report.json", "report.html", "summary.png"}) {
    for (const char* file : {"report.json", "report.html", "summary.png"}) fs::remove_all(folder / "a" / file);
    fs::create_directories(folder / "a" / blocked / "in the way");
    const Outcome out = gaussdrift_in(folder, "report a");
    EXPECT_EQ(out.exit_code, 6) << blocked;
    EXPECT_NE(out.err.find("error: cannot write a/" + blocked), std::string::npos) << out.err;
    for (const char* file : {"report.json", "report.html", "summary.png"}) {
      if (file == blocked) continue;
      EXPECT_TRUE(fs::is_regular_file(folder / "a" / file)) << blocked << ": " << file;
    }
    fs::remove_all(folder / "a" / blocked);
  }
}

TEST(Page, OfASummaryThatWasCutOrChangedIsRefused) {
  const ScratchFolder folder;
  for (const char* summary :
       {R"({"case": "a", "title": "", "effects": [], "frames": [{}]})",
        R"({"case": "a", "title": "", "effects": [{"name": 3}], "frames": []})",
        R"({"case": "a", "title": 1, "effects": [], "frames": []})",
        R"({"case": "a", "title": "", "effects": [], "frames": [{"t": 0, "mass": 1, "centroid": 2, "Linf": "x"}]})",
        R"({"case": "a", "title": "", "effects": [], "frames": [], "checks": [{}]})"}) {
    write_file(folder / "summary.json", summary);
    const Outcome out = gaussdrift_in(folder, "report .");
    EXPECT_EQ(out.exit_code, 6) << summary << "\n" << out.err;
    EXPECT_NE(out.err.find("summary.json is damaged"), std::string::npos) << out.err;
  }
}

TEST(Page, SetsTheTargetBesideWhatWasAchievedAndTheAdvice) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  const Outcome out = gaussdrift_in(folder, "run a.toml --accuracy 0.02 --set time.end=1 --set 'output.times=[0, 1]'");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const auto summary = parsed_json(read_file(folder / "output/a/summary.json"));
  EXPECT_EQ(summary["accuracy"]["target"], 0.02);
  EXPECT_EQ(summary["accuracy"]["achieved"], summary["frames"].back()["Linf"]);
  EXPECT_EQ(summary["accuracy"]["met"], summary["accuracy"]["achieved"] <= 0.02);
  const std::string page = read_file(folder / "output/a/report.html");
  EXPECT_NE(page.find("Target 0.02: "), std::string::npos);
  ASSERT_FALSE(summary["budget"]["advice"].empty());
  EXPECT_NE(page.find("Advice: "), std::string::npos);
}

TEST(Page, HasTheAccuracyTableOfEveryShortRunAndSecondsThatAddUp) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml").exit_code, 0);
  const auto summary = parsed_json(read_file(folder / "output/a/summary.json"));
  ASSERT_EQ(summary["accuracy_table"].size(), 6u);
  for (const auto& row : summary["accuracy_table"]) EXPECT_LE(row["error"], row["tolerance"]);
  double told = 0;
  for (const auto& [stage, seconds] : summary["seconds"].items())
    if (stage != "total") told += seconds.get<double>();
  EXPECT_LE(told, summary["seconds"]["total"].get<double>() + 1e-9);  // roundings of sums
}

TEST(Page, OfARunInSpaceHasItsPanels) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "a.toml", case_text({.domain = cube,
                                           .velocity = velocity_of({"-y", "x", "0"}),
                                           .density = shape_of("wendland", "0.4, 0, 0", "0.5"),
                                           .particles = "per_axis = 16",
                                           .time = "end = 0.5\nstep = 0.1",
                                           .evaluate = "per_axis = 15",
                                           .output = R"(times = [0, 0.5]
vtk = ["density"]
images = ["slices"])"}));
  const Outcome out = gaussdrift_in(folder, "run a.toml");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const std::string page = read_file(folder / "output/a/report.html");
  for (const char* part : {"data:image/png;base64,", "<svg", "the largest error is"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("What is not on this page"), std::string::npos) << "nothing is missing";
  EXPECT_FALSE(fs::exists(folder / "output/a/summary.png.panel"));
}

TEST(Machine, IsDescribedByTheLibrariesThemselves) {
  const ScratchFolder folder;
  const auto found = parsed_json(gaussdrift_in(folder, "doctor --json").out);
  const std::string vectors = found["vectors"]["found"], picture = found["picture"]["found"];
  EXPECT_TRUE(vectors.starts_with("baseline") || vectors.starts_with("avx")) << vectors;
  if (!draws_pictures) return;
  const std::size_t vtk = picture.find("VTK ");
  ASSERT_NE(vtk, std::string::npos) << picture;
  EXPECT_GE(std::atoi(picture.c_str() + vtk + 4), 9) << picture;
}

TEST(Provenance, HasFlagsACommandForTheShellAndHashesOfTheData) {
  const ScratchFolder folder;
  ASSERT_EQ(gaussdrift_in(folder, "new gridded_wind --out cases").exit_code, 0);
  std::string windy = small_case;
  windy.replace(windy.find("u = ["), std::string("u = [\"-y\", \"x\"]").size(), "file = \"gridded_wind.pvd\"");
  write_file(folder / "cases/a.toml", windy + "[reference]\nkind = \"none\"\n");
  const auto run = [&](const std::string& call) {
    const Outcome out = gaussdrift_in(folder, call, "SOURCE_DATE_EPOCH=86400");
    EXPECT_EQ(out.exit_code, 0) << out.err;
  };
  run("run cases/a.toml --out there/one --set time.end=0.1 --set 'output.times=[0.1]'");
  const auto first = parsed_json(read_file(folder / "there/one/provenance.json"));
  EXPECT_EQ(first["date"], "1970-01-02T00:00:00Z");
  EXPECT_NE(first["flags"].get<std::string>().find("-O"), std::string::npos) << first["flags"];
  EXPECT_NE(first["command"].get<std::string>().find(" --set 'output.times=[0.1]'"), std::string::npos)
      << first["command"];
  ASSERT_EQ(first["data"].size(), 3u) << "a series and its two files";
  EXPECT_EQ(first["data"][0]["file"], "../../cases/gridded_wind.pvd");
  EXPECT_EQ(read_file(folder / "there/one/run.toml").find(folder.path().string()), std::string::npos)
      << "no absolute paths";

  // What lies elsewhere and is run from its resolved case is the same; other data are not.
  fs::create_directory(folder / "moved");
  fs::copy(folder / "cases", folder / "moved/cases", fs::copy_options::recursive);
  fs::copy(folder / "there", folder / "moved/there", fs::copy_options::recursive);
  run("run moved/there/one/run.toml --out two");
  const auto second = parsed_json(read_file(folder / "two/provenance.json"));
  EXPECT_EQ(second["resolved_case"], first["resolved_case"]);
  std::string wind = read_file(folder / "cases/gridded_wind_1.vti");
  write_file(folder / "cases/gridded_wind_1.vti", wind + "\n");
  run("run there/one/run.toml --out three");
  const auto third = parsed_json(read_file(folder / "three/provenance.json"));
  EXPECT_EQ(third["data"][1],
            (nlohmann::json{{"file", "../cases/gridded_wind_0.vti"}, {"hash", first["data"][1]["hash"]}}));
  EXPECT_NE(third["data"][2]["hash"], first["data"][2]["hash"]);
  EXPECT_NE(third["resolved_case"], first["resolved_case"]);
}

// The data of a run lie where they were seen from its folder when it began. A folder that was moved, also into earlier/, has another view.
TEST(Provenance, LeadsARunWhoseFolderWasMovedToItsData) {
  const ScratchFolder folder;
  ASSERT_EQ(gaussdrift_in(folder, "new gridded_wind").exit_code, 0);
  gaussdrift_in(folder,
                "run gridded_wind.toml --out a/run --set particles.per_axis=20 --set evaluate.per_axis=10 --set "
                "output.images=[] --set output.vtk=[] --set output.report=none --set output.times=[0] --set "
                "output.checkpoint=0.001 --set accuracy.budget=none");
  ASSERT_TRUE(fs::exists(folder / "a/run/summary.json"));
  fs::create_directories(folder / "b/c/d");
  fs::rename(folder / "a/run", folder / "b/c/d/earlier");
  const Outcome resumed = gaussdrift_in(folder, "resume b/c/d/earlier");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.out.find("is complete"), std::string::npos) << resumed.out;
  fs::rename(folder / "gridded_wind.pvd", folder / "elsewhere.pvd");
  const Outcome lost = gaussdrift_in(folder, "resume b/c/d/earlier");
  EXPECT_EQ(lost.exit_code, 3);
  EXPECT_NE(lost.err.find("when the run began the file was " + fs::canonical(folder.path()).string() +
                          "/gridded_wind.pvd; put it there again"),
            std::string::npos)
      << lost.err;
}

TEST(Provenance, HasACommandThatAShellTakesAsItWasTyped) {
  const ScratchFolder folder;
  run_cone(folder, R"(--out 'a b' --set 'case.title="it'\''s $HOME & <more>"' --set 'case.cite=""')");
  const auto provenance = parsed_json(read_file(folder / "a b/provenance.json"));
  const std::string command = provenance["command"];
  write_file(folder / "again.sh", "printf '%s\\n' " + command + "\n");
  const std::string call = "sh '" + (folder / "again.sh").string() + "' > '" + (folder / "words").string() + "'";
  ASSERT_EQ(std::system(call.c_str()), 0);
  const std::string words = read_file(folder / "words");
  for (const char* word : {"\na b\n", "\ncase.title=\"it's $HOME & <more>\"\n", "\ncase.cite=\"\"\n"})
    EXPECT_NE(words.find(word), std::string::npos) << word << " in\n" << words;
}

TEST(Provenance, RefusesATimeThatIsNoneBeforeAnEarlierRunIsTouched) {
  const ScratchFolder folder;
  run_cone(folder);
  for (const char* wrong : {"yesterday", "", "-1", "1.5", "253402300800", "99999999999999999999"}) {
    const Outcome out = gaussdrift_in(folder, "run a.toml --force", std::string("SOURCE_DATE_EPOCH='") + wrong + "'");
    EXPECT_EQ(out.exit_code, 3) << wrong;
    EXPECT_NE(out.err.find("SOURCE_DATE_EPOCH"), std::string::npos) << out.err;
  }
  EXPECT_TRUE(fs::exists(folder / "output/a/summary.json"));
}

}  // namespace
}  // namespace gaussdrift
