#include "gaussdrift/lattice.hpp"

#include <algorithm>
#include <cmath>

#include "base/longest_side.hpp"
#include "base/sphere.hpp"

namespace gaussdrift {

double Lattice::unit() const { return sphere > 0 ? sphere * radians(1) : 1; }

double Lattice::cell(double y) const {
  const double flat = std::pow(spacing * unit(), dimension);
  return sphere > 0 ? flat * std::cos(radians(y)) : flat;
}

std::vector<double> Lattice::nodes(int axis) const {
  std::vector<double> list(points[axis]);
  for (std::size_t i = 0; i < list.size(); ++i) list[i] = coordinate(axis, i);
  return list;
}

Lattice make_lattice(int dimension, const Vector& min, const Vector& max, int per_axis) {
  const double longest = longest_side(dimension, min, max);
  Lattice lattice = make_lattice_with_spacing(dimension, min, max, longest / (per_axis - 1));
  for (int k = 0; k < dimension; ++k)
    if (max[k] - min[k] == longest) lattice.origin[k] = min[k];
  return lattice;
}

Lattice make_lattice_with_spacing(int dimension, const Vector& min, const Vector& max, double spacing) {
  Lattice lattice;
  lattice.dimension = dimension;
  lattice.spacing = spacing;
  for (int k = 0; k < dimension; ++k) {
    const double length = max[k] - min[k];
    // A length that is a multiple of the spacing up to rounding keeps its last point.
    const double steps = std::floor(length / lattice.spacing * (1 + 1e-12) + 1e-12);
    lattice.points[k] = static_cast<std::size_t>(steps) + 1;
    lattice.origin[k] = min[k] + 0.5 * (length - steps * lattice.spacing);
  }
  return lattice;
}

}  // namespace gaussdrift
