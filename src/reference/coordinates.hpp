// Coordinates of lattice points, axis after axis, as fields want them.
#pragma once

#include <cstddef>

#include "gaussdrift/lattice.hpp"

namespace gaussdrift {

/// Coordinates of the lattice points point_of(0) .. point_of(count - 1), axis[k * count + i].
template <class PointOf>
void fill_coordinates(const Lattice& lattice, std::size_t count, double* axis, const PointOf& point_of) {
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = point_of(i);
    for (int k = 0; k < lattice.dimension; ++k) {
      axis[static_cast<std::size_t>(k) * count + i] = lattice.coordinate(k, rest % lattice.points[k]);
      rest /= lattice.points[k];
    }
  }
}

/// Of the points first .. first + count - 1.
inline void fill_coordinates(const Lattice& lattice, std::size_t first, std::size_t count, double* axis) {
  fill_coordinates(lattice, count, axis, [&](std::size_t i) { return first + i; });
}

/// Of the points points[0] .. points[count - 1].
inline void fill_coordinates(const Lattice& lattice, const std::size_t* points, std::size_t count, double* axis) {
  fill_coordinates(lattice, count, axis, [&](std::size_t i) { return points[i]; });
}

}  // namespace gaussdrift
