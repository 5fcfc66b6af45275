/// @file
/// Uniform lattices over a box: n points on the longest axis, the same spacing on all axes.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// Points origin + index * spacing, first axis fastest. Axes beyond the dimension have one point.
struct Lattice {
  int dimension = 2;                                       ///< 2 or 3
  std::array<std::size_t, max_dimension> points{1, 1, 1};  ///< on each axis
  Vector origin{};                                         ///< of the point with index 0 on every axis
  double spacing = 0;                                      ///< the same on all axes, a length of the case
  /// Radius of the sphere on which the first axis has longitudes and the second one latitudes, in degrees; 0: a plane, or
  /// space, of lengths.
  double sphere = 0;

  /// Number of points.
  std::size_t size() const { return points[0] * points[1] * points[2]; }
  /// Of the points with this index on that axis.
  double coordinate(int axis, std::size_t index) const { return origin[axis] + static_cast<double>(index) * spacing; }
  /// The length of a unit of the coordinates: of a degree of latitude on a sphere, else 1.
  double unit() const;
  /// The volume that belongs to a point with this second coordinate; on a sphere an area, smaller at higher latitudes.
  double cell(double y) const;
  /// The largest of them anywhere.
  double largest_cell() const { return cell(0); }
  /// All coordinates on an axis, ascending.
  std::vector<double> nodes(int axis) const;
};

/// The lattice with `per_axis` >= 2 points on the longest axis of [min, max], spacing L/(per_axis - 1); the other axes
/// get floor(L_k / spacing) + 1 points, centred.
Lattice make_lattice(int dimension, const Vector& min, const Vector& max, int per_axis);
/// The same with this spacing, which may be no longer than the longest axis: that one is filled evenly from its middle
/// too.
Lattice make_lattice_with_spacing(int dimension, const Vector& min, const Vector& max, double spacing);

}  // namespace gaussdrift
