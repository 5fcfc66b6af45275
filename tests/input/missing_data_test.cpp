// Data that are missing: by which marks they are known, what is no mark, and what stands there instead.
#include "read/missing_data.hpp"

#include <cmath>
#include <limits>

#include "field/gridded/gridded.hpp"
#include "grid_files.hpp"

namespace gaussdrift::input {
namespace {

using read::Missing;

class MissingData : public GridFile {
 protected:
  /// 4 x 3 points, one component a number: (1, 2) everywhere but at point 5, which is (1, 1), an inner one.
  void write_wind(const std::string& name, const std::string& bad, const std::string& type = "Float64",
                  const std::string& more = "", const std::string& beside = "") const {
    std::string values;
    for (int p = 0; p < 12; ++p) values += p == 5 ? bad + " " + bad + " " : "1 2 ";
    write_image(name, 4, 3, data(array("u", 2, values, type, more) + beside));
  }
  /// The values of point 5 with missing = "zero"; their size without marks.
  double settled(const std::string& name, Missing missing = Missing::zero) const {
    return read::read_grid(folder_ / name, vector_of("u", missing))->values[0][10];
  }
};

TEST_F(MissingData, IsKnownByItsMarks) {
  const struct {
    const char *value, *reason;
    const char* type = "Float64";
  } marks[] = {{"1e20", "1e+20 is there, a usual mark of missing data"},
               {"-1e20", "-1e+20 is there, a usual mark"},
               {"1e20", "1e+20 is there, a usual mark", "Float32"},
               {"9.96921e36", "9.96921e+36 is there, a usual mark", "Float32"},
               {"9.9692099683868690e+36", "9.96921e+36 is there, a usual mark"},
               {"-9999", "-9999 is there, a usual mark"},
               {"999", "999 is there, a usual mark"},
               {"-999.9", "-999.9 is there, a usual mark", "Float32"},
               {"-32768", "-32768 is there, a usual mark", "Int16"},
               {"3.4028235e38", "3.40282e+38 is there, a usual mark", "Float32"},
               {"7.3e15", "7.3e+15 is there, far outside of all other values"},
               {"nan", "nan is there"},
               {"inf", "inf is there"}};
  for (const auto& mark : marks) {
    write_wind("wind.vti", mark.value, mark.type);
    const std::string text = refusal("wind.vti", vector_of("u"));
    EXPECT_NE(text.find("u of wind.vti has no value at (1, 1): "), std::string::npos) << mark.value << "\n" << text;
    EXPECT_NE(text.find(mark.reason), std::string::npos) << mark.value << "\n" << text;
    EXPECT_NE(text.find("(1 of 12 values are missing)"), std::string::npos) << text;
    for (const char* remedy : {"missing = \"zero\"", "missing = \"nearest\"", "\"outside\"", "coast"})
      EXPECT_NE(text.find(remedy), std::string::npos) << remedy;
    EXPECT_EQ(settled("wind.vti"), 0) << mark.value;  // and the remedies work
    EXPECT_EQ(settled("wind.vti", Missing::nearest), 1) << mark.value;
    if (const double value = std::stod(mark.value); std::isfinite(value)) {
      EXPECT_NEAR(settled("wind.vti", Missing::keep) / value, 1, 1e-7);  // a rounding of single precision
    }
  }
  write_wind("wind.vti", "nan");
  EXPECT_NE(refusal("wind.vti", vector_of("u", Missing::keep)).find("missing = \"zero\" or \"nearest\""),
            std::string::npos);
}

TEST_F(MissingData, IsKnownWhereAllElseIsStill) {
  write_image("still.vti", 2, 2, data(array("u", 2, "0 0 -9999 -9999 0 0 0 0")));
  EXPECT_NE(refusal("still.vti", vector_of("u")).find("no value at (1, 0): -9999 is there"), std::string::npos);
  write_image("still.vti", 2, 2, data(array("u", 2, "0 0 1e19 0 0 0 0 0", "Float32")));
  EXPECT_NE(refusal("still.vti", vector_of("u")).find("no value at (1, 0): 1e+19 is there"), std::string::npos);
}

TEST_F(MissingData, IsMarkedByTheFileOrTheUser) {
  write_wind("wind.vti", "-7");
  EXPECT_EQ(settled("wind.vti"), -7);
  read::GridRequest request = vector_of("u", Missing::zero);
  request.missing_value = -7;
  EXPECT_EQ(read::read_grid(folder_ / "wind.vti", request)->values[0][10], 0);
  write_wind("named.vti", "-7", "Float64", "_FillValue=\"-7\"");
  EXPECT_EQ(settled("named.vti"), 0);
  write_wind("named.vti", "-7.3", "Float32", "missing_value=\"-7.3\"");  // rounded in the data
  EXPECT_EQ(settled("named.vti"), 0);
  write_wind("named.vti", "-7", "Float64", "_FillValue=\"-7,0\"");
  EXPECT_NE(refusal("named.vti", vector_of("u")).find("named.vti:3: _FillValue = \"-7,0\" is not a number"),
            std::string::npos);
}

TEST_F(MissingData, IsHiddenByTheMasksOfVtk) {
  const auto mask = [&](const std::string& name, const std::string& usual, const std::string& bad) {
    std::string flags;
    for (int p = 0; p < 12; ++p) flags += (p == 5 ? bad : usual) + " ";
    return array(name, 1, flags, "UInt8");
  };
  write_wind("ghost.vti", "1e20", "Float64", "", mask("vtkGhostType", "0", "2"));
  // The mask is no second array, and the point that it hides is missing whatever its value is.
  EXPECT_NE(refusal("ghost.vti", vector_of()).find("at (1, 1): the file hides this point"), std::string::npos);
  EXPECT_EQ(settled("ghost.vti"), 0);
  write_wind("ghost.vti", "7", "Float64", "", mask("vtkGhostType", "1", "3"));  // 1: a duplicate, which is seen
  EXPECT_EQ(settled("ghost.vti"), 0);
  EXPECT_EQ(settled("ghost.vti", Missing::nearest), 1);
  EXPECT_EQ(settled("ghost.vti", Missing::keep), 7);
  write_wind("probe.vti", "0", "Float64", "", mask("vtkValidPointMask", "1", "0"));  // of Resample To Image
  EXPECT_EQ(settled("probe.vti", Missing::nearest), 1);
  // Cells that are hidden: of their points those that no other cell has.
  write_image("cells.vti", 4, 2,
              data(array("u", 2, "1 0  1 0  1 0  7 0  1 0  1 0  1 0  7 0")) +
                  data(array("vtkGhostType", 1, "0 0 32", "UInt8"), "CellData"));
  const auto cells = read::read_grid(folder_ / "cells.vti", vector_of("", Missing::zero));
  EXPECT_EQ(cells->values[0][4], 1);
  EXPECT_EQ(cells->values[0][6], 0);
  EXPECT_EQ(cells->filled, "2 of 8 values missing, taken as zero");
}

TEST_F(MissingData, IsNotSeenInDataThatAreWhole) {
  // Densities that fall over many powers of ten, water beside air, a plateau that is 9999 high and its neighbours,
  // winds around a singular point, a field that is 1e7 everywhere.
  const auto accepted = [&](const std::string& values, int components, bool decays) {
    const auto count = static_cast<int>(std::count(values.begin(), values.end(), ' ')) / components / 2;
    write_image("whole.vti", count, 2, data(array("a", components, values)));
    read::GridRequest request{.decays = decays};
    request.least_components = request.most_components = static_cast<std::size_t>(components);
    return refusal("whole.vti", request);
  };
  EXPECT_EQ(accepted("1e18 1e9 1e-3 1e-30 0 0 5e-324 1e-200 ", 1, true), "");
  EXPECT_EQ(accepted("1000 1000 1.2 1.2 ", 1, true), "");
  EXPECT_EQ(accepted("999 999 1.2 1.2 ", 1, true), "");
  EXPECT_EQ(accepted("9999 9998 5000 100 ", 1, true), "");
  EXPECT_EQ(accepted("9999 9999 0 0 ", 1, true), "");
  EXPECT_EQ(accepted("1e20 1e20 1e20 1e20 ", 1, true), "");
  EXPECT_EQ(accepted("1e3 1e3 10 1e2 1e-4 1 0 0 ", 2, false), "");
  EXPECT_EQ(accepted("1e7 1.1e7 1e7 0 -1e7 1e7 0 0 ", 2, false), "");
  EXPECT_EQ(accepted("1000 0 1 1 1 1 1 1 ", 2, false), "");
  EXPECT_EQ(accepted("0 0 0 0 0 0 0 0 ", 2, false), "");
}

TEST_F(MissingData, IsContinuedFromTheNearestPointsLayerByLayer) {
  // One component; a row of a hole two points wide, and a hole at the corner.
  write_image("hole.vti", 5, 2, data(array("a", 1, "1 nan nan 4 nan   1 nan nan 4 nan")));
  const auto hole = read::read_grid(folder_ / "hole.vti", {.missing = Missing::nearest});
  EXPECT_EQ(hole->values[0], (std::vector<double>{1, 1, 4, 4, 4, 1, 1, 4, 4, 4}));
  EXPECT_EQ(hole->filled, "6 of 10 values missing, continued from the nearest");
  write_image("empty.vti", 2, 2, data(array("a", 1, "nan nan nan nan")));
  EXPECT_NE(refusal("empty.vti", {.missing = Missing::nearest}).find("has no values at all"), std::string::npos);
  EXPECT_EQ(read::read_grid(folder_ / "empty.vti", {.missing = Missing::zero})->values[0], std::vector<double>(4, 0.0));
}

TEST_F(MissingData, IsNeverWindThatClampLeadsInto) {
  // Land along x <= 1, marked at one time only; clamped to the left of it.
  write_image("a.vti", 3, 2, data(array("u", 2, "1e20 1e20 2 0 3 0  1e20 1e20 2 0 3 0")));
  write_image("b.vti", 3, 2, data(array("u", 2, "5 0 5 0 5 0  5 0 5 0 5 0")));
  write_series("wind.pvd", "<DataSet timestep=\"0\" file=\"a.vti\"/><DataSet timestep=\"2\" file=\"b.vti\"/>");
  EXPECT_NE(refusal("wind.pvd", vector_of()).find("u of wind.pvd has no value at (0, 0) in a.vti"), std::string::npos);
  for (const auto& [missing, meant] : {std::pair{Missing::zero, 2.5}, {Missing::nearest, 3.5}}) {
    const GridInterpolator grid(read::read_grid(folder_ / "wind.pvd", vector_of("", missing)), Interpolation::linear,
                                Outside::clamp);
    const double x = -3, y = 0.5;
    double u = 0, v = 0;
    double* sums[] = {&u, &v};
    grid.add(1, {2, 1, {&x, &y, nullptr}}, 2, sums);
    EXPECT_EQ(u, meant);
    EXPECT_EQ(v, 0);
  }
}

TEST_F(MissingData, OfCellsIsKnownBeforeTheyGoToPoints) {
  write_image("cells.vti", 4, 2, data(array("u", 2, "1 0  -9999 -9999  3 0"), "CellData"));
  EXPECT_NE(refusal("cells.vti", vector_of()).find("no value at (1.5, 0)"), std::string::npos);
  const auto zero = read::read_grid(folder_ / "cells.vti", vector_of("", Missing::zero));
  for (const double value : zero->values[0]) EXPECT_LE(std::abs(value), 3);
}

}  // namespace
}  // namespace gaussdrift::input
