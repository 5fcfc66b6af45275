// gaussdrift sum with a radial kernel of the library rbf.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "parsed_json.hpp"
#include "program/program.hpp"
#include "program/sum_tables.hpp"

namespace gaussdrift {
namespace {

using Real = long double;

/// phi(r), and phi'(r) / r with its limit at 0. Shape 0.3, by the formulas of docs/rbf.md.
struct Radial {
  Real (*value)(Real r);
  Real (*slope)(Real r);
};
constexpr Real c = 0.3L;
const Real k3 = std::sqrt(3.0L) / c, k5 = std::sqrt(5.0L) / c;
const std::map<std::string, Radial> kernels{
    {"gaussian",
     {[](Real r) { return std::exp(-r * r / (c * c)); },
      [](Real r) { return -2 / (c * c) * std::exp(-r * r / (c * c)); }}},
    {"multiquadric",
     {[](Real r) { return std::sqrt(r * r + c * c); }, [](Real r) { return 1 / std::sqrt(r * r + c * c); }}},
    {"inverse-multiquadric",
     {[](Real r) { return 1 / std::sqrt(r * r + c * c); },
      [](Real r) { return -1 / (std::sqrt(r * r + c * c) * (r * r + c * c)); }}},
    {"inverse-quadratic",
     {[](Real r) { return 1 / (r * r + c * c); }, [](Real r) { return -2 / ((r * r + c * c) * (r * r + c * c)); }}},
    {"thin-plate",
     {[](Real r) { return r > 0 ? r * r * std::log(r) : 0; }, [](Real r) { return r > 0 ? 2 * std::log(r) + 1 : 0; }}},
    {"matern32",
     {[](Real r) { return (1 + k3 * r) * std::exp(-k3 * r); }, [](Real r) { return -k3 * k3 * std::exp(-k3 * r); }}},
    {"matern52",
     {[](Real r) { return (1 + k5 * r + k5 * k5 * r * r / 3) * std::exp(-k5 * r); },
      [](Real r) { return -k5 * k5 / 3 * (1 + k5 * r) * std::exp(-k5 * r); }}}};

std::string shape_of(const std::string& kernel) { return kernel == "thin-plate" ? "" : " --shape 0.3"; }

/// The sum and its derivative along x.
std::pair<Real, Real> exact(const Rows& sources, const std::vector<double>& target, const Radial& kernel) {
  std::pair<Real, Real> sums;
  for (const auto& source : sources) {
    Real squared = 0;
    for (std::size_t l = 0; l + 1 < source.size(); ++l) {
      const Real along = Real(target[l]) - source[l];
      squared += along * along;
    }
    const Real r = std::sqrt(squared);
    sums.first += source.back() * kernel.value(r);
    sums.second += source.back() * (Real(target[0]) - source[0]) * kernel.slope(r);
  }
  return sums;
}

/// max |phi| and max |phi'| on [0, range], from samples.
std::pair<Real, Real> largest(const Radial& kernel, Real range) {
  std::pair<Real, Real> most;
  for (int i = 0; i <= 20000; ++i) {
    const Real r = range * i / 20000;
    most.first = std::max(most.first, std::abs(kernel.value(r)));
    most.second = std::max(most.second, std::abs(r * kernel.slope(r)));
  }
  return most;
}

Real weight_total(const Rows& sources) {
  Real total = 0;
  for (const auto& source : sources) total += std::abs(source.back());
  return total;
}

TEST(SumOfRadialKernels, MatchesTheFormulasInOneToThreeDimensions) {
  const ScratchFolder folder;
  for (int d = 1; d <= 3; ++d) {
    const Rows sources = points(400, d + 1), targets = points(60, d);
    write_file(folder / "S.csv", csv(headers[d], sources));
    write_file(folder / "T.csv", csv(target_headers[d], targets));
    const std::string zeros = d == 1 ? "" : d == 2 ? ",0" : ",0,0";
    for (const auto& [name, kernel] : kernels)
      for (const char* method : {"direct", "gaussians"}) {
        const Outcome outcome =
            gaussdrift_in(folder, "sum --sources S.csv --targets T.csv --tolerance 1e-7 --kernel " + name +
                                      shape_of(name) + " --derivative 0" + zeros + " --derivative 1" + zeros +
                                      " --json --out V.csv --method " + method);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        const auto json = parsed_json(outcome.out);
        EXPECT_EQ(json["kernel"], name);
        EXPECT_EQ(json["method"], method) << name;
        EXPECT_EQ(json["shape"].is_null(), name == "thin-plate");
        const Table table = table_of(read_file(folder / "V.csv"));
        ASSERT_EQ(table.rows.size(), targets.size());
        const auto [value, slope] = largest(kernel, json["range"].get<double>());
        // The promise; all pairs have rounding alone.
        const Real allowed = (std::string(method) == "direct" ? 1e-13L : 1e-7L) * weight_total(sources);
        for (std::size_t i = 0; i < targets.size(); ++i) {
          const auto right = exact(sources, targets[i], kernel);
          EXPECT_LE(std::abs(table.rows[i][0] - right.first), allowed * value) << name << d << method;
          EXPECT_LE(std::abs(table.rows[i][1] - right.second), allowed * slope) << name << d << method;
        }
      }
  }
}

TEST(SumOfRadialKernels, CountsAPairAtDistanceZeroAndRunsOverGrids) {
  const ScratchFolder folder;
  const Rows sources{{0.25, 0.5, 2}, {1, 0.5, -1}};
  write_file(folder / "S.csv", csv(headers[2], sources));
  for (const auto& [name, kernel] : kernels) {
    const Outcome outcome = gaussdrift_in(folder, "sum --sources S.csv --kernel " + name + shape_of(name));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Table table = table_of(outcome.out);
    EXPECT_EQ(table.header, "d_0_0");
    ASSERT_EQ(table.rows.size(), 2U);
    const Real at_zero = kernel.value(0), apart = kernel.value(0.75L);
    EXPECT_NEAR(table.rows[0][0], static_cast<double>(2 * at_zero - apart), 1e-14) << name;  // rounding
    EXPECT_NEAR(table.rows[1][0], static_cast<double>(2 * apart - at_zero), 1e-14) << name;
    const Table grid = table_of(
        gaussdrift_in(folder, "sum --sources S.csv --grid=-1:1:5,0:3:4 --kernel " + name + shape_of(name)).out);
    ASSERT_EQ(grid.rows.size(), 20U);
    for (int j = 0, row = 0; j < 4; ++j)  // a grid beyond the sources has its range
      for (int i = 0; i < 5; ++i, ++row)
        EXPECT_NEAR(grid.rows[row][0], static_cast<double>(exact(sources, {-1 + 0.5 * i, 1.0 * j}, kernel).first),
                    1e-13 * 30)  // rounding of 3^2 ln 3 and the like
            << name;
  }
}

TEST(SumOfRadialKernels, TellsWhatWasChosen) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv(headers[2], points(3000, 3)));
  const std::string call =
      "sum --sources S.csv --kernel matern52 --shape 0.3 --derivative 2,0 --derivative 0,0 --method gaussians "
      "--tolerance 1e-5 --out ";
  const Outcome outcome = gaussdrift_in(folder, call + "V.csv --json --threads 1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = parsed_json(outcome.out);
  EXPECT_EQ(json["columns"], nlohmann::json::array({"d_2_0", "d_0_0"}));
  EXPECT_EQ(json["sources"], 3000);
  EXPECT_LE(json["bound"].get<double>(), 1e-5);
  EXPECT_GE(json["parameters"]["terms"].size(), 2U);
  EXPECT_LE(json["parameters"]["kernel_error"].get<double>(), 0.5e-5);
  EXPECT_EQ(json["measured"]["targets"], 200);
  EXPECT_EQ(json["measured"]["kept"], true);
  for (const char* column : {"d_2_0", "d_0_0"}) EXPECT_LE(json["measured"]["errors"][column].get<double>(), 1e-5);
  const std::string one = read_file(folder / "V.csv");
  const Outcome text = gaussdrift_in(folder, call + "W.csv --threads 3");
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("method matern52 of shape 0.3 by gaussians: 3000 centres"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("; measured at 200 targets: d_2_0 "), std::string::npos) << text.out;
  EXPECT_EQ(read_file(folder / "W.csv"), one) << "the same bits on any number of threads";
}

TEST(SumOfRadialKernels, IsRefusedWithARemedy) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv(headers[2], points(2000, 3)));
  write_file(folder / "S4.csv", csv(headers[4], points(10, 5)));
  write_file(folder / "wide.csv", "x,y,weight\n0,0,1\n1e80,0,1\n");
  write_file(folder / "heavy.csv", "x,y,weight\n0,0,1e308\n1,0,1e308\n");
  struct Wrong {
    const char* arguments;
    int exit_code;
    const char* said;
  };
  const std::vector<Wrong> wrong{
      {"S.csv --kernel multiquadric", 2, "--shape is missing: multiquadric is sqrt(r^2 + c^2), and c is the shape"},
      {"S.csv --kernel multiquadric --shape 0", 2, "--shape 0: must be positive"},
      {"S.csv --kernel multiquadric --shape nan", 2, "--shape nan: must be positive"},
      {"S.csv --kernel multiquadric --shape 1e-80", 2, "--shape 1e-80, must lie in"},
      {"S.csv --kernel thin-plate --shape 0.3", 2, "--shape: thin-plate takes none; leave it out"},
      {"S.csv --kernel gauss --sigma 2 --shape 0.3", 2, "--shape belongs to the radial kernels (gaussian, "},
      {"S.csv --kernel 1/r --shape 0.3", 2, "matern52), not to 1/r"},
      {"S.csv --kernel matern32 --sigma 2 --shape 1", 2,
       "--sigma belongs to the kernel gauss, not to matern32, which takes --shape"},
      {"S.csv --kernel thin-plate --sigma 2", 2, "--sigma belongs to the kernel gauss, not to thin-plate\n"},
      {"S.csv --kernel thin-plate --p 9", 2, "the method hermite of the kernel gauss, not to thin-plate"},
      {"S.csv --kernel multiquadratic --shape 1", 2, "there is no \"multiquadratic\", is \"multiquadric\" meant?"},
      {"S.csv --kernel thin-plate --method hermite", 2, "there are auto, direct, gaussians"},
      {"S.csv --kernel thin-plate --tolerance 1", 2, "--tolerance 1: must lie in (0, 1)"},
      {"S.csv --kernel thin-plate --derivative 1,1", 2,
       "at most 1 is possible for thin-plate, whose higher derivatives are infinite at distance 0"},
      {"S.csv --kernel gaussian --shape 1 --derivative 3,0", 2, "--kernel gauss with --sigma 1/shape^2"},
      {"S.csv --kernel matern52 --shape 1 --derivative 3,0", 2, "at most 2 is possible for matern52\n"},
      {"S.csv --kernel thin-plate --derivative 1", 2, "has 1 number, but the sources have 2 (x, y)"},
      {"S.csv --kernel thin-plate --grid=0:1:3", 2, "--grid has 1 axis, but"},
      {"S4.csv --kernel thin-plate", 2, "is for points in 1 to 3 dimensions, the sources have 4 (x, y, z, w)"},
      {"S.csv --kernel thin-plate --method gaussians --tolerance 1e-12", 3,
       "--tolerance 1e-12 cannot be promised by gaussians, must be at least 1e-11; use --method auto or direct"},
      {"S.csv --kernel thin-plate --method direct --seconds 1e-9", 3, "direct would take about "},
      {"S.csv --kernel thin-plate --method gaussians --seconds 1e-9", 3, "gaussians would take about "},
      {"S.csv --kernel thin-plate --seconds 1e-9", 3, " would take about "},
      {"S.csv --kernel thin-plate --grid=0:1:100000,0:1:100000", 3, "1e+10 targets with 1 value would take 80 GB"},
      {"wide.csv --kernel thin-plate", 3, "apart, must be 1e-75 to 1e75; take another unit of length"},
      {"heavy.csv --kernel inverse-quadratic --shape 0.1", 4, "d_0_0 at target 1 (counted from 1) is inf"}};
  for (const Wrong& one : wrong) {
    const Outcome outcome = gaussdrift_in(folder, std::string("sum --out V.csv --sources ") + one.arguments);
    EXPECT_EQ(outcome.exit_code, one.exit_code) << one.arguments << outcome.err;
    EXPECT_NE(outcome.err.find(one.said), std::string::npos) << one.arguments << "\n" << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "V.csv")) << one.arguments;
    for (const char* internal : {"rbf:", "fgtd:", "Options", "::"})
      EXPECT_EQ(outcome.err.find(internal), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace gaussdrift
