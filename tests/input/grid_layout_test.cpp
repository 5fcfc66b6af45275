// Data on grids in the forms that other programs write: components in arrays of their own, data of cells, axes that
// descend, coordinates in single precision.
#include <cmath>

#include "field/gridded/gridded.hpp"
#include "gaussdrift/simulation.hpp"
#include "grid_files.hpp"

namespace gaussdrift::input {
namespace {

class GridLayout : public GridFile {
 protected:
  /// The first components at a place.
  static std::array<double, 2> at(const std::shared_ptr<const GridData>& data, double x, double y,
                                  Outside outside = Outside::error) {
    const GridInterpolator grid(data, Interpolation::linear, outside);
    std::array<double, 2> u{};
    double* sums[] = {&u[0], &u[1]};
    grid.add(0, {2, 1, {&x, &y, nullptr}}, data->components > 1 ? 2 : 1, sums);
    return u;
  }
};

TEST_F(GridLayout, MayHaveAnArrayForEachComponent) {
  const std::string u = array("u", 1, "1 2 3 4"), v = array("v", 1, "5 6 7 8");
  write_image("wind.vti", 2, 2, data(u + v));
  read::GridRequest request{.arrays = {"u", "v"}, .least_components = 2, .most_components = 3};
  EXPECT_EQ(read::read_grid(folder_ / "wind.vti", request)->values[0], (std::vector<double>{1, 5, 2, 6, 3, 7, 4, 8}));
  request.arrays = {"v", "u"};
  const auto turned = read::read_grid(folder_ / "wind.vti", request);
  EXPECT_EQ(turned->values[0][0], 5);
  EXPECT_EQ(turned->name, "[v, u] of wind.vti");
  // The remedy that is offered is the one that works.
  EXPECT_NE(refusal("wind.vti", vector_of()).find("\narrays = [\"u\", \"v\"]"), std::string::npos);
  EXPECT_NE(refusal("wind.vti", vector_of("u")).find("\narrays = [\"u\", \"v\"]"), std::string::npos);

  write_image("mixed.vti", 2, 2, data(u + array("w", 2, "1 2 3 4 5 6 7 8")) + data(array("c", 1, "1"), "CellData"));
  request.arrays = {"u", "w"};
  EXPECT_NE(refusal("mixed.vti", request).find("\"w\" of mixed.vti has 2 components, needed: 1"), std::string::npos);
  request.arrays = {"u", "c"};
  EXPECT_NE(refusal("mixed.vti", request).find("\"c\" belongs to cells and \"u\" to points"), std::string::npos);
}

TEST_F(GridLayout, OfSeveralArraysIsInTheCaseAndInItsResolvedForm) {
  write_image("wind.vti", 2, 2, data(array("u", 1, "1 2 3 4") + array("v", 1, "5 6 7 8")),
              "Origin=\"-1 -1 0\" Spacing=\"2 2 1\"");
  const Case scene = parse_case(case_with("file = \"wind.vti\"\narrays = [\"u\", \"v\"]\nmissing = \"nearest\"\n"
                                          "missing_value = -7"),
                                folder_ / "cone.toml")
                         .spec;
  const std::string resolved = case_text(scene);
  for (const char* line : {"arrays = [\"u\", \"v\"]", "missing = \"nearest\"", "missing_value = -7"})
    EXPECT_NE(resolved.find(line), std::string::npos) << line;
  const Case again = parse_case(resolved, "/elsewhere/run.toml").spec;
  EXPECT_EQ(std::get<FileVelocitySpec>(again.velocity.at(0)).data->values,
            std::get<FileVelocitySpec>(scene.velocity.at(0)).data->values);
  EXPECT_NE(
      message("file = \"wind.vti\"\narray = \"u\"\narrays = [\"u\", \"v\"]").find("both \"array\" and \"arrays\""),
      std::string::npos);
  EXPECT_NE(message("file = \"wind.vti\"\narrays = [\"u\"]").find("velocity.arrays needs 2 names"), std::string::npos);
  EXPECT_NE(message("file = \"wind.vti\"\narrays = \"u\"").find("must be a list of names"), std::string::npos);
}

TEST_F(GridLayout, OfCellsHasItsValuesAtTheirMiddles) {
  // u = x, v = 2 y at the middles of cells of uneven sizes, where it must come back; between them it is linear.
  write_vtr("cells.vtr", "0 1 3 4", "0 2 3", data(array("u", 2, "0.5 2  2 2  3.5 2  0.5 5  2 5  3.5 5"), "CellData"));
  const auto cells = read::read_grid(folder_ / "cells.vtr", vector_of());
  for (const auto& [x, y] : {std::pair{0.5, 1.0}, {2.0, 1.0}, {3.5, 2.5}, {1.7, 2.2}, {3.0, 1.3}}) {
    EXPECT_NEAR(at(cells, x, y)[0], x, 1e-15);  // roundings of numbers up to 5
    EXPECT_NEAR(at(cells, x, y)[1], 2 * y, 1e-15);
  }
  EXPECT_EQ(at(cells, 0, 0)[0], 0.5);  // the rim has the value of its cell
  EXPECT_EQ(at(cells, 4, 3)[0], 3.5);
  EXPECT_TRUE(std::isnan(at(cells, 4.01, 1)[0]));
}

TEST_F(GridLayout, MayDescend) {
  const std::string u = "0 0  1 0  2 0  0 1  1 1  2 1";  // (column, row)
  write_vtr("down.vtr", "2 1 0", "0 5", data(array("u", 2, u)));
  const auto down = read::read_grid(folder_ / "down.vtr", vector_of());
  EXPECT_EQ(down->axis[0], (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(at(down, 2, 0)[0], 0);
  EXPECT_EQ(at(down, 0.5, 5)[0], 1.5);
  EXPECT_EQ(at(down, 0.5, 5)[1], 1);
  write_vtr("both.vtr", "2 1 0", "5 0", data(array("u", 2, u)));
  EXPECT_EQ(at(read::read_grid(folder_ / "both.vtr", vector_of()), 0.5, 5)[1], 0);
  for (const char* attributes :
       {"Origin=\"2 0 0\" Spacing=\"-1 5 1\"", "Origin=\"2 0 0\" Spacing=\"1 5 1\" Direction=\"-1 0 0 0 1 0 0 0 1\""}) {
    write_image("down.vti", 3, 2, data(array("u", 2, u)), attributes);
    EXPECT_EQ(read::read_grid(folder_ / "down.vti", vector_of())->values, down->values) << attributes;
  }
  write_vtr("cells.vtr", "2 1 0", "0 5", data(array("u", 2, "7 0 8 0"), "CellData"));
  EXPECT_EQ(at(read::read_grid(folder_ / "cells.vtr", vector_of()), 0.5, 1)[0], 8);
  write_vtr("zigzag.vtr", "0 2 1", "0 5", data(array("u", 2, u)));
  EXPECT_NE(refusal("zigzag.vtr", vector_of())
                .find("the x coordinates of zigzag.vtr neither ascend nor descend: 1 comes after 2 at point 3"),
            std::string::npos);
}

TEST_F(GridLayout, InSinglePrecisionReachesToWhereItsNumbersMean) {
  const std::string u = array("u", 2, "1 0  1 0  1 0  1 0"), far = "0 0.69999999", near = "0 0.69";
  write_vtr("single.vtr", "0 0.7", "0 0.7", data(u), "Float32");
  const auto single = read::read_grid(folder_ / "single.vtr", vector_of());
  ASSERT_LT(single->axis[0].back(), 0.7);
  EXPECT_EQ(at(single, 0.7, 0.7)[0], 1);
  EXPECT_TRUE(std::isnan(at(single, 0.70001, 0)[0]));
  // Images: spacings that were written with so many digits.
  for (const auto& [spacing, cells] : {std::pair{"0.333333", 3}, {"0.699999988079071", 1}, {"0.0333333", 30}}) {
    const double meant = cells == 1 ? 0.7 : 1.0;
    std::string ones;
    for (int i = 0; i < 2 * (cells + 1); ++i) ones += "1 0 ";
    write_image("six.vti", cells + 1, 2, data(array("u", 2, ones)), fmt::format("Spacing=\"{0} 1 1\"", spacing));
    const auto six = read::read_grid(folder_ / "six.vti", vector_of());
    ASSERT_LT(six->axis[0].back(), meant);
    EXPECT_EQ(at(six, meant, 0)[0], 1) << spacing;
    EXPECT_TRUE(std::isnan(at(six, meant + 0.001, 0)[0])) << spacing;
  }
  // Where it is outside, the message has the digits that show it.
  write_vtr("exact.vtr", far, far, data(u));
  const GridInterpolator exact(read::read_grid(folder_ / "exact.vtr", vector_of()), Interpolation::linear,
                               Outside::error);
  EXPECT_NE(
      exact.why_lost({0.7, 0, 0}).find("x = 0.7 is outside of u of exact.vtr, which reaches from 0 to 0.69999999"),
      std::string::npos)
      << exact.why_lost({0.7, 0, 0});
}

TEST_F(GridLayout, OfOneLayerAlongAnAxisIsReadAsItIs) {
  write_pieces("thin.vti", "0 0 0 1 0 2", "Spacing=\"1 1 1\"",
               "<Piece Extent=\"0 0 0 1 0 2\">" + data(array("rho", 1, "0 1 2 3 4 5")) + "</Piece>");
  const read::GridSnapshot thin = read::read_snapshot(folder_ / "thin.vti", "rho");
  EXPECT_EQ(thin.dimension, 3);
  EXPECT_EQ(thin.axis[0].size(), 1u);
  EXPECT_EQ(thin.values, (std::vector<double>{0, 1, 2, 3, 4, 5}));
  EXPECT_NE(refusal("thin.vti", {.dimension = 3}).find("1 point along x is no grid"), std::string::npos);
}

TEST_F(GridLayout, IsTheTrueReasonWhereThePastOfAPointLeavesTheWind) {
  write_image("wind.vti", 2, 2, data(array("u", 2, "1 0  1 0  1 0  1 0")), "Origin=\"-1 -1 0\" Spacing=\"2 2 1\"");
  const Case scene = parse_case(case_with("file = \"wind.vti\""), folder_ / "cone.toml",
                                {"time.end=0.1", "time.step=0.05", "output.times=[0, 0.1]", "evaluate.per_axis=20"})
                         .spec;
  const RunSummary summary = Simulation(scene).run();
  ASSERT_GT(summary.reference.untraced, 0u);  // those whose past is beyond x = -1
  EXPECT_NE(summary.reference.trouble.find("on its way back in time x = -1.000"), std::string::npos)
      << summary.reference.trouble;
  EXPECT_NE(summary.reference.trouble.find("is outside of u of wind.vti, which reaches from -1 to 1"),
            std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::input
