// The nodes of a lattice continued to all space, each with a number of its own: those inside keep their index on the
// lattice, those outside have negative numbers. Particles are named by the node on which they start.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gaussdrift/lattice.hpp"

namespace gaussdrift {

/// Steps from the lattice's first point along each axis.
using NodeIndex = std::array<std::int64_t, max_dimension>;

class Nodes {
 public:
  /// has_images: particles have images beyond edges of the domain, whose numbers follow from theirs (particle/images.hpp).
  /// Nodes far outside then have smaller numbers, and fewer of them have one.
  explicit Nodes(const Lattice& lattice, bool has_images = false);

  /// Throws NumericalError if the node lies more than reach() spacings from the lattice's origin.
  std::int64_t id(const NodeIndex& index) const;
  NodeIndex index(std::int64_t id) const;
  Vector position(const NodeIndex& index) const;

  const Lattice& lattice() const { return lattice_; }
  int dimension() const { return lattice_.dimension; }
  /// Volume of a cell, h^d.
  double cell() const;
  std::int64_t reach() const { return std::int64_t{1} << (bits_ - 1); }

 private:
  Lattice lattice_;
  int bits_;  // of each coordinate of an outside node
};

}  // namespace gaussdrift
