// When a run warns of gaps between its blobs: where they are not known to be small.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "case_text.hpp"
#include "gaussdrift/accuracy.hpp"
#include "gaussdrift/read_case.hpp"

namespace gaussdrift {
namespace {

/// Two outputs, with neighbours 3 and 5 spacings apart. Blobs are 2 wide. 100 grid points are compared.
RunSummary stretched(double first_error, double last_error) {
  RunSummary summary;
  summary.grid_points = 100;
  summary.frames.resize(2);
  for (int k = 0; k < 2; ++k) {
    auto& [time, numbers] = summary.frames[static_cast<std::size_t>(k)];
    time = k;
    numbers.stretch = 3 + 2 * k;
    numbers.compared = summary.grid_points;
    numbers.error = ErrorNorms{.l1 = 0, .l2 = 0, .linf = k == 0 ? first_error : last_error};
  }
  return summary;
}

/// The time of the output that is said to have gaps, as "t = 1"; empty: none.
std::string gaps_at(const RunSummary& summary, std::optional<double> quadrature = std::nullopt) {
  const Case spec = parse_case(case_text(), "case.toml").spec;
  for (const std::string& warning : warnings_of(spec, summary, quadrature))
    if (warning.find("may have false gaps") != std::string::npos) return warning.substr(3, 5);
  return "";
}

TEST(WarningOfGaps, NamesTheFirstOutputThatMayHaveThem) {
  EXPECT_EQ(gaps_at(stretched(0.2, 0.2)), "t = 0");
  EXPECT_EQ(gaps_at(stretched(0.002, 0.2)), "t = 1");
  RunSummary close = stretched(0.2, 0.2);
  for (auto& [time, numbers] : close.frames) numbers.stretch = 2;
  EXPECT_EQ(gaps_at(close), "");
}

TEST(WarningOfGaps, IsNotGivenWhereTheErrorLeavesNoRoomForThem) {
  EXPECT_EQ(gaps_at(stretched(0.002, 0.003)), "");
  RunSummary sample = stretched(0.002, 0.003);
  sample.frames.back().second.compared = 10;
  EXPECT_EQ(gaps_at(sample), "t = 1") << "a sample may have missed them";
  RunSummary unknown = stretched(0.002, 0.003);
  unknown.frames.front().second.untraced = 1;
  EXPECT_EQ(gaps_at(unknown), "t = 0");
  unknown.frames.front().second.error.reset();
  EXPECT_EQ(gaps_at(unknown), "t = 0");
}

TEST(WarningOfGaps, AsksTheBudgetOfTheLastOutput) {
  EXPECT_EQ(gaps_at(stretched(0.002, 0.2), 1e-6), "") << "the error there has another cause";
  EXPECT_EQ(gaps_at(stretched(0.002, 0.2), 0.1), "t = 1");
  EXPECT_EQ(gaps_at(stretched(0.2, 0.2), 1e-6), "t = 0") << "the budget knows nothing of earlier outputs";
}

}  // namespace
}  // namespace gaussdrift
