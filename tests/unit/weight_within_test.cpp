// A bound on the weight around any point: it must come at once for every reach.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "base/weight_within.hpp"

namespace gaussdrift {
namespace {

/// The bound for points on a line with these coordinates and weight 1 each.
double bound(const std::vector<double>& x, double reach) {
  const std::vector<double> y(x.size(), 0.0), weight(x.size(), 1.0);
  const PointsView view{2, x.size(), {x.data(), y.data(), nullptr}};
  return largest_weight_within(view, weight.data(), reach);
}

TEST(LargestWeightWithin, EndsForEveryReach) {
  // Boxes may not be shorter than the array of them allows: that raises the bound, and it stays one.
  for (const double reach : {0.0, std::numeric_limits<double>::denorm_min(), 1e-300, 1e-12, 0.1, 1e300})
    for (const double extent : {0.0, 1e-300, 1.0, 1e300}) {
      const double found = bound({0, 0.25 * extent, extent}, reach);
      EXPECT_GE(found, 1) << reach << " over " << extent;
      EXPECT_LE(found, 3) << reach << " over " << extent;
    }
  EXPECT_EQ(bound({0, 0.25, 1}, 1e-300), 1);  // boxes of a millionth keep them apart
  EXPECT_EQ(bound({0, 0, 0}, 0), 3);
}

}  // namespace
}  // namespace gaussdrift
