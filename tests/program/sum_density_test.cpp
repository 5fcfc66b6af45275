// gaussdrift sum --normalise and --bandwidth: densities from points, against the mean of normal densities by their formula.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "parsed_json.hpp"
#include "program/program.hpp"
#include "program/sum_tables.hpp"

namespace gaussdrift {
namespace {

/// [xx, xy, yy]
using Matrix = std::array<double, 3>;

/// The covariance of weighted samples in the plane, times `factor`.
Matrix covariance(const Rows& rows, double factor) {
  double all = 0, squares = 0, mean[2] = {};
  for (const auto& row : rows) {
    all += row[2], squares += row[2] * row[2];
    for (int k = 0; k < 2; ++k) mean[k] += row[2] * row[k];
  }
  Matrix sums{};
  for (const auto& row : rows) {
    const double x = row[0] - mean[0] / all, y = row[1] - mean[1] / all;
    sums[0] += row[2] * x * x, sums[1] += row[2] * x * y, sums[2] += row[2] * y * y;
  }
  for (double& sum : sums) sum *= factor / (all - squares / all);
  return sums;
}

double counted(const Rows& rows) {
  double all = 0, squares = 0;
  for (const auto& row : rows) all += row[2], squares += row[2] * row[2];
  return all * all / squares;
}

/// sum w exp(-z^T C^-1 z / 2), divided by what a density is divided by.
double mean_of_normals(const Rows& rows, const std::vector<double>& at, const Matrix& c, bool normalised = true) {
  const double determinant = c[0] * c[2] - c[1] * c[1];
  double sum = 0, all = 0;
  for (const auto& row : rows) {
    const double x = at[0] - row[0], y = at[1] - row[1];
    sum += row[2] * std::exp(-0.5 * (c[2] * x * x - 2 * c[1] * x * y + c[0] * y * y) / determinant);
    all += row[2];
  }
  return normalised ? sum / (all * 2 * std::numbers::pi * std::sqrt(determinant)) : sum;
}

/// Correlated points, with weights.
Rows cloud(int count) {
  Rows rows = points(count, 3);
  for (auto& row : rows) row[1] = 0.5 * row[1] + row[0];
  return rows;
}

TEST(SumOfADensity, IsTheMeanOfNormalDensities) {
  const ScratchFolder folder;
  const Rows sources = cloud(400), targets = points(30, 2);
  write_file(folder / "S.csv", csv("x,y,weight", sources));
  write_file(folder / "T.csv", csv("x,y", targets));
  const double n = counted(sources);
  const std::vector<std::pair<std::string, Matrix>> given{
      {"", covariance(sources, std::pow(n, -2.0 / 6))},
      {"--bandwidth scott", covariance(sources, std::pow(n, -2.0 / 6))},
      {"--bandwidth silverman", covariance(sources, std::pow(n, -2.0 / 6))},  // the same in the plane
      {"--bandwidth 0.25", {0.0625, 0, 0.0625}},
      {"--sigma 8", {0.0625, 0, 0.0625}},
      {"--bandwidth 0.04,0.01,0.01,0.09", {0.04, 0.01, 0.09}},
      {"--bandwidth 0.04,0,0,0.09", {0.04, 0, 0.09}}};
  for (const auto& [option, matrix] : given) {
    const std::string call = "sum --sources S.csv --targets T.csv --tolerance 1e-10 " + option;
    const Outcome sum = gaussdrift_in(folder, call + " --normalise");
    ASSERT_EQ(sum.exit_code, 0) << sum.err;
    const Table table = table_of(sum.out);
    EXPECT_EQ(table.header, "density");
    const double peak = 1 / (2 * std::numbers::pi * std::sqrt(matrix[0] * matrix[2] - matrix[1] * matrix[1]));
    for (std::size_t i = 0; i < targets.size(); ++i)
      EXPECT_NEAR(table.rows[i][0], mean_of_normals(sources, targets[i], matrix), 1.01e-10 * peak) << option;
    if (option.empty()) continue;
    const Outcome plain = gaussdrift_in(folder, call);
    EXPECT_EQ(table_of(plain.out).header, "d_0_0") << plain.err;
    for (std::size_t i = 0; i < targets.size(); ++i)
      EXPECT_NEAR(table_of(plain.out).rows[i][0], mean_of_normals(sources, targets[i], matrix, false), 1e-10 * 400)
          << option;
  }
}

TEST(SumOfADensity, OnAGridHasItsShapeAndTheIntegral1) {
  const ScratchFolder folder;
  Rows sources = cloud(300);
  for (auto& row : sources) row[2] = 1;
  write_file(folder / "S.csv", csv("x,y,weight", sources));
  std::string bare;  // without weights, and without names
  for (const auto& row : sources) bare += csv("", {{row[0], row[1]}}).substr(1);
  write_file(folder / "bare.txt", bare);
  const std::string grid = "--grid=-2:3:51,-2:4:61 --normalise --json --out ";
  // Axes that mix make scattered targets of the nodes; others keep the grid.
  for (const std::string bandwidth : {"scott", "0.05,0,0,0.09", "0.3"}) {
    const Outcome sum = gaussdrift_in(folder, "sum --sources S.csv --bandwidth " + bandwidth + " " + grid + "V.csv");
    ASSERT_EQ(sum.exit_code, 0) << sum.err;
    const Table table = table_of(read_file(folder / "V.csv"));
    ASSERT_EQ(table.rows.size(), 51u * 61);
    double total = 0;
    for (const auto& row : table.rows) total += 0.1 * 0.1 * row[0];
    EXPECT_NEAR(total, 1, 1e-4) << bandwidth;
    const nlohmann::json told = parsed_json(sum.out);
    EXPECT_EQ(told["normalised"], true);
    EXPECT_EQ(told["bandwidth"], bandwidth);
    EXPECT_EQ(told["columns"], nlohmann::json::array({"density"}));
    EXPECT_TRUE(told["measured"].is_null() || told["measured"]["kept"] == true);
    EXPECT_EQ(told.contains("covariance"), bandwidth != "0.3");
    if (bandwidth == "0.3") continue;
    EXPECT_TRUE(told["sigma"].is_null());
    const Matrix matrix{told["covariance"][0][0], told["covariance"][0][1], told["covariance"][1][1]};
    const std::size_t i = 20 + 51 * 25;  // (0, 0.5)
    const double peak = 1 / (2 * std::numbers::pi * std::sqrt(matrix[0] * matrix[2] - matrix[1] * matrix[1]));
    EXPECT_NEAR(table.rows[i][0], mean_of_normals(sources, {0, 0.5}, matrix), 1.01e-6 * peak);
  }
  const Outcome one =
      gaussdrift_in(folder, "sum --sources S.csv --columns x,y --normalise --out A.npy --grid=0:1:5,0:1:4");
  const Outcome two =
      gaussdrift_in(folder, "sum --sources bare.txt --columns 1,2 --normalise --out B.npy --grid=0:1:5,0:1:4");
  EXPECT_EQ(two.exit_code, 0) << two.err;
  EXPECT_NE(one.out.find("covariance [["), std::string::npos) << one.out;
  EXPECT_NE(one.out.find("a density with the integral 1"), std::string::npos) << one.out;
  EXPECT_EQ(read_file(folder / "A.npy"), read_file(folder / "B.npy"));
  EXPECT_NE(read_file(folder / "A.npy").find("'shape': (5, 4), }"), std::string::npos);
}

TEST(SumOfADensity, HasDerivativesWhereTheGaussianIsRound) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", "x\n0\n2\n");
  const Outcome sum = gaussdrift_in(
      folder,
      "sum --sources S.csv --columns x --normalise --bandwidth 0.5 --derivative 0 --derivative 1 --grid=1:1.5:2");
  ASSERT_EQ(sum.exit_code, 0) << sum.err;
  const Table table = table_of(sum.out);
  EXPECT_EQ(table.header, "d_0,d_1");
  const auto normal = [](double x) { return std::exp(-2 * x * x) / (0.5 * std::sqrt(2 * std::numbers::pi)); };
  EXPECT_NEAR(table.rows[1][0], (normal(1.5) + normal(-0.5)) / 2, 1e-6);
  EXPECT_NEAR(table.rows[1][1], (-4 * 1.5 * normal(1.5) + 4 * 0.5 * normal(-0.5)) / 2, 1e-5);
  EXPECT_NEAR(table.rows[0][1], 0, 1e-14);
}

TEST(SumOfADensity, RefusesWhatHasNone) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv("x,y,weight", cloud(20)));
  write_file(folder / "line.csv", "x,y,weight\n0,0,1\n1,2,1\n2,4,1\n");
  write_file(folder / "minus.csv", "x,y,weight\n0,0,1\n1,2,-1\n2,3,3\n");
  struct Refusal {
    int exit_code;
    const char *arguments, *said;
  };
  for (const auto& [exit_code, arguments, said] : std::vector<Refusal>{
           {2, "S.csv --sigma 2 --bandwidth 2", "--sigma excludes --bandwidth"},
           {2, "S.csv --bandwidth isj", "\"isj\" is no number; write scott, silverman, a standard deviation"},
           {2, "S.csv --bandwidth 0", "--bandwidth 0: must be positive"},
           {2, "S.csv --bandwidth 1,2,3", "has 3 numbers; for 2 coordinates it has 1, or 4 for a covariance"},
           {2, "S.csv --bandwidth scott --derivative 1,0",
            "--derivative goes with --sigma, and with a --bandwidth that is"},
           {2, "S.csv --kernel log --normalise", "--normalise belongs to the kernel gauss, not to log"},
           {2, "S.csv --kernel log --bandwidth 1", "--bandwidth belongs to the kernel gauss, not to log"},
           {3, "S.csv --bandwidth 1,2,2,1", "the covariance of the Gaussians is not positive definite"},
           {3, "S.csv --bandwidth 1,2,3,9", "a matrix as bandwidth must be finite, symmetric and 2 x 2"},
           {3, "line.csv --normalise", "the points lie in fewer than 2 dimensions"},
           {3, "minus.csv --bandwidth scott",
            "weights of a density must not be negative; that of point 2 (counted from 1) is -1"},
           {3, "minus.csv --normalise --sigma 1",
            "weights of a density must not be negative; that of point 2 (counted from 1) is -1"},
           {3, "S.csv --normalise --grid=0:1:100000,0:1:100000", "1e+10 targets"}}) {
    const Outcome refused = gaussdrift_in(folder, std::string("sum --out V.csv --sources ") + arguments);
    EXPECT_EQ(refused.exit_code, exit_code) << arguments << refused.err;
    EXPECT_NE(refused.err.find(said), std::string::npos) << arguments << "\n" << refused.err;
    EXPECT_EQ(refused.err.find("fgtd:"), std::string::npos) << refused.err;
    EXPECT_FALSE(fs::exists(folder / "V.csv"));
  }
}

}  // namespace
}  // namespace gaussdrift
