// Masks: an array of the file that says where there is land.
#include "read/land_mask.hpp"

#include <cmath>

#include "grid_files.hpp"

#ifdef HAS_NETCDF
#include "netcdf_files.hpp"
#endif

namespace gaussdrift::input {
namespace {

using read::MaskIs;
using read::Missing;

/// Which points have no value, as text: "..#." for 4 points of which the third is land.
std::string map_of(const GridData& data, std::size_t time = 0) {
  std::string map;
  for (std::size_t p = 0; p < data.points(); ++p) map += std::isnan(data.values[time][p * data.components]) ? '#' : '.';
  return map;
}

class LandMask : public GridFile {
 protected:
  static read::GridRequest masked(const std::string& mask, MaskIs is = MaskIs::as_the_file_says,
                                  Missing missing = Missing::land) {
    read::GridRequest request = vector_of("", missing);
    request.mask = mask, request.mask_is = is;
    return request;
  }
  /// 3 x 2 points, with (0, 0) where the model has land, as models write it: the mask is 0 there.
  void write_image_with(const std::string& mask) const {
    write_image("ocean.vti", 3, 2, data(array("u", 2, "1 2 0 0 3 4 5 6 7 8 0 0") + mask));
  }
};

TEST_F(LandMask, NamesTheLandOfParaViewsFiles) {
  write_image_with(array("tmask", 1, "1 0 0.5 1 2 0", "Float32"));
  const auto land = read::read_grid(folder_ / "ocean.vti", masked("tmask"));
  EXPECT_EQ(map_of(*land), ".#...#");
  EXPECT_TRUE(land->land);
  EXPECT_EQ(land->name, "u of ocean.vti");
  EXPECT_EQ(land->filled, "2 of 6 values missing: land");
  EXPECT_EQ(map_of(*read::read_grid(folder_ / "ocean.vti", masked("tmask", MaskIs::land))), "#.###.");
  // What stands there instead; and without the mask the zeros are a velocity.
  const auto nearest = read::read_grid(folder_ / "ocean.vti", masked("tmask", MaskIs::water, Missing::nearest));
  EXPECT_EQ(nearest->values[0][2], (1 + 3 + 7) / 3.0);
  auto request = vector_of("u", Missing::land);
  EXPECT_FALSE(read::read_grid(folder_ / "ocean.vti", request)->land);
  // Every file of a series has its own.
  write_image("dry.vti", 3, 2, data(array("u", 2, "1 2 1 1 3 4 5 6 7 8 0 0") + array("tmask", 1, "1 1 1 1 1 0")));
  write_series("tide.pvd", "<DataSet timestep=\"0\" file=\"dry.vti\"/><DataSet timestep=\"1\" file=\"ocean.vti\"/>");
  const auto tide = read::read_grid(folder_ / "tide.pvd", masked("tmask"));
  EXPECT_EQ(map_of(*tide, 0), ".....#");
  EXPECT_EQ(map_of(*tide, 1), ".#...#");
}

TEST_F(LandMask, OfCellsGoesWithDataOfCells) {
  write_image("cells.vti", 4, 2, data(array("u", 2, "1 2 3 4 5 6") + array("wet", 1, "1 0 1"), "CellData"));
  // Middles of cells, and a rim: 5 x 3 points.
  EXPECT_EQ(map_of(*read::read_grid(folder_ / "cells.vti", masked("wet"))), "..#....#....#..");
  write_image("mixed.vti", 4, 2,
              data(array("u", 2, "1 2 3 4 5 6 1 1 1 1 1 1 1 1 1 1")) + data(array("wet", 1, "1 0 1"), "CellData"));
  EXPECT_NE(refusal("mixed.vti", masked("wet")).find("the data belong to points"), std::string::npos);
}

TEST_F(LandMask, ThatSaysNothingIsRefused) {
  write_image_with(array("tmask", 1, "1 1 1 nan 1 1"));
  EXPECT_NE(refusal("ocean.vti", masked("tmask")).find("tmask of ocean.vti has no number at point 4"),
            std::string::npos);
  auto unknown = masked("mask");
  unknown.arrays = {"u"};
  EXPECT_NE(refusal("ocean.vti", unknown).find("has no array \"mask\", which mask names"), std::string::npos);
  write_image_with(array("tmask", 1, "1 1 1 1 1 1"));
  const std::string all = refusal("ocean.vti", masked("tmask", MaskIs::land));
  EXPECT_NE(all.find("all points are land"), std::string::npos) << all;
  EXPECT_NE(all.find("mask_is = \"water\""), std::string::npos) << all;
  write_image_with(array("tmask", 2, "1 1 1 1 1 1 1 1 1 1 1 1"));
  EXPECT_NE(refusal("ocean.vti", masked("tmask")).find("a mask has one component"), std::string::npos);
}

TEST_F(LandMask, IsAKeyOfCasesThatIsWrittenAgain) {
  write_vti("ocean.vti", 3, 3, 1, "u", 2, sampled(3, [](double x, double y) { return std::pair{x, y}; }));
  std::string text;
  std::getline(std::ifstream(folder_ / "ocean.vti"), text, '\0');
  const std::string end = "</PointData>";
  text.insert(text.find(end), array("wet", 1, "1 1 1 1 1 1 1 0 1"));
  std::ofstream(folder_ / "ocean.vti") << text;
  const auto read_with = [&](const std::string& more) {
    return parse_case(case_with("file = \"ocean.vti\"\narray = \"u\"\n" + more), folder_ / "cone.toml",
                      {"time.end=1", "output.times=[1]", "reference.kind=\"none\""})
        .spec;
  };
  const auto spec = read_with("mask = \"wet\"\nmask_is = \"water\"");
  const auto& file = std::get<FileVelocitySpec>(spec.velocity[0]);
  EXPECT_EQ(map_of(*file.data), ".......#.");
  const auto again = parse_case(case_text(spec), folder_ / "again.toml").spec;
  EXPECT_EQ(std::get<FileVelocitySpec>(again.velocity[0]), file);
  EXPECT_EQ(file.mask_is, "water");
  EXPECT_NE(message("file = \"ocean.vti\"\narray = \"u\"\nmask_is = \"land\"").find("\"mask_is\" goes with \"mask\""),
            std::string::npos);
  EXPECT_NE(message("file = \"ocean.vti\"\narray = \"u\"\nmask = \"wet\"\nmissing = \"keep\"")
                .find("missing = \"keep\" takes every number as it is"),
            std::string::npos);
}

#ifdef HAS_NETCDF

/// u, v (time, depth, lat, lon) of 2 x 2 x 2 x 3 numbers, lat descending; masks of several shapes.
void write_ocean(const std::filesystem::path& path) {
  NetcdfWriter file(path);
  file.dimension("time", 2), file.dimension("depth", 2), file.dimension("lat", 2), file.dimension("lon", 3);
  file.dimension("one", 1);
  for (const char* axis : {"time", "depth", "lat", "lon"}) file.variable(axis, NC_DOUBLE, {axis});
  for (const char* name : {"u", "v"}) file.variable(name, NC_FLOAT, {"time", "depth", "lat", "lon"});
  file.variable("tmask", NC_BYTE, {"one", "depth", "lat", "lon"});
  file.variable("mask_rho", NC_DOUBLE, {"lat", "lon"});
  file.variable("wet", NC_SHORT, {"time", "lon", "lat"});
  file.variable("land", NC_INT, {"lat", "lon"});
  file.text("land", "standard_name", "land_binary_mask");
  file.variable("flags", NC_INT, {"lat", "lon"});
  file.number("flags", "flag_values", 1, NC_INT);
  file.text("flags", "flag_meanings", "land");
  file.variable("line", NC_INT, {"lat"});
  file.variable("holes", NC_DOUBLE, {"lat", "lon"});
  file.number("holes", "_FillValue", -1);
  file.values("time", {0, 1}), file.values("depth", {5, 50}), file.values("lat", {20, 10}),
      file.values("lon", {1, 2, 3});
  file.values("u", std::vector<double>(24, 0)), file.values("v", std::vector<double>(24, 1));
  file.values("tmask", {1, 1, 1, 1, 0, 1, 0, 0, 1, 0, 0, 1});
  file.values("mask_rho", {1, 0, 1, 1, 1, 1});
  file.values("wet", {1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 0, 1});
  file.values("land", {0, 0, 0, 0, 0, 1});
  file.values("flags", {0, 0, 0, 1, 0, 0});
  file.values("line", {1, 0});
  file.values("holes", {1, 1, 1, 1, 1, -1});
}

TEST_F(LandMask, OfNetcdfLiesAlongSomeOfTheDimensionsOfTheData) {
  write_ocean(folder_ / "ocean.nc");
  const auto map = [&](const std::string& mask, double level, MaskIs is = MaskIs::as_the_file_says,
                       std::size_t time = 0) {
    read::GridRequest request = masked(mask, is);
    request.level = level;
    return map_of(*read::read_grid(folder_ / "ocean.nc", request), time);
  };
  // The first latitude of the file is the second one of the data.
  EXPECT_EQ(map("tmask", 5), ".#....");
  EXPECT_EQ(map("tmask", 50), "##.##.");
  EXPECT_EQ(map("mask_rho", 50), "....#.");
  EXPECT_EQ(map("wet", 5, MaskIs::water, 0), ".#....");
  EXPECT_EQ(map("wet", 5, MaskIs::water, 1), ".....#");
  EXPECT_EQ(map("land", 5), "..#...");
  EXPECT_EQ(map("land", 5, MaskIs::water), "##.###");  // the case knows better than the file
  EXPECT_EQ(map("flags", 5), "#.....");
  auto request = masked("line");
  request.level = 5;
  EXPECT_NE(refusal("ocean.nc", request).find("is the same along x or y"), std::string::npos);
  request.mask = "holes";
  EXPECT_NE(refusal("ocean.nc", request).find("holes of ocean.nc has no number"), std::string::npos);
  request.mask = "wind";
  EXPECT_NE(refusal("ocean.nc", request).find("has no array \"wind\", which mask names"), std::string::npos);
  // Read on the way, time by time; a mask without depth is that of all layers.
  request = masked("wet", MaskIs::water, Missing::nearest);
  request.level = 5, request.most_held = 1;
  const auto on_the_way = read::read_grid(folder_ / "ocean.nc", request);
  ASSERT_TRUE(on_the_way->levels);
  request = masked("mask_rho");
  request.dimension = 3, request.least_components = request.most_components = 2, request.arrays = {"u", "v"};
  EXPECT_EQ(map_of(*read::read_grid(folder_ / "ocean.nc", request)), "....#.....#.");
}

#endif

}  // namespace
}  // namespace gaussdrift::input
