/// @file
/// Views of many points, one contiguous array per axis: the form in which fields, densities and integrators meet.
#pragma once

#include <array>
#include <cstddef>

namespace gaussdrift {

/// Points have this many axes at most.
constexpr int max_dimension = 3;

/// A point or a vector; components beyond the dimension are 0.
using Vector = std::array<double, max_dimension>;

/// Points that are read.
struct PointsView {
  int dimension = 0;                                ///< 1 to max_dimension
  std::size_t count = 0;                            ///< number of points
  std::array<const double*, max_dimension> axis{};  ///< axis[k]: their k-th coordinates; null beyond the dimension

  /// The j-th point.
  Vector at(std::size_t j) const {
    Vector x{};
    for (int k = 0; k < dimension; ++k) x[k] = axis[k][j];
    return x;
  }
  /// The points first .. first + length - 1.
  PointsView block(std::size_t first, std::size_t length) const {
    PointsView part{dimension, length, {}};
    for (int k = 0; k < dimension; ++k) part.axis[k] = axis[k] + first;
    return part;
  }
};

/// The same for points or vectors that are written.
struct VectorsView {
  int dimension = 0;                          ///< 1 to max_dimension
  std::size_t count = 0;                      ///< number of vectors
  std::array<double*, max_dimension> axis{};  ///< axis[k]: their k-th components; null beyond the dimension

  /// The vectors first .. first + length - 1.
  VectorsView block(std::size_t first, std::size_t length) const {
    VectorsView part{dimension, length, {}};
    for (int k = 0; k < dimension; ++k) part.axis[k] = axis[k] + first;
    return part;
  }
};

}  // namespace gaussdrift
