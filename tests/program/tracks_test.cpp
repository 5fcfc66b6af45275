// Tracks of a run, as a user meets them: their files, and the same bytes after a stop.
#include <gtest/gtest.h>

#include "case_text.hpp"
#include "program/program.hpp"
#include "program/same_run.hpp"

namespace gaussdrift {
namespace {

const std::string drifting = case_text(
    {.domain = "min = [-1, -1]\nmax = [1, 1]\nedges = [\"open\", \"open\"]",
     .velocity = velocity_of({"0.5-y", "x"}),
     .density = shape_of("wendland", "0.5, 0", "0.25"),
     .particles = "per_axis = 60",
     .time = "end = 4\nstep = 0.0005",
     .evaluate = "per_axis = 40",
     .output = "times = [0, 1.5, 3, 4]\nimages = []\nreport = \"none\"\ncheckpoint = 0.02\n"
               "fields = [\"rho\", \"age\", \"ftle\", \"flow_map_gradient\", \"residence_time\", \"exit_face\"]\n"
               "[output.tracks]\nevery = 5\nsteps = 200\nfields = [\"velocity\", \"rho\"]\npoints = \"buoys.csv\""});

TEST(TracksOfARun, AreWholeAfterAStop) {
  const ScratchFolder folder;
  std::ofstream(folder / "drifting.toml") << drifting;
  std::ofstream(folder / "buoys.csv") << "y,x\n0.25,-0.5\n-0.75,-0.9\n";
  const Outcome whole = gaussdrift_in(folder, "run drifting.toml --out whole");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  Outcome part = gaussdrift_in(folder, "run drifting.toml --out part --stop-after 0.001");
  EXPECT_EQ(part.exit_code, 7) << part.err;
  EXPECT_FALSE(fs::exists(folder / "part/tracks.vtp"));
  // Each time a little longer, so that it ends on any machine.
  for (double seconds = 0.02; part.exit_code == 7; seconds *= 1.1)
    part = gaussdrift_in(folder, "resume part --stop-after " + std::to_string(seconds));
  ASSERT_EQ(part.exit_code, 0) << part.err;
  expect_same(folder / "whole", folder / "part");

  const std::string table = read_file(folder / "whole/tracks.csv");
  EXPECT_NE(table.find("\n-1,0,-0.5,0.25,"), std::string::npos);
  // The cloud turns about (0, 0.5) on a circle of radius 0.7, whose top is outside and whose sides are not.
  EXPECT_NE(table.find(",y_max\n"), std::string::npos);
  EXPECT_EQ(table.find(",x_max\n"), std::string::npos);
  const std::string particles = read_file(folder / "whole/particles/particles_0003.vtp");
  for (const char* array : {"age\"", "ftle\"", "flow_map_gradient\" NumberOfComponents=\"9\"", "exit_face\""})
    EXPECT_NE(particles.find(std::string("Name=\"") + array), std::string::npos) << array;
  const std::string density = read_file(folder / "whole/density/density_0003.vti");
  EXPECT_NE(density.find("Name=\"ftle\""), std::string::npos);
  EXPECT_EQ(density.find("Name=\"age\""), std::string::npos);

  // Another run in the same folder takes the files of this one away.
  const Outcome again = gaussdrift_in(folder, "run drifting.toml --out whole --force --set 'output.tracks.files=[]'");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_FALSE(fs::exists(folder / "whole/tracks.vtp"));
  // What is followed belongs to the past of a run.
  const Outcome other = gaussdrift_in(folder, "resume whole --set output.tracks.every=7 --until 5");
  EXPECT_EQ(other.exit_code, 3) << other.err;
  EXPECT_NE(other.err.find("output.tracks.every"), std::string::npos) << other.err;
}

/// Of a PNG.
int height_of(const std::string& png) {
  int height = 0;
  for (std::size_t i = 20; i < 24; ++i) height = height << 8 | static_cast<unsigned char>(png.at(i));
  return height;
}

TEST(TracksOfARun, AreOnThePageAndInParaView) {
  const ScratchFolder folder;
  write_file(folder / "drifting.toml", drifting);
  write_file(folder / "buoys.csv", "y,x\n0.25,-0.5\n-0.75,-0.9\n");
  const std::string call =
      "run drifting.toml --set time.step=0.05 --set output.report=html --set output.tracks.steps=2";
  ASSERT_EQ(gaussdrift_in(folder, call + " --out with").exit_code, 0);
  const std::string view = read_file(folder / "with/view.py");
  EXPECT_NE(
      view.find("tracks = XMLPolyDataReader(registrationName='tracks', FileName=[os.path.join(here, 'tracks.vtp')])"),
      std::string::npos)
      << view;
  ASSERT_EQ(gaussdrift_in(folder, call + " --set 'output.tracks.files=[]' --out table").exit_code, 0);
  EXPECT_EQ(read_file(folder / "table/view.py").find("tracks"), std::string::npos);
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  // Pictures stand in rows of one height: densities and what changed, and the tracks.
  ASSERT_EQ(gaussdrift_in(folder, "report with").exit_code, 0);
  const std::string picture = read_file(folder / "with/summary.png");
  EXPECT_EQ(height_of(picture), 4 * 480);
  EXPECT_NE(read_file(folder / "with/report.html").find("the tracks if there are some"), std::string::npos);
  // Tracks that are elsewhere make another picture; none, or a table of something else, one row.
  std::string table = read_file(folder / "with/tracks.csv");
  table.erase(table.begin() + static_cast<std::ptrdiff_t>(table.size() / 2), table.end());
  write_file(folder / "with/tracks.csv", table);
  ASSERT_EQ(gaussdrift_in(folder, "report with").exit_code, 0);
  const std::string half = read_file(folder / "with/summary.png");
  EXPECT_EQ(height_of(half), 4 * 480);
  EXPECT_NE(half, picture);
  write_file(folder / "with/tracks.csv", "a,b\n1,2\n");
  ASSERT_EQ(gaussdrift_in(folder, "report with").exit_code, 0);
  EXPECT_EQ(height_of(read_file(folder / "with/summary.png")), 3 * 480);
}

}  // namespace
}  // namespace gaussdrift
