// How far apart the same particles of two runs are.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// Largest distance of particles, by id; both runs have the same ones.
inline double apart(const Particles& a, const Particles& b) {
  EXPECT_EQ(a.id, b.id);
  double largest = 0;
  for (int k = 0; k < a.dimension; ++k)
    for (std::size_t j = 0; j < a.size(); ++j) {
      const auto axis = static_cast<std::size_t>(k);
      largest = std::max(largest, std::abs(a.position[axis][j] - b.position[axis][j]));
    }
  return largest;
}

}  // namespace gaussdrift
