// Velocities on curvilinear grids (.vts): against the same numbers on a rectilinear grid, against exact flows, and
// files that are refused.
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "field/gridded/gridded.hpp"
#include "grid_files.hpp"

namespace gaussdrift::input {
namespace {

using Map = std::function<Vector(double a, double b, double c)>;

class CurvedFile : public GridFile {
 protected:
  /// n points an axis; `place` and `value` of indices.
  void write_vts(const std::string& name, std::array<int, 3> n, const Map& place, const Map& value,
                 const std::string& more = "") const {
    std::string places, values;
    for (int c = 0; c < n[2]; ++c)
      for (int b = 0; b < n[1]; ++b)
        for (int a = 0; a < n[0]; ++a) {
          const Vector x = place(a, b, c), u = value(a, b, c);
          places += fmt::format("{} {} {} ", x[0], x[1], x[2]);
          values += fmt::format("{} {} {} ", u[0], u[1], u[2]);
        }
    write_text(name, n, values, places, more);
  }
  void write_text(const std::string& name, std::array<int, 3> n, const std::string& values, const std::string& places,
                  const std::string& more = "", const std::string& components = "3") const {
    std::ofstream(folder_ / name) << fmt::format(
        "<VTKFile type=\"StructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><StructuredGrid "
        "WholeExtent=\"{0}\"><Piece Extent=\"{0}\">{1}<Points><DataArray type=\"Float64\" NumberOfComponents=\"{2}\" "
        "format=\"ascii\">{3}</DataArray></Points></Piece></StructuredGrid></VTKFile>\n",
        fmt::format("0 {} 0 {} 0 {}", n[0] - 1, n[1] - 1, n[2] - 1), data(array("u", 3, values) + more), components,
        places);
  }
  GridInterpolator read(const std::string& name, int dimension = 2) const {
    auto request = vector_of();
    request.dimension = dimension;
    return {read::read_grid(folder_ / name, request), Interpolation::linear, Outside::error};
  }
};

Vector value(const GridInterpolator& grid, Vector x, std::size_t count) {
  Vector u{};
  PointsView view{static_cast<int>(count), 1, {}};
  std::array<double*, max_dimension> sums{};
  for (std::size_t k = 0; k < count; ++k) view.axis[k] = &x[k], sums[k] = &u[k];
  grid.add(0, view, count, sums.data());
  return u;
}

std::array<Vector, max_dimension> gradient(const GridInterpolator& grid, Vector x, std::size_t count) {
  std::array<Vector, max_dimension> slopes{};
  std::array<std::array<double*, max_dimension>, max_dimension> to{};
  PointsView view{static_cast<int>(count), 1, {}};
  for (std::size_t k = 0; k < count; ++k) {
    view.axis[k] = &x[k];
    for (std::size_t l = 0; l < count; ++l) to[k][l] = &slopes[k][l];
  }
  grid.add_gradient(0, view, to);
  return slopes;
}

Vector wave(double a, double b, double c) { return {std::sin(a) + b, std::cos(b + c), a * b / 9 + std::sin(c)}; }

TEST_F(CurvedFile, OnASlantedGridTheyAreThoseOfAGridAlongTheAxes) {
  const Map slanted = [](double a, double b, double c) { return Vector{2 * a + b - c / 2, b - a / 4, c / 2 + a / 8}; };
  for (const int dimension : {2, 3}) {
    const int layers = dimension == 3 ? 5 : 1;
    const Map place = [&](double a, double b, double c) {
      Vector x = slanted(a, b, c);
      if (dimension == 2) x[2] = 7;
      return x;
    };
    write_vts("wind.vts", {7, 6, layers}, place, wave);
    const GridInterpolator curved = read("wind.vts", dimension);
    auto plain = std::make_shared<GridData>(curved.data());
    plain->curved = nullptr;
    const GridInterpolator by_index(plain, Interpolation::linear, Outside::error);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> part(0, 1);
    const auto count = static_cast<std::size_t>(dimension);
    for (int i = 0; i < 300; ++i) {
      const Vector index{6 * part(random), 5 * part(random), (layers - 1) * part(random)};
      const Vector x = slanted(index[0], index[1], index[2]);
      const Vector is = value(curved, x, count), expected = value(by_index, index, count);
      const auto slopes = gradient(curved, x, count), by_indices = gradient(by_index, index, count);
      for (std::size_t k = 0; k < count; ++k) {
        EXPECT_NEAR(is[k], expected[k], 1e-13);
        // d u / d index = d u / d x  d x / d index, by the columns of the slanted map.
        const double along_a = 2 * slopes[k][0] - slopes[k][1] / 4 + (dimension == 3 ? slopes[k][2] / 8 : 0);
        EXPECT_NEAR(along_a, by_indices[k][0], 1e-12);
        EXPECT_NEAR(slopes[k][0] + slopes[k][1], by_indices[k][1], 1e-12);
      }
    }
    EXPECT_LT(curved.data().curved->residual(), 1e-14);
    EXPECT_NE(curved.describe().find("curvilinear"), std::string::npos);
  }
}

Vector ring(int n, double a, double b) {
  const double r = 1 + a / n, angle = std::numbers::pi * b / (2 * n);
  return {r * std::cos(angle), r * std::sin(angle), 0};
}

TEST_F(CurvedFile, OnARingTheyConvergeWithTheSecondOrderAndTheirGradientIsThatOfDifferences) {
  // u = (-y^2, x^2): not linear, so that the grid is seen.
  const auto u = [](const Vector& x) { return Vector{-x[1] * x[1], x[0] * x[0], 0}; };
  const auto error = [&](int n) {
    write_vts(
        "ring.vts", {n + 1, n + 1, 1}, [&](double a, double b, double) { return ring(n, a, b); },
        [&](double a, double b, double) { return u(ring(n, a, b)); });
    const GridInterpolator grid = read("ring.vts");
    double largest = 0;
    for (int i = 0; i < 400; ++i) {
      const double r = 1.03 + 0.94 * std::fmod(i * 0.618034, 1), angle = 1.5 * std::fmod(i * 0.414214, 1) + 0.03;
      const Vector x{r * std::cos(angle), r * std::sin(angle), 0}, is = value(grid, x, 2), exact = u(x);
      largest = std::max({largest, std::abs(is[0] - exact[0]), std::abs(is[1] - exact[1])});
    }
    return largest;
  };
  const double coarse = error(16), fine = error(32);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.25);
  // What is left out along the radius and along the angle: h^2 / 8 times the largest second derivative, 2 and 2 r^2.
  EXPECT_LT(fine, (2 / std::pow(32, 2) + 8 * std::pow(std::numbers::pi / 64, 2)) / 8);
  const GridInterpolator grid = read("ring.vts");
  EXPECT_TRUE(std::isnan(value(grid, {0.5, 0.5, 0}, 2)[0]));  // in the hole
  EXPECT_NE(grid.why_lost({0.5, 0.5, 0}).find("[0.5, 0.5] is outside of the cells of u of ring.vts"),
            std::string::npos);
  EXPECT_FALSE(std::isnan(value(grid, {1, 0, 0}, 2)[0]));  // a corner
  const double h = 1e-6;
  const Vector x{1.1303, 0.7407, 0};
  const auto slopes = gradient(grid, x, 2);
  for (std::size_t l = 0; l < 2; ++l) {
    Vector up = x, down = x;
    up[l] += h, down[l] -= h;
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_NEAR(slopes[k][l], (value(grid, up, 2)[k] - value(grid, down, 2)[k]) / (2 * h), 1e-8);
  }
}

TEST_F(CurvedFile, ThatAreFoldedOrDamagedAreRefused) {
  const auto says = [&](const std::string& text, const read::GridRequest& request = vector_of()) {
    const std::string message = refusal("grid.vts", request);
    EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  const std::string zeros = "0 0 0 0 0 0 0 0 0 0 0 0";
  write_vts(
      "grid.vts", {3, 3, 1},
      [](double a, double b, double) {
        return Vector{a == 2 && b == 1 ? 0.5 : a, b, 0};
      },
      wave);
  says("the cell [1, 0] (counted from 0) is flat or folded");
  write_vts(
      "grid.vts", {3, 3, 1},
      [](double a, double b, double) {
        return Vector{a * std::cos(b), a * std::sin(b), 0};
      },
      wave);
  says("the cell [0, 0] (counted from 0) is flat or folded");
  write_text("grid.vts", {2, 2, 1}, zeros, "0 0 0 1 0 0 0 1 0 1 1");
  says("grid.vts");
  write_text("grid.vts", {2, 2, 1}, zeros, "0 0 0 1 0 0 0 1 0 1 nan 0");
  says("the y coordinate of point 4 of grid.vts is nan");
  write_text("grid.vts", {2, 2, 1}, zeros, "0 0 0 1 0 0 0 1 0 1 1 3");
  says("the points of grid.vts are no plane: z is 0 at point 1 and 3 at point 4");
  write_text("grid.vts", {2, 2, 1}, zeros, "0 0 1 0 0 1 1 1", "", "2");
  says("points have 3 components, not 2");
  write_text("grid.vts", {2, 2, 1}, zeros, "0 0 0 1 0 0 0 1 0 1 1 0");
  EXPECT_EQ(refusal("grid.vts", vector_of()), "");
  EXPECT_EQ(refusal("grid.vts", vector_of("", read::Missing::land)), "");
  EXPECT_NE(message("file = \"grid.vts\"\ninterpolation = \"cubic\"").find("interpolation = \"linear\""),
            std::string::npos);
  EXPECT_NE(message("file = \"grid.vts\"\noutside = \"clamp\"").find("outside = \"zero\" or \"error\""),
            std::string::npos);
  write_text("grid.vts", {2, 2, 1}, "nan 0 0 0 0 0 0 0 0 0 0 0", "0 0 0 1 0 0 0 1 0 1 1 0");
  says("land is known on other grids only", vector_of("", read::Missing::land));
}

}  // namespace
}  // namespace gaussdrift::input
