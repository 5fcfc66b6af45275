// Numbers of an output that must have the same bits; seconds may differ.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gaussdrift/frame.hpp"

namespace gaussdrift {

/// Values that can be compared: those that are not known are equal, too.
inline std::vector<double> comparable(std::vector<double> values) {
  for (double& value : values)
    if (std::isnan(value)) value = -1e300;
  return values;
}

inline void expect_same(const FrameNumbers& m, const FrameNumbers& n) {
  EXPECT_EQ(m.mass, n.mass);
  EXPECT_EQ(m.minimum, n.minimum);
  EXPECT_EQ(m.maximum, n.maximum);
  EXPECT_EQ(m.centroid, n.centroid);
  EXPECT_EQ(m.transform_error, n.transform_error);
  EXPECT_EQ(m.transform_tolerance, n.transform_tolerance);
  EXPECT_EQ(m.stretch, n.stretch);
  EXPECT_EQ(m.weight, n.weight);
  EXPECT_EQ(m.outside, n.outside);
  EXPECT_EQ(m.compared, n.compared);
  EXPECT_EQ(m.untraced, n.untraced);
  EXPECT_EQ(m.inside, n.inside);
  EXPECT_EQ(m.released, n.released);
  EXPECT_EQ(m.decayed, n.decayed);
  ASSERT_EQ(m.stopped.has_value(), n.stopped.has_value());
  if (m.stopped) {
    EXPECT_EQ(m.stopped->particles, n.stopped->particles);
    EXPECT_EQ(m.stopped->mass, n.stopped->mass);
  }
  ASSERT_EQ(m.left.size(), n.left.size());
  for (std::size_t r = 0; r < m.left.size(); ++r) {
    EXPECT_EQ(m.left[r].reason, n.left[r].reason);
    EXPECT_EQ(m.left[r].particles, n.left[r].particles);
    EXPECT_EQ(m.left[r].mass, n.left[r].mass);
  }
  ASSERT_EQ(m.error.has_value(), n.error.has_value());
  if (!m.error) return;
  const ErrorNorms &a = *m.error, &b = *n.error;
  EXPECT_EQ(comparable({a.l1, a.l2, a.linf}), comparable({b.l1, b.l2, b.linf}));
}

}  // namespace gaussdrift
