// Expressions of a velocity field at many points, a block at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// Points an expression sees at once: its arrays stay in the first-level cache.
constexpr std::size_t block_length = 512;

/// Calls visit(first, arguments, length) for blocks of points; the arguments are x, y, (z,) t.
template <class Visit>
void for_blocks(double t, const PointsView& x, const Visit& visit) {
  std::array<double, block_length> times;
  times.fill(t);
  for (std::size_t first = 0; first < x.count; first += block_length) {
    const std::size_t length = std::min(block_length, x.count - first);
    std::array<const double*, max_dimension + 1> arguments{};
    for (int k = 0; k < x.dimension; ++k) arguments[k] = x.axis[k] + first;
    arguments[x.dimension] = times.data();
    visit(first, arguments.data(), length);
  }
}

inline void add_block(const double* part, std::size_t length, double* sum) {
  for (std::size_t i = 0; i < length; ++i) sum[i] += part[i];
}

}  // namespace gaussdrift
