// gaussdrift fit: a table of scattered values becomes a grid.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "parsed_json.hpp"
#include "program.hpp"

namespace gaussdrift {
namespace {

/// exp(-r^2/0.04) about the middle of the unit square (cube), at random points.
std::string cloud(int dimension, int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::string text = dimension == 2 ? "x,y,rho\n" : "rho,x,y,z\n";
  for (int i = 0; i < count; ++i) {
    double square = 0;
    std::string places;
    for (int k = 0; k < dimension; ++k) {
      const double x = coordinate(random);
      square += (x - 0.5) * (x - 0.5);
      places += (k > 0 ? "," : "") + std::to_string(x);
    }
    const std::string rho = std::to_string(std::exp(-square / 0.04));
    text += (dimension == 2 ? places + "," + rho : rho + "," + places) + "\n";
  }
  return text;
}

TEST(Fit, OfAGaussianHasItsIntegralAndTellsItsError) {
  const ScratchFolder folder;
  write_file(folder / "cloud.csv", cloud(2, 600));
  const Outcome outcome = gaussdrift_in(folder, "fit cloud.csv --kernel matern52 --grid 50 --out field.vti --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto told = parsed_json(outcome.out);
  const double exact = std::numbers::pi * 0.04 * std::pow(std::erf(0.5 / 0.2), 2);
  EXPECT_NEAR(told["integral"].get<double>(), exact, 1e-3 * exact);  // the box of the data is a little smaller
  EXPECT_GT(told["left_out_error"], 1e-7);
  EXPECT_LT(told["left_out_error"], 1e-3);
  const std::string file = read_file(folder / "field.vti");
  for (const char* array : {"\"rho\"", "\"gradient\" NumberOfComponents=\"3\"", "\"error\""})
    EXPECT_NE(file.find(std::string("Name=") + array), std::string::npos) << array;
}

TEST(Fit, HasTheMostLikelyShapeIfAsked) {
  const ScratchFolder folder;
  write_file(folder / "cloud.csv", cloud(2, 200));
  const std::string fit = "fit cloud.csv --kernel matern52 --grid 5 --out field.vti --json --shape-by ";
  const auto left_out = parsed_json(gaussdrift_in(folder, fit + "left-out").out),
             likely = parsed_json(gaussdrift_in(folder, fit + "likelihood").out);
  EXPECT_GE(likely["log_likelihood"].get<double>(), left_out["log_likelihood"].get<double>());
  EXPECT_LE(left_out["left_out_error"].get<double>(), likely["left_out_error"].get<double>());
  EXPECT_EQ(gaussdrift_in(folder, fit + "luck").exit_code, 2);
  EXPECT_EQ(gaussdrift_in(folder, fit + "likelihood --shape 0.1").exit_code, 2);
  EXPECT_EQ(gaussdrift_in(folder, "fit cloud.csv --shape-by likelihood --out f.vti").exit_code, 2);  // thin-plate
}

TEST(Fit, OfATableInSpaceWithItsColumnsInAnyOrder) {
  const ScratchFolder folder;
  write_file(folder / "cloud.csv", cloud(3, 400));
  const Outcome outcome = gaussdrift_in(folder, "fit cloud.csv --grid 12 --out field.vti");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("thin-plate to 400 points"), std::string::npos) << outcome.out;
}

TEST(Fit, RefusesWithTheRemedy) {
  const ScratchFolder folder;
  write_file(folder / "twice.csv", "x,y,rho\n0,0,1\n1,0,2\n0,1,3\n1,0,2\n");
  const Outcome twice = gaussdrift_in(folder, "fit twice.csv --out f.vti");
  EXPECT_EQ(twice.exit_code, 3);
  EXPECT_NE(twice.err.find("twice.csv"), std::string::npos) << twice.err;
  EXPECT_NE(twice.err.find("regularisation"), std::string::npos) << twice.err;
  EXPECT_EQ(
      gaussdrift_in(folder, "fit twice.csv --regularisation 1e-3 --kernel matern32 --shape 1 --grid 5 --out f.vti")
          .exit_code,
      0);
  const Outcome name = gaussdrift_in(folder, "fit twice.csv --kernel multiquadrik --out f.vti");
  EXPECT_EQ(name.exit_code, 2);
  EXPECT_NE(name.err.find("\"multiquadric\""), std::string::npos) << name.err;
  EXPECT_EQ(gaussdrift_in(folder, "fit twice.csv --out f.csv").exit_code, 2);
  EXPECT_EQ(gaussdrift_in(folder, "fit twice.csv --value u --out f.vti").exit_code, 3);
  EXPECT_EQ(gaussdrift_in(folder, "fit none.csv --out f.vti").exit_code, 6);
}

}  // namespace
}  // namespace gaussdrift
