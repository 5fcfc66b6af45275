// Views of many points, one contiguous array per axis: the form in which fields, densities and integrators meet.
#pragma once

#include <array>
#include <cstddef>

namespace gaussdrift {

constexpr int max_dimension = 3;

using Vector = std::array<double, max_dimension>;  // components beyond the dimension are 0

/// `count` points in `dimension` dimensions; axis[k] points at the k-th coordinates, null beyond the dimension.
struct PointsView {
  int dimension = 0;
  std::size_t count = 0;
  std::array<const double*, max_dimension> axis{};

  /// The points first .. first + length - 1.
  PointsView block(std::size_t first, std::size_t length) const {
    PointsView part{dimension, length, {}};
    for (int k = 0; k < dimension; ++k) part.axis[k] = axis[k] + first;
    return part;
  }
};

/// The same for vectors that are written.
struct VectorsView {
  int dimension = 0;
  std::size_t count = 0;
  std::array<double*, max_dimension> axis{};

  VectorsView block(std::size_t first, std::size_t length) const {
    VectorsView part{dimension, length, {}};
    for (int k = 0; k < dimension; ++k) part.axis[k] = axis[k] + first;
    return part;
  }
};

}  // namespace gaussdrift
