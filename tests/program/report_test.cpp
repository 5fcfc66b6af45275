// The page of a run in unusual circumstances, and times and order of the files that the verbs read.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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
  EXPECT_EQ(apart.exit_code, 6);
  EXPECT_NE(apart.err.find("at t = 0.25 in the one and at t = 1 in the other"), std::string::npos) << apart.err;
}

TEST(WrittenDensities, AreInTheOrderOfTheirNumbersAndDrawnUnderThem) {
  const ScratchFolder folder;
  run_cone(folder);
  const fs::path density = folder / "output/a/density";
  fs::rename(density / "density_0000.vti", density / "density_9999.vti");
  fs::rename(density / "density_0001.vti", density / "density_10000.vti");  // before it by name
  EXPECT_EQ(times_compared(folder, "output/a", "output/a"), (std::vector<double>{0.25, 1}));
  const Outcome drawn = gaussdrift_in(folder, "render output/a/ --style heatmap --times 1");
  if (drawn.exit_code == 1) GTEST_SKIP() << drawn.err;  // built without pictures
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
  EXPECT_NE(sampled.find("pictures of the exact density and the error: the run was compared at a sample"),
            std::string::npos);
  const std::string alone = page("--set reference.kind=none --set 'output.vtk=[]'");
  EXPECT_NE(alone.find("errors: the run was compared with nothing"), std::string::npos);
  EXPECT_NE(alone.find("pictures: the run wrote no density files"), std::string::npos);
  EXPECT_EQ(alone.find("data:image"), std::string::npos);
  const std::string once = page("--set 'output.times=[1]'");
  EXPECT_NE(once.find("the run was compared at one time only"), std::string::npos);
  const auto report = nlohmann::json::parse(read_file(folder / "output/a/report.json"));
  EXPECT_FALSE(report["not_on_the_page"].empty());
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

TEST(Page, OfARunInSpaceHasItsPanels) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", R"(gaussdrift = 1
[domain]
min = [-1, -1, -1]
max = [1, 1, 1]
[velocity]
u = ["-y", "x", "0"]
[density]
shape = "wendland"
center = [0.4, 0, 0]
radius = 0.5
[particles]
per_axis = 16
[time]
end = 0.5
step = 0.1
[evaluate]
per_axis = 15
[output]
times = [0, 0.5]
vtk = ["density"]
images = ["slices"]
)");
  const Outcome out = gaussdrift_in(folder, "run a.toml");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const std::string page = read_file(folder / "output/a/report.html");
  for (const char* part : {"data:image/png;base64,", "<svg", "the largest error is"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("What is not on this page"), std::string::npos) << "nothing is missing";
  EXPECT_FALSE(fs::exists(folder / "output/a/summary.png.panel"));
}

}  // namespace
}  // namespace gaussdrift
