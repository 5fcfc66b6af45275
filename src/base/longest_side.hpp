// The longest side of a box.
#pragma once

#include <algorithm>
#include <cstddef>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// Of the box [min, max] in `dimension` dimensions.
inline double longest_side(int dimension, const Vector& min, const Vector& max) {
  double longest = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) longest = std::max(longest, max[k] - min[k]);
  return longest;
}

}  // namespace gaussdrift
