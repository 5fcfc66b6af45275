// gaussdrift sum with an expression of the distance as its kernel.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "parsed_json.hpp"
#include "program/program.hpp"
#include "program/sum_tables.hpp"

namespace gaussdrift {
namespace {

/// sum_j q_j k(|x - x_j|), pairs at distance 0 counting `at_zero`.
double exact(const Rows& sources, const std::vector<double>& target, double (*kernel)(double r), double at_zero) {
  double sum = 0;
  for (const auto& source : sources) {
    double squared = 0;
    for (std::size_t l = 0; l + 1 < source.size(); ++l) squared += std::pow(source[l] - target[l], 2);
    sum += source.back() * (squared == 0 ? at_zero : kernel(std::sqrt(squared)));
  }
  return sum;
}

TEST(SumOfAnExpression, MatchesTheFormula) {
  const ScratchFolder folder;
  struct Case {
    std::string text;
    double (*kernel)(double r);
    double at_zero;
  };
  const std::vector<Case> cases{{"exp(-r)/r", [](double r) { return std::exp(-r) / r; }, 0},
                                {"r", [](double r) { return r; }, 0},
                                {"1/(1 + r^2)", [](double r) { return 1 / (1 + r * r); }, 1},
                                {"r^2*log(r)", [](double r) { return r * r * std::log(r); }, 0}};
  for (int d = 2; d <= 3; ++d) {
    const Rows sources = points(300, d + 1);
    write_file(folder / "S.csv", csv(headers[d], sources));
    for (const Case& one : cases) {
      const Outcome outcome = gaussdrift_in(folder, "sum --sources S.csv --kernel '" + one.text + "'");
      ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
      const Table table = table_of(outcome.out);
      EXPECT_EQ(table.header, "sum");
      ASSERT_EQ(table.rows.size(), sources.size());
      for (std::size_t i = 0; i < sources.size(); i += 37)
        EXPECT_NEAR(table.rows[i][0], exact(sources, sources[i], one.kernel, one.at_zero), 1e-10) << one.text;
    }
  }
}

TEST(SumOfAnExpression, KeepsItsPromiseByInterpolationAndTellsAboutIt) {
  const ScratchFolder folder;
  const Rows sources = points(4000, 3), targets = points(50, 2);
  write_file(folder / "S.csv", csv(headers[2], sources));
  write_file(folder / "T.csv", csv(target_headers[2], targets));
  const Outcome outcome = gaussdrift_in(
      folder, "sum --sources S.csv --kernel 'exp(-2*r)/r' --method interpolation --tolerance 1e-5 --out V.csv --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = parsed_json(outcome.out);
  EXPECT_EQ(json["kernel"], "exp(-2*r)/r");
  EXPECT_EQ(json["method"], "interpolation");
  EXPECT_EQ(json["columns"][0], "sum");
  EXPECT_LT(json["parameters"]["pairs"].get<double>(), 0.9 * 4000 * 4000);
  EXPECT_GT(json["parameters"]["levels"].size(), 1U);
  EXPECT_LE(json["measured"]["sum_error"].get<double>(), 1e-5);
  EXPECT_EQ(json["measured"]["kept"], true);
  const Outcome text = gaussdrift_in(
      folder, "sum --sources S.csv --targets T.csv --kernel 'exp(-2*r)/r' --method interpolation --out W.csv");
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("interpolation, "), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("; measured at 50 targets: "), std::string::npos) << text.out;
}

TEST(SumOfAnExpression, IsRefusedWithAPlaceAndARemedy) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv(headers[2], points(2000, 3)));
  write_file(folder / "L.csv", csv(headers[1], points(10, 2)));
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"--sources S.csv --kernel 'exp(-r'", "--kernel \"exp(-r\", at character"},
      {"--sources S.csv --kernel 'exp(-s)/r'", "--kernel \"exp(-s)/r\", at character 6"},
      {"--sources S.csv --kernel vortex", "it is no expression of r as \"exp(-r)/r\"; there are gauss, coulomb, log"},
      {"--sources S.csv --kernel inverse-vortex",
       "it is no expression of r as \"exp(-r)/r\"; there are gauss, coulomb, log"},
      {"--sources S.csv --kernel 1/r --sigma 2", "--sigma belongs to the kernel gauss, not to 1/r"},
      {"--sources S.csv --kernel 1/r --derivative 1,0",
       "--derivative belongs to gauss and to radial kernels, not to 1/r"},
      {"--sources S.csv --kernel 1/r --p 9", "belong to the method hermite of the kernel gauss, not to 1/r"},
      {"--sources S.csv --kernel 1/r --method tree", "there are auto, direct, interpolation"},
      {"--sources S.csv --kernel 1/r --tolerance 1e-12", "--tolerance 1e-12, must lie in [1e-10, 1)"},
      {"--sources S.csv --kernel 1/r --method direct --seconds 1e-9", "direct would take"},
      {"--sources L.csv --kernel 1/r", "an expression is for points in 2 or 3 dimensions, the sources have 1 (x)"},
      {"--sources S.csv --kernel '1/(r - r)' --method direct",
       "the kernel \"1/(r - r)\" is infinite or not defined at some distance"},
      {"--sources S.csv --kernel 'cos(900*r)' --method interpolation", "the kernel is not smooth enough"}};
  for (const auto& [arguments, message] : wrong) {
    const Outcome outcome = gaussdrift_in(folder, "sum --out V.csv " + arguments);
    EXPECT_NE(outcome.exit_code, 0) << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << arguments << "\n" << outcome.err;
    for (const char* internal : {"farfield:", "rbf:", "Options"})
      EXPECT_EQ(outcome.err.find(internal), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace gaussdrift
