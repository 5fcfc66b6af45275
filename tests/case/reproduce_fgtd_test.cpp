// Tables 3.2 to 3.5, 4.1 to 4.9, 6.1 and 6.2 of the thesis: every printed number stands in the cell where it is
// printed, the computed one beside it agrees as its comparison says, and automatic keeps its promise. Rows are limited
// to 20 000 points; `gaussdrift reproduce fgtd --full` takes them all.
#include "parsed_json.hpp"
#include "reproduce/fgtd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "gaussdrift/error.hpp"
#include "reproduce/point_sets.hpp"

namespace gaussdrift::reproduce {
namespace {

// A table as printed: its columns, then row by row its cells.
struct Printed {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

Printed read_table(const std::string& number) {
  std::ifstream in(std::string(REFERENCE_DIR) + "/schroeder-table-" + number + ".csv");
  Printed table;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::vector<std::string>& row = table.columns.empty() ? table.columns : table.rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  return table;
}

double value_of(const std::string& cell) {
  return cell == "-" ? std::numeric_limits<double>::infinity() : std::stod(cell);
}

// Which printed column a column of ours shows.
std::map<std::string, std::string> printed_columns(const std::string& number) {
  std::map<std::string, std::string> names;
  if (number[0] == '3')
    for (int p = 5; p <= 12; ++p) names["p=" + std::to_string(p)] = "p" + std::to_string(p);
  for (const auto& [ours, printed] :
       {std::pair<std::string, std::string>{"p=8 nu=2", "p8nu2"}, {"p=9 nu=3", "p9nu3"}}) {
    if (number == "4.1")
      for (const std::string what : {"bound", "absolute", "relative"}) names[ours + " " + what] = printed + "_" + what;
    if (number == "4.2") names[ours + " seconds"] = "seconds_" + printed;
    if (number == "4.2") names[ours + " times faster"] = "speedup_" + printed;
    if (number == "4.3")
      for (const std::string what : {"prepare", "evaluate"}) names[what + " " + ours] = what + "_" + printed;
  }
  if (number == "4.2") names["direct"] = "seconds_brute_force";
  if (number == "4.4")
    for (const std::string p : {"8", "9"})
      for (const std::string nu : {"2", "3", "4"}) {
        names["p=" + p + " nu=" + nu + " measured"] = "p" + p + "nu" + nu + "_numerical";
        names["p=" + p + " nu=" + nu + " cost"] = "p" + p + "nu" + nu + "_analytical";
      }
  if (number == "4.5")
    names = {{"direct seconds", "seconds_brute_force"},
             {"millions of pairs", "mflops_brute_force"},
             {"seconds", "seconds_fgtd"},
             {"millions of terms", "mflops_fgtd"}};
  if (number == "4.6") names = {{"n = 0", "n0"}, {"n = 1", "n1"}, {"n >= 2", "n2_or_more"}};
  if (number == "4.7")
    for (const std::string n : {"100", "200", "300"})
      for (const std::string what : {"nu", "error"}) names["n_g=" + n + " " + what] = "ng" + n + "_" + what;
  if (number == "4.8")
    names = {{"sigma=0.01 n=0", "sigma0.01_nu1_n0"},     {"sigma=1 n=0", "sigma1_nu3_n0"},
             {"sigma=1 n=all", "sigma1_nu3_n1_or_more"}, {"sigma=100 n=0", "sigma100_nu29_n0"},
             {"sigma=100 n=3", "sigma100_nu29_n3"},      {"sigma=100 n=all", "sigma100_nu29_n14_or_more"}};
  if (number == "4.9") names = {{"seconds", "seconds"}, {"relative error", "error"}};
  if (number == "6.1")
    names = {{"pairs seconds", "seconds_brute_force"},
             {"fgtd seconds", "seconds_fgtd"},
             {"absolute", "absolute_error"},
             {"relative", "relative_error"},
             {"times faster", "speedup"}};
  if (number == "6.2")
    names = {{"pairs seconds", "seconds_brute_force"},
             {"pairs", "divergence_brute_force"},
             {"fgtd seconds", "seconds_fgtd"},
             {"fgtd", "divergence_fgtd"}};
  return names;
}

// "N = 200" and "200", "sigma = 0.1" and "0.1000", "halton" and "halton"
bool same_row(const std::string& ours, const std::string& printed) {
  const std::string last = ours.substr(ours.find_last_of(' ') + 1);
  return last == printed ||
         (std::isdigit(last[0]) && std::isdigit(printed[0]) && std::stod(last) == std::stod(printed));
}

Table reduced(const std::string& number) {
  FgtdOptions options;
  if (number[0] == '6') options.set = TableSet::divergence;
  options.table = number;
  options.most_points = 20000;
  options.most_pairs = 1e7;
  options.most_terms = number == "4.8" ? 2e9 : 1e9;  // all targets where digits are printed
  const FgtdReproduction result = reproduce_fgtd(options);
  EXPECT_EQ(result.tables.size(), 1u) << number;
  EXPECT_TRUE(result.disagreements.empty()) << number << ": " << result.disagreements.front();
  return result.tables.at(0);
}

class EveryTable : public testing::TestWithParam<std::string> {};

TEST_P(EveryTable, QuotesEveryPrintedNumberInItsCellAndAgrees) {
  const Table table = reduced(GetParam());
  const Printed printed = read_table(GetParam());
  const auto names = printed_columns(GetParam());
  const double unit = GetParam() == "3.5" ? 1e4 : 1;  // hundredths of a second as microseconds
  EXPECT_FALSE(table.what.empty());
  ASSERT_FALSE(table.rows.empty());

  // No printed column is left out; sigma of Table 4.7 has a test of its own.
  std::set<std::string> shown;
  for (const Column& column : table.columns)
    if (names.count(column.name)) shown.insert(names.at(column.name));
  for (std::size_t c = 1; c < printed.columns.size(); ++c) {
    if (printed.columns[c].find("_sigma") == std::string::npos) {
      EXPECT_TRUE(shown.count(printed.columns[c])) << printed.columns[c];
    }
  }

  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const Row& row = table.rows[r];
    ASSERT_EQ(row.entries.size(), table.columns.size()) << row.name;
    const auto there = std::find_if(printed.rows.begin(), printed.rows.end(),
                                    [&](const auto& cells) { return same_row(row.name, cells[0]); });
    ASSERT_NE(there, printed.rows.end()) << row.name;
    for (std::size_t i = 0; i < row.entries.size(); ++i) {
      const Column& column = table.columns[i];
      const Entry& entry = row.entries[i];
      EXPECT_TRUE(agrees(column, entry)) << row.name << ", " << column.name;
      if (column.quantity == Quantity::seconds && entry.computed) {
        EXPECT_GT(*entry.computed, 0);
      }
      const auto name = names.find(column.name);
      ASSERT_EQ(entry.published.has_value(), name != names.end()) << row.name << ", " << column.name;
      if (name == names.end()) continue;
      const auto place = std::find(printed.columns.begin(), printed.columns.end(), name->second);
      ASSERT_NE(place, printed.columns.end()) << name->second;
      EXPECT_EQ(*entry.published, unit * value_of((*there)[static_cast<std::size_t>(place - printed.columns.begin())]))
          << row.name << ", " << column.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ReproduceFgtd, EveryTable, testing::ValuesIn(table_numbers(TableSet::fgtd)));
INSTANTIATE_TEST_SUITE_P(ReproduceDivergence, EveryTable, testing::ValuesIn(table_numbers(TableSet::divergence)));

TEST(ReproduceFgtd, TakesTheWidthsOfTable47) {
  const Printed printed = read_table("4.7");
  for (const auto& row : printed.rows)
    for (std::size_t c = 1; c < row.size(); c += 3) {
      const double spacing = 1 / (std::stod(printed.columns[c].substr(2)) - 1), overlap = std::stod(row[0]);
      const double sigma = 1 / std::pow(overlap * spacing, 2);
      EXPECT_NEAR(std::stod(row[c]), sigma, std::max(0.005, 3e-6 * sigma)) << printed.columns[c];  // six digits printed
    }
}

// The 0 of the thesis is that of one plan, which cannot give anything else. Differences of the field know nothing of
// that.
TEST(ReproduceDivergence, FindsNoneInTheTruncatedFieldButInPartsOfSeparatePlans) {
  const Table table = reduced("6.2");
  ASSERT_EQ(table.rows.size(), 1u);  // of 10 000 sources
  std::map<std::string, double> now;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (table.rows[0].entries[i].computed) now[table.columns[i].name] = *table.rows[0].entries[i].computed;
  EXPECT_GT(now.at("error"), 1e-8);  // hermite is truncated: d_1 S_1 is wrong by 4.5e-8 of the terms
  EXPECT_LT(now.at("error"), 1e-7);
  EXPECT_LE(now.at("pairs differences"), 1e-10);                 // 2e-11: rounding of S over h
  EXPECT_LE(now.at("fgtd differences"), 1e-11);                  // 8e-13, a thousandth of what was truncated
  EXPECT_GT(now.at("apart"), 100 * now.at("fgtd differences"));  // errors of separate plans do not cancel
}

TEST(ReproduceFgtd, GivesAllDigitsOfTable48WhereThePointsAreKnown) {
  const Table table = reduced("4.8");
  for (const std::size_t row : {0u, 2u})  // Halton points and grid; the others are random
    for (const std::size_t column : {1u, 2u, 3u, 4u}) {
      const Entry& entry = table.rows[row].entries[column];
      EXPECT_EQ(comparison_of(table.columns[column], entry), Comparison::digits);
      EXPECT_NEAR(*entry.computed, *entry.published, 0.5001 * entry.last_digit) << table.rows[row].name << column;
    }
  EXPECT_NEAR(table.rows[0].entries[1].last_digit, 1e-6, 1e-15);   // 0.955033; rounding
  EXPECT_NEAR(table.rows[0].entries[2].last_digit, 1e-13, 1e-22);  // 1.44e-11
}

TEST(ReproduceFgtd, ShowsTheBlowUpOfLargeBoxesAndThatAutomaticHasNone) {
  const Table table = reduced("4.6");
  ASSERT_EQ(table.rows.size(), 9u);
  for (const std::size_t row : {0u, 1u, 2u}) {  // sigma = 1e4, 1e3, 1e2: r = 17.7, 5.6, 1.8
    const std::vector<Entry>& entries = table.rows[row].entries;
    EXPECT_NE(table.rows[row].note.find("no bound"), std::string::npos) << table.rows[row].note;
    const double promise = *entries[3].computed, largest = *entries[4].computed;
    EXPECT_LE(*entries[2].automatic, promise);
    EXPECT_LE(promise, 1e-3 * largest) << "a promise that says something";
  }
  EXPECT_GT(*table.rows[0].entries[2].computed, 1e27);  // printed 1e28
  EXPECT_LE(*table.rows[0].entries[2].automatic, 1e-7 * *table.rows[0].entries[4].computed);
}

TEST(ReproduceFgtd, DoesNotAgreeWithWhatIsWrong) {
  const Column at_most{.name = "error", .printed = "e", .comparison = Comparison::at_most},
      order{.name = "error", .printed = "e", .comparison = Comparison::order},
      bound{.name = "bound", .printed = "b", .comparison = Comparison::arithmetic},
      count{.name = "count", .printed = "c", .quantity = Quantity::count, .comparison = Comparison::arithmetic},
      digits{.name = "digits", .printed = "d", .comparison = Comparison::digits};
  const auto entry = [](double published, double computed) {
    Entry made{computed, {}};
    made.published = published;
    return made;
  };
  EXPECT_TRUE(agrees(at_most, entry(1e-6, 9e-6)));
  EXPECT_TRUE(agrees(at_most, entry(1e-6, 0)));
  EXPECT_FALSE(agrees(at_most, entry(1e-6, 2e-5)));
  EXPECT_FALSE(agrees(at_most, entry(1e-6, std::nan(""))));
  EXPECT_FALSE(agrees(at_most, entry(1e28, std::numeric_limits<double>::infinity())));
  Entry broken = entry(1e-6, 1e-6);
  broken.kept = false;  // the promise of automatic
  EXPECT_FALSE(agrees(at_most, broken));
  EXPECT_TRUE(agrees(order, entry(1e-6, 5e-7)));
  EXPECT_TRUE(agrees(order, entry(1e-6, 1.1e-5)));
  EXPECT_FALSE(agrees(order, entry(1e-6, 2e-7)));
  EXPECT_FALSE(agrees(order, entry(1e-6, 2e-5)));
  EXPECT_FALSE(agrees(order, entry(1e-6, 0)));
  EXPECT_FALSE(agrees(order, entry(1e-6, std::nan(""))));
  EXPECT_FALSE(agrees(bound, entry(1e-6, 1e-8)));
  EXPECT_FALSE(agrees(bound, entry(1e-6, 1e-5)));
  EXPECT_FALSE(agrees(count, entry(1614, 1615)));
  Entry printed = entry(0.955033, 0.9550332);
  printed.last_digit = 1e-6;
  EXPECT_TRUE(agrees(digits, printed));
  printed.computed = 0.955034;
  EXPECT_FALSE(agrees(digits, printed));
}

TEST(ReproduceFgtd, TellsHowTablesAreComparedAndWhatIsAPowerOfTenOff) {
  FgtdOptions options;
  options.table = "4.1";
  options.most_points = 2000;
  const FgtdReproduction result = reproduce_fgtd(options);  // 6 rows of two bounds, absolute and relative errors each
  EXPECT_EQ(result.compared, 36u);
  EXPECT_EQ(result.by_kind, (std::array<std::size_t, 4>{12, 0, 12, 12}));
  const std::string text = to_text(result);
  EXPECT_NE(text.find("compared: 12 arithmetic, 12 order of magnitude, 12 at most the published error"),
            std::string::npos)
      << text;
  for (const std::string place : {"N = 200, p=8 nu=2", "N = 800, p=9 nu=3", "N = 2000, p=8 nu=2"}) {
    const auto there = std::find_if(result.off.begin(), result.off.end(), [&](const auto& off) {
      return off.place.find(place + " bound") != std::string::npos;
    });
    ASSERT_NE(there, result.off.end()) << place;
    EXPECT_NE(there->why.find("11.3 Q"), std::string::npos);
  }
  for (const auto& off : result.off) EXPECT_FALSE(off.why.empty()) << off.place;
  const auto json = parsed_json(to_json(result));
  EXPECT_EQ(json["comparisons"]["arithmetic"], 12);
  EXPECT_EQ(json["off_by_a_power_of_ten"].size(), result.off.size());
}

TEST(ReproduceFgtd, RefusesATableThatThereIsNot) {
  FgtdOptions options;
  options.table = "4.10";
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
}  // namespace gaussdrift::reproduce
