// The smallest row of the table of Coulomb forces; the others take seconds each and are for `gaussdrift reproduce
// coulomb`. What an evaluation costs is counted in tests/farfield/work_test.cpp.
#include "parsed_json.hpp"
#include "reproduce/coulomb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "reproduce/published.hpp"

namespace gaussdrift::reproduce {
namespace {

// The first row as printed: column -> number.
std::map<std::string, double> first_row() {
  std::ifstream in(std::string(REFERENCE_DIR) + "/boerm-coulomb.csv");
  std::string header, row;
  std::getline(in, header);
  std::getline(in, row);
  std::istringstream names(header), cells(row);
  std::map<std::string, double> printed;
  for (std::string name, cell; std::getline(names, name, ',') && std::getline(cells, cell, ',');)
    printed[name] = std::stod(cell);
  return printed;
}

TEST(ReproduceCoulomb, ErrorsAreAtMostThePublishedOnes) {
  const auto printed = first_row();
  const CoulombReproduction result = reproduce_coulomb({.most_particles = 25'000, .most_by_pairs = 0, .threads = 0});
  ASSERT_EQ(result.rows.size(), 1u);
  EXPECT_TRUE(result.disagreements.empty()) << result.disagreements.front();
  const CoulombRow& row = result.rows[0];
  EXPECT_EQ(static_cast<double>(row.particles), printed.at("particles"));
  EXPECT_EQ(row.direct.published_seconds, printed.at("seconds_direct"));
  EXPECT_EQ(row.tree.published_seconds, printed.at("seconds_tree"));
  EXPECT_EQ(row.tree.published_forward, printed.at("forward_tree"));
  EXPECT_EQ(row.tree.published_coupling, printed.at("coupling_tree"));
  EXPECT_EQ(row.tree.published_error, printed.at("error_tree"));
  EXPECT_EQ(row.symmetric.published_seconds, printed.at("seconds_symmetric"));
  EXPECT_EQ(row.symmetric.published_error, printed.at("error_symmetric"));
  EXPECT_FALSE(row.direct.seconds);
  EXPECT_LE(*row.tree.error, printed.at("error_tree"));
  EXPECT_LE(*row.symmetric.error, printed.at("error_symmetric"));
  for (const CoulombTime* time : {&row.tree, &row.symmetric}) {
    EXPECT_GT(*time->error, 1e-9);  // not summed directly
    EXPECT_GT(time->setup, 0);
    EXPECT_GT(time->parts.forward, 0);
    EXPECT_LT(time->work.pairs, 25e3 * 25e3 / 3);
  }
  EXPECT_NE(to_text(result).find("25000"), std::string::npos);
  EXPECT_EQ(parsed_json(to_json(result))["rows"][0]["tree"]["published_seconds"], printed.at("seconds_tree"));
}

// What the program holds is what stands in tests/reference, every file of it.
TEST(Published, IsWhatStandsInTheFiles) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(REFERENCE_DIR)) {
    if (entry.path().extension() != ".csv") continue;
    ++files;
    std::ifstream in(entry.path(), std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    const auto& all = published_files();
    const auto file =
        std::find_if(all.begin(), all.end(), [&](const auto& f) { return f.name == entry.path().filename().string(); });
    ASSERT_NE(file, all.end()) << entry.path();
    EXPECT_EQ(file->bytes, bytes.str()) << entry.path();
  }
  EXPECT_EQ(files, published_files().size());
}

TEST(Published, ReadsNumbersWholeAndKnowsTheirLastDigit) {
  const PublishedTable coulomb("boerm-coulomb"), factors("schroeder-table-4.2"), sets("schroeder-table-4.8");
  EXPECT_EQ(coulomb.rows(), 9u);
  EXPECT_EQ(coulomb.number(0, "error_tree"), 7.71e-6);
  EXPECT_EQ(coulomb.number(5, "error_tree"), std::nullopt);  // not printed
  EXPECT_EQ(factors.number(0, "speedup_p8nu2"), never);      // a dash
  EXPECT_THROW(factors.number(0, "speedup"), std::exception);
  EXPECT_THROW(sets.number(0, "data"), std::exception);  // "halton" is no number
  EXPECT_THROW(PublishedTable("schroeder-table-9.9"), std::exception);
  EXPECT_NEAR(sets.last_digit(0, "sigma1_nu3_n0"), 1e-6, 1e-20);               // 0.955033; rounding of the power
  EXPECT_NEAR(sets.last_digit(0, "sigma100_nu29_n14_or_more"), 1e-11, 1e-25);  // 1.12e-9
  EXPECT_EQ(factors.last_digit(1, "points"), 1);                               // 400
  // The slides' two parts of tree add up to its seconds; they are printed on different slides.
  for (std::size_t i = 0; i < coulomb.rows(); ++i)
    EXPECT_NEAR(*coulomb.number(i, "forward_tree") + *coulomb.number(i, "coupling_tree"),
                *coulomb.number(i, "seconds_tree"), 1e-9)
        << i;
}

}  // namespace
}  // namespace gaussdrift::reproduce
