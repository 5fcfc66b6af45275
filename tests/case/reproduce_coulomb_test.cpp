// The smallest row of the table of Coulomb forces; the others take seconds each and are for `gaussdrift reproduce
// coulomb`.
#include "study/reproduce_coulomb.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace gaussdrift::study {
namespace {

TEST(ReproduceCoulomb, ErrorsAreAtMostThePublishedOnes) {
  const CoulombReproduction result = reproduce_coulomb({.most_particles = 25'000, .most_by_pairs = 0, .threads = 0});
  ASSERT_EQ(result.rows.size(), 1u);
  EXPECT_TRUE(result.disagreements.empty()) << result.disagreements.front();
  const CoulombRow& row = result.rows[0];
  EXPECT_FALSE(row.direct.seconds);
  EXPECT_LE(*row.tree.error, 7.71e-6);
  EXPECT_LE(*row.symmetric.error, 5.64e-6);
  EXPECT_GT(*row.tree.error, 1e-9);  // not summed directly
  EXPECT_GT(*row.symmetric.error, 1e-9);
  EXPECT_NE(to_text(result).find("25000"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(to_json(result))["rows"][0]["tree"]["published_seconds"], 0.42);
}

}  // namespace
}  // namespace gaussdrift::study
