// Particles that must have the same bits.
#pragma once

#include <gtest/gtest.h>

#include "gaussdrift/particles.hpp"

namespace gaussdrift {

inline void expect_same(const Particles& a, const Particles& b) {
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.alpha, b.alpha);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.path, b.path);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.spread, b.spread);
}

}  // namespace gaussdrift
