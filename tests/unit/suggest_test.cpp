#include "base/suggest.hpp"

#include <gtest/gtest.h>

namespace gaussdrift::base {
namespace {

TEST(EditDistance, CountsEveryKindOfSlip) {
  EXPECT_EQ(edit_distance("overlap", "overlap"), 0u);
  EXPECT_EQ(edit_distance("overlapp", "overlap"), 1u);  // too many
  EXPECT_EQ(edit_distance("ovrlap", "overlap"), 1u);    // too few
  EXPECT_EQ(edit_distance("overlab", "overlap"), 1u);   // another
  EXPECT_EQ(edit_distance("oevrlap", "overlap"), 1u);   // swapped
  EXPECT_EQ(edit_distance("Overlap", "overlap"), 0u);   // case does not count
  EXPECT_EQ(edit_distance("", "abc"), 3u);
}

TEST(Suggest, NamesTheNearWordAndNothingFar) {
  const std::vector<std::string> known{"per_axis", "overlap", "cutoff"};
  EXPECT_EQ(suggest("cutof", known), "cutoff");
  EXPECT_EQ(suggest("peraxis", known), "per_axis");
  EXPECT_EQ(suggest("viscosity", known), std::nullopt);
}

}  // namespace
}  // namespace gaussdrift::base
