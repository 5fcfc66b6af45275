/// @file
/// Pieces of a lattice that is too large for one file or for the memory, and every k-th of its points.
#pragma once

#include <array>
#include <cstddef>

#include "gaussdrift/lattice.hpp"

namespace gaussdrift {

/// Points of a lattice whose indices fill a box.
struct LatticeBox {
  std::array<std::size_t, max_dimension> first{};          ///< index of its first point on each axis
  std::array<std::size_t, max_dimension> points{1, 1, 1};  ///< on each axis; 0: none

  /// Number of points.
  std::size_t size() const { return points[0] * points[1] * points[2]; }
  /// Index behind the last one.
  std::size_t end(std::size_t axis) const { return first[axis] + points[axis]; }
  /// Number of the point with these indices in the list of its points, first axis fastest.
  std::size_t number(std::size_t i, std::size_t j, std::size_t l) const {
    return i - first[0] + points[0] * (j - first[1] + points[1] * (l - first[2]));
  }
  /// The same indices.
  bool operator==(const LatticeBox&) const = default;
};

/// The points that both have.
LatticeBox common(const LatticeBox& a, const LatticeBox& b);

/// A lattice cut into boxes: halved on its longest axis, again and again, until no box has more than some number of
/// points. The cut follows from the lattice and that number alone. Each point belongs to one piece. A piece shows the
/// layer behind its own points too, which belongs to the next one: image data of VTK want that.
class LatticePieces {
 public:
  /// One piece.
  LatticePieces() = default;
  /// Pieces of at most `most_points` points.
  LatticePieces(const Lattice& lattice, double most_points);

  /// Number of pieces.
  std::size_t count() const { return std::size_t{1} << (halvings_[0] + halvings_[1] + halvings_[2]); }
  /// An axis is cut into 2^halvings parts; part c begins with the point floor(c points / 2^halvings).
  const std::array<int, max_dimension>& halvings() const { return halvings_; }
  /// The points that belong to a piece. Pieces are numbered with the first axis fastest.
  LatticeBox own(std::size_t piece) const;
  /// With the layer behind, on axes that go on.
  LatticeBox shown(std::size_t piece) const;
  /// The piece that the point with these indices belongs to.
  std::size_t of(const std::array<std::size_t, max_dimension>& index) const;
  /// The piece before this one on some axes: those where `axes` has a bit. There must be one.
  std::size_t before(std::size_t piece, unsigned axes) const;

 private:
  std::array<std::size_t, max_dimension> points_{1, 1, 1};
  std::array<int, max_dimension> halvings_{};
};

/// k where only every k-th point of a lattice is looked at: so that no axis has more than 2048 of them in the plane, and
/// that they are 256^3 at most in space.
std::size_t thinning(const Lattice& lattice);
/// Every k-th point.
Lattice thinned(const Lattice& lattice, std::size_t every);

}  // namespace gaussdrift
