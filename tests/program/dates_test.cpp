// Dates in place of times, where the data of a case have them: ends of runs, outputs that are drawn again.
#ifdef HAS_NETCDF
#include <gtest/gtest.h>

#include "../input/netcdf_files.hpp"
#include "program.hpp"

namespace gaussdrift {
namespace {

/// A wind to the east at four hours from 2000-01-03 12:00.
void write_wind(const fs::path& path) {
  NetcdfWriter file(path);
  file.dimension("time", 4), file.dimension("y", 2), file.dimension("x", 2);
  for (const char* axis : {"time", "y", "x"}) file.variable(axis, NC_DOUBLE, {axis});
  file.text("time", "units", "hours since 2000-01-03 12:00");
  for (const char* name : {"u", "v"}) file.variable(name, NC_DOUBLE, {"time", "y", "x"});
  file.values("time", {0, 1, 2, 3}), file.values("y", {-3, 3}), file.values("x", {-3, 3});
  file.values("u", std::vector<double>(16, 0.1)), file.values("v", std::vector<double>(16, 0));
}

class Dates : public ::testing::Test {
 protected:
  Dates() {
    write_wind(folder_ / "wind.nc");
    write_file(folder_ / "a.toml", case_text({.velocity = "file = \"wind.nc\"",
                                              .density = shape_of("wendland", "0, 0", "0.4"),
                                              .particles = "per_axis = 30",
                                              .time = "end = \"2000-01-03 13:00\"\nstep = 0.1",
                                              .evaluate = "per_axis = 21",
                                              .reference = not_compared,
                                              .output = "times = [0, \"2000-01-03 13:00\"]\nimages = [\"heatmap\"]"}));
  }
  ScratchFolder folder_;
};

TEST_F(Dates, SayUntilWhenARunGoesOn) {
  ASSERT_EQ(gaussdrift_in(folder_, "run a.toml --set output.images=[] --set output.checkpoint=1e-9").exit_code, 0);
  const Outcome wrong = gaussdrift_in(folder_, "resume output/a --until tomorrow");
  EXPECT_NE(wrong.exit_code, 0);
  EXPECT_NE(wrong.err.find("--until tomorrow is no number, and no date such as \"2000-01-03 13:00\""),
            std::string::npos)
      << wrong.err;
  const Outcome more = gaussdrift_in(folder_, "resume output/a --until '2000-01-03 15:00'");
  ASSERT_EQ(more.exit_code, 0) << more.err;
  const std::string series = read_file(folder_ / "output/a/series.csv");
  EXPECT_NE(series.find("\n3,2000-01-03 15:00,"), std::string::npos) << series;
  EXPECT_NE(series.find("\n2,2000-01-03 14:00,"), std::string::npos) << series;
  EXPECT_NE(gaussdrift_in(folder_, "resume output/a --until 2000-01-02").err.find("is no time of this run"),
            std::string::npos);
  // A case without dates has none.
  write_file(folder_ / "b.toml", small_case);
  ASSERT_EQ(gaussdrift_in(folder_, "run b.toml --set output.report=none").exit_code, 0);
  EXPECT_NE(gaussdrift_in(folder_, "resume output/b --until 2000-01-02").err.find("no data of this run have dates"),
            std::string::npos);
}

TEST_F(Dates, StandInPicturesThatAreDrawnAgain) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  ASSERT_EQ(gaussdrift_in(folder_, "run a.toml").exit_code, 0);
  const std::string drawn = read_file(folder_ / "output/a/images/heatmap_0001.png");
  const Outcome again =
      gaussdrift_in(folder_, "render output/a --style heatmap --times '2000-01-03 13:00' --out there");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_FALSE(fs::exists(folder_ / "there/heatmap_0000.png"));
  EXPECT_EQ(read_file(folder_ / "there/heatmap_0001.png"), drawn) << "the run draws the date, and so does render";
  EXPECT_EQ(gaussdrift_in(folder_, "render output/a --style heatmap --times 1 --out number").exit_code, 0);
  EXPECT_EQ(read_file(folder_ / "number/heatmap_0001.png"), drawn);
  const Outcome wrong = gaussdrift_in(folder_, "render output/a --times 2000-01-04 --out wrong");
  EXPECT_NE(wrong.err.find("has this date; there are 2000-01-03 12:00, 2000-01-03 13:00"), std::string::npos)
      << wrong.err;
  // Without the dates of summary.json its picture is another one.
  const std::string summary = read_file(folder_ / "output/a/summary.png");
  std::string json = read_file(folder_ / "output/a/summary.json");
  for (std::size_t at; (at = json.find("\"date\"")) != std::string::npos;) json.replace(at, 6, "\"note\"");
  write_file(folder_ / "output/a/summary.json", json);
  EXPECT_EQ(gaussdrift_in(folder_, "report output/a").exit_code, 0);
  EXPECT_NE(read_file(folder_ / "output/a/summary.png"), summary);
}

}  // namespace
}  // namespace gaussdrift
#endif
