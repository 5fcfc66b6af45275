#include "gaussdrift/lattice_pieces.hpp"

#include <algorithm>

namespace gaussdrift {

namespace {

std::size_t begin_of(std::size_t part, std::size_t points, int halvings) {
  // part * points does not overflow: a lattice has fewer than 2^40 points, and an axis fewer parts than points.
  return part * points >> halvings;
}

}  // namespace

LatticeBox common(const LatticeBox& a, const LatticeBox& b) {
  LatticeBox box;
  for (std::size_t k = 0; k < max_dimension; ++k) {
    box.first[k] = std::max(a.first[k], b.first[k]);
    const std::size_t end = std::min(a.end(k), b.end(k));
    box.points[k] = end > box.first[k] ? end - box.first[k] : 0;
  }
  return box;
}

LatticePieces::LatticePieces(const Lattice& lattice, double most_points) : points_(lattice.points) {
  // Points of the largest piece on an axis.
  const auto longest = [&](std::size_t k) {
    const std::size_t parts = std::size_t{1} << halvings_[k];
    return (points_[k] + parts - 1) / parts + (parts > 1 ? 1 : 0);
  };
  while (static_cast<double>(longest(0)) * static_cast<double>(longest(1)) * static_cast<double>(longest(2)) >
         most_points) {
    std::size_t axis = 0;
    for (std::size_t k = 1; k < max_dimension; ++k)
      if (longest(k) >= longest(axis)) axis = k;
    constexpr std::size_t fewest = 4;  // own points of a piece on an axis
    if (points_[axis] >> (halvings_[axis] + 1) < fewest) break;
    ++halvings_[axis];
  }
}

LatticeBox LatticePieces::own(std::size_t piece) const {
  LatticeBox box;
  for (std::size_t k = 0; k < max_dimension; ++k) {
    const std::size_t part = piece & ((std::size_t{1} << halvings_[k]) - 1);
    piece >>= halvings_[k];
    box.first[k] = begin_of(part, points_[k], halvings_[k]);
    box.points[k] = begin_of(part + 1, points_[k], halvings_[k]) - box.first[k];
  }
  return box;
}

LatticeBox LatticePieces::shown(std::size_t piece) const {
  LatticeBox box = own(piece);
  for (std::size_t k = 0; k < max_dimension; ++k)
    if (box.end(k) < points_[k]) ++box.points[k];
  return box;
}

std::size_t LatticePieces::of(const std::array<std::size_t, max_dimension>& index) const {
  std::size_t piece = 0;
  for (std::size_t k = max_dimension; k-- > 0;) {
    std::size_t part = (index[k] << halvings_[k]) / points_[k];  // or the next one: begins are rounded down
    const std::size_t last = (std::size_t{1} << halvings_[k]) - 1;
    while (part < last && begin_of(part + 1, points_[k], halvings_[k]) <= index[k]) ++part;
    piece = (piece << halvings_[k]) + part;
  }
  return piece;
}

std::size_t LatticePieces::before(std::size_t piece, unsigned axes) const {
  int shift = 0;
  for (std::size_t k = 0; k < max_dimension; ++k) {
    if (axes >> k & 1u) piece -= std::size_t{1} << shift;
    shift += halvings_[k];
  }
  return piece;
}

std::size_t thinning(const Lattice& lattice) {
  constexpr std::size_t most_on_axis = 2048, most_in_space = std::size_t{256} * 256 * 256;
  for (std::size_t every = 1;; ++every) {
    const Lattice some = thinned(lattice, every);
    const bool fits = lattice.dimension == 2 ? std::max(some.points[0], some.points[1]) <= most_on_axis
                                             : some.size() <= most_in_space;
    if (fits) return every;
  }
}

Lattice thinned(const Lattice& lattice, std::size_t every) {
  Lattice some = lattice;
  for (std::size_t& points : some.points) points = (points - 1) / every + 1;
  some.spacing = lattice.spacing * static_cast<double>(every);
  return some;
}

}  // namespace gaussdrift
