// Tables 3.2 to 3.5 and 4.1 to 4.8 of the thesis: errors of the printed power of ten or better, and the promise of
// automatic beside them. Rows are limited to 20 000 points; `gaussdrift reproduce fgtd --full` takes them all.
#include "study/reproduce_fgtd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "study/point_sets.hpp"

namespace gaussdrift::study {
namespace {

using Cells = std::vector<std::vector<std::string>>;

// A table as printed, without its header.
Cells read_table(const std::string& number) {
  std::ifstream in(std::string(REFERENCE_DIR) + "/schroeder-table-" + number + ".csv");
  Cells rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::vector<std::string>& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  if (!rows.empty()) rows.erase(rows.begin());
  return rows;
}

Table reduced(const std::string& number) {
  FgtdOptions options;
  if (number[0] == '6') options.set = TableSet::divergence;
  options.table = number;
  options.most_points = 20000;
  options.most_pairs = 1e7;
  options.most_terms = 1e9;
  const FgtdReproduction result = reproduce_fgtd(options);
  EXPECT_EQ(result.tables.size(), 1u) << number;
  EXPECT_TRUE(result.disagreements.empty()) << number << ": " << result.disagreements.front();
  return result.tables.at(0);
}

class EveryTable : public testing::TestWithParam<std::string> {};

TEST_P(EveryTable, QuotesThePaperAndIsAsGoodOrBetter) {
  const Table table = reduced(GetParam());
  const Cells printed = read_table(GetParam());
  const double unit = GetParam() == "3.5" ? 1e4 : 1;  // hundredths of a second as microseconds
  EXPECT_FALSE(table.what.empty());
  ASSERT_FALSE(table.rows.empty());
  ASSERT_LE(table.rows.size(), printed.size());
  std::size_t numbers = 0;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const Row& row = table.rows[r];
    ASSERT_EQ(row.entries.size(), table.columns.size()) << row.name;
    for (std::size_t i = 0; i < row.entries.size(); ++i) {
      const Entry& entry = row.entries[i];
      EXPECT_TRUE(agrees(table.columns[i], entry)) << row.name << ", " << table.columns[i].name;
      if (table.columns[i].quantity == Quantity::seconds && entry.computed) {
        EXPECT_GT(*entry.computed, 0);
      }
      if (!entry.published || !entry.computed) continue;
      ++numbers;
      EXPECT_TRUE(std::any_of(printed[r].begin() + 1, printed[r].end(),
                              [&](const std::string& cell) {
                                return *entry.published ==
                                       (cell == "-" ? std::numeric_limits<double>::infinity() : unit * std::stod(cell));
                              }))
          << row.name << ", " << table.columns[i].name << ": " << *entry.published << " is not in this row as printed";
    }
  }
  EXPECT_GT(numbers, GetParam() == "6.2" ? 3u : 10u);  // 6.2 has one row of so few sources
}

INSTANTIATE_TEST_SUITE_P(ReproduceFgtd, EveryTable, testing::ValuesIn(table_numbers(TableSet::fgtd)));
INSTANTIATE_TEST_SUITE_P(ReproduceDivergence, EveryTable, testing::ValuesIn(table_numbers(TableSet::divergence)));

TEST(ReproduceDivergence, FindsNoDivergenceBeyondRounding) {
  const Table table = reduced("6.2");
  ASSERT_EQ(table.rows.size(), 1u);  // of 10 000 sources
  const std::vector<Entry>& entries = table.rows[0].entries;
  EXPECT_EQ(*entries[3].computed, 0.0);    // as printed: the same number twice
  EXPECT_LE(*entries[4].computed, 1e-13);  // relative to the terms: rounding of sums of 10 000
  EXPECT_LE(*entries[5].computed, 1e-13);
}

TEST(ReproduceFgtd, GivesAllDigitsOfTable48WhereThePointsAreKnown) {
  const Table table = reduced("4.8");
  for (const std::size_t row : {0u, 2u})  // Halton points and grid; the others are random
    for (const std::size_t column : {1u, 3u, 4u}) {
      const Entry& entry = table.rows[row].entries[column];
      EXPECT_NEAR(*entry.computed, *entry.published, 1e-6) << table.rows[row].name << column;  // printed to 1e-6
    }
  EXPECT_NEAR(*table.rows[0].entries[2].computed, 1.44e-11, 1e-13);  // three digits, and rounding of the sums
  EXPECT_NEAR(*table.rows[2].entries[2].computed, 3.07e-10, 1e-12);
}

TEST(ReproduceFgtd, ShowsTheBlowUpOfLargeBoxesAndThatAutomaticHasNone) {
  const Table table = reduced("4.6");
  ASSERT_EQ(table.rows.size(), 9u);
  for (const std::size_t row : {0u, 1u, 2u}) {  // sigma = 1e4, 1e3, 1e2: r = 17.7, 5.6, 1.8
    const std::vector<Entry>& entries = table.rows[row].entries;
    EXPECT_NE(table.rows[row].note.find("no bound"), std::string::npos) << table.rows[row].note;
    EXPECT_LE(std::abs(power_of_ten(*entries[2].computed) - power_of_ten(*entries[2].published)), 1);
    const double promise = *entries[3].computed, largest = *entries[4].computed;
    EXPECT_LE(*entries[2].automatic, promise);
    EXPECT_LE(promise, 1e-3 * largest) << "a promise that says something";
  }
  EXPECT_GT(*table.rows[0].entries[2].computed, 1e27);  // printed 1e28
  EXPECT_LE(*table.rows[0].entries[2].automatic, 1e-7 * *table.rows[0].entries[4].computed);
}

TEST(ReproduceFgtd, DoesNotAgreeWithWhatIsWorse) {
  const Column error{"error", Quantity::error}, bound{"bound", Quantity::bound}, count{"count", Quantity::count};
  const auto entry = [](double published, double computed) { return Entry{published, computed, {}, true}; };
  EXPECT_TRUE(agrees(error, entry(1e-6, 9e-6)));
  EXPECT_TRUE(agrees(error, entry(1e-6, 0)));
  EXPECT_FALSE(agrees(error, entry(1e-6, 2e-5)));
  EXPECT_FALSE(agrees(error, entry(1e-6, std::nan(""))));
  EXPECT_FALSE(agrees(error, entry(1e28, std::numeric_limits<double>::infinity())));
  EXPECT_FALSE(agrees(error, Entry{1e-6, 1e-6, 1e-3, false}));  // a broken promise
  EXPECT_FALSE(agrees(bound, entry(1e-6, 1e-8)));
  EXPECT_FALSE(agrees(count, entry(1614, 1615)));
}

TEST(ReproduceFgtd, RefusesATableThatThereIsNot) {
  FgtdOptions options;
  options.table = "4.9";
  EXPECT_THROW(reproduce_fgtd(options), CommandLineError);
}

TEST(PointSets, AreInTheUnitCubeAndAsDefined) {
  EXPECT_EQ(halton(0, 2), 0.0);
  EXPECT_EQ(halton(6, 2), 0.375);               // 110 in base 2 reads 0.011
  EXPECT_NEAR(halton(5, 3), 7.0 / 9.0, 1e-15);  // 12 in base 3 reads 0.21; rounding
  for (const fgtd::Points<3>& points : {halton_points<3>(500), random_points<3>(500, 1),
                                        clustered_points<3>(500, 5, 0.1, 1), grid_points<3>(8, 1.0 / 8)}) {
    EXPECT_GE(points.minCoeff(), 0.0);
    EXPECT_LT(points.maxCoeff(), 1.0);
  }
  EXPECT_EQ(random_points<3>(10, 7), random_points<3>(10, 7));
  EXPECT_NE(random_points<3>(10, 7), random_points<3>(10, 8));
  EXPECT_EQ(grid_points<2>(3, 0.5).col(5), Eigen::Vector2d(1.0, 0.5));
}

}  // namespace
}  // namespace gaussdrift::study
