// What the thesis claims in its text: which claims hold, which do not, and the numbers beside them.
#include "parsed_json.hpp"
#include "reproduce/claims.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

namespace gaussdrift::reproduce {
namespace {

// Printed numbers by claim.
std::map<std::string, std::string> read_text() {
  std::ifstream in(std::string(REFERENCE_DIR) + "/schroeder-text.csv");
  std::map<std::string, std::string> printed;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::string claim, section, number;
    std::getline(cells, claim, ',');
    std::getline(cells, section, ',');
    std::getline(cells, number, ',');
    printed[claim] = number;
  }
  return printed;
}

TEST(ReproduceClaims, SaysWhichHold) {
  const ClaimsReproduction result = reproduce_claims({.points_an_axis = 100, .threads = 0});
  std::map<std::string, Claim> claims;
  for (const Claim& claim : result.claims) claims[claim.name] = claim;
  const auto printed = read_text();
  const auto expect = [&](const std::string& name, const std::string& quoted, double computed, double tolerance,
                          bool holds) {
    ASSERT_EQ(claims.count(name), 1u) << name;
    const Claim& claim = claims.at(name);
    if (!quoted.empty()) {
      EXPECT_EQ(claim.printed, printed.at(quoted)) << name;
    }
    EXPECT_NEAR(claim.computed, computed, tolerance) << name;
    ASSERT_TRUE(claim.holds) << name;
    EXPECT_EQ(*claim.holds, holds) << name;
    if (!holds) {
      EXPECT_GT(claim.note.size(), 10u) << name << " needs a reason";
    }
  };
  expect("break-even", "break_even", 77, 0, true);
  expect("bound, nu = 2", "factor_of_the_bound_p8_nu2", 11.296, 1e-3, true);
  expect("bound, nu = 3", "factor_of_the_bound_p9_nu3", 0.029509, 1e-6, true);
  expect("r of 10 000", "box_scale_of_10000", 17.6777, 1e-4, true);
  expect("error of grids", "error_of_grids", 2.25e-8, 1e-10, false);  // 2 r^p / (sqrt(p!) (1 - r)^2)
  expect("box error", "", 9.930e-6, 1e-9, true);                      // exp(-2 0.2^2 12^2), four digits
  expect("optimum", "", 12 * 12 * 12 * 9, 0, false);                  // p = 12, nu = 2: 15 552 terms of 20 412
  expect("n of the tables", "neighbours_of_tables", 23, 0, true);
  expect("n of the figures", "neighbours_of_figures", 16, 0, false);
  expect("constant error", "", 0.470, 0.005, true);  // eight times as many points
  expect("boxes, d = 2", "boxes_for_32_in_the_plane", 1024, 0, true);
  expect("boxes, d = 3", "boxes_for_32_in_space", 32768, 0, true);
  expect("particles", "particles_with_weight", 4378, 0, true);
  EXPECT_NE(claims.at("particles").note.find("4386"), std::string::npos);
  expect("boxes an axis", "boxes_an_axis", 264, 0, true);
  expect("error of the tables", "error_of_tables", 4.477e-18, 1e-21, false);  // 2 r^p / (sqrt(p!) (1 - r)^2)
  expect("error of the figures", "error_of_figures", 1.487e-6, 1e-9, false);  // of another grid than the program's
  expect("difference from pairs", "difference_from_pairs", 0, 1e-12, true);
  EXPECT_LT(claims.at("measured so").computed, 6e-17);  // 2.2e-17: rounding
  EXPECT_FALSE(claims.at("measured so").holds);
  EXPECT_EQ(claims.at("seconds, pairs").printed, printed.at("seconds_of_pairs"));
  EXPECT_NE(to_text(result).find("5 do not hold"), std::string::npos) << to_text(result);
  EXPECT_EQ(parsed_json(to_json(result))["claims"].size(), result.claims.size());
}

}  // namespace
}  // namespace gaussdrift::reproduce
