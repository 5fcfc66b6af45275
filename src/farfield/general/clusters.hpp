// Clusters and blocks of general kernels. Clusters are cubes of a lattice that is halved from level to level. They are
// divided where a block needs it: pairs of clusters are looked at level by level, and every pair of a target and a source
// ends in exactly one block. Sides and centres are numbers with few digits, so that clusters are whole sides apart.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "farfield/problem.hpp"

namespace farfield::detail {

struct GeneralCluster {
  static constexpr int deepest = 40;
  int level = 0;
  std::array<std::int64_t, 3> cell{};  // number on the lattice of its level
  std::uint32_t parent = 0, first_child = 0;
  std::uint8_t children = 0;  // they follow each other
  std::uint8_t octant = 0;    // within the parent: bit l is set in the upper half of axis l
  bool one_point = false;     // all its points are equal
  bool has_basis = false;     // it is in a coupling, or is below one and not below a leaf
  bool leaf = false;          // its basis has a matrix of its own
  std::size_t leaf_number = 0;
  Range points{};

  std::size_t size() const { return points.end - points.begin; }
};

/// The clusters of one set of points, by level, and the points in their order.
class GeneralTree {
 public:
  /// points  by axis, padded; they are sorted in place as clusters are divided
  GeneralTree(int dimension, Coordinates points, std::size_t count, const std::array<double, 3>& corner, double side);

  /// Makes the children of a cluster; does nothing if it has some.
  void divide(std::uint32_t number);

  const GeneralCluster& operator[](std::uint32_t number) const { return clusters_[number]; }
  GeneralCluster& operator[](std::uint32_t number) { return clusters_[number]; }
  std::size_t size() const { return clusters_.size(); }
  double side(int level) const { return std::ldexp(side_, -level); }
  double centre(const GeneralCluster& cluster, int axis) const {
    return corner_[static_cast<std::size_t>(axis)] +
           (static_cast<double>(cluster.cell[static_cast<std::size_t>(axis)]) + 0.5) * side(cluster.level);
  }
  const Coordinates& points() const { return points_; }
  /// Number of a point in the caller's order.
  const std::vector<std::uint32_t>& original() const { return original_; }
  double bytes() const;

 private:
  int dimension_;
  std::array<double, 3> corner_;
  double side_;
  Coordinates points_;
  std::vector<std::uint32_t> original_;
  std::vector<GeneralCluster> clusters_;
};

/// Couplings of one level between clusters that are one offset apart.
struct GeneralOffset {
  std::array<int, 3> offset{};  // cell of the target minus that of the source
  double far_pairs = 0;         // of points
};

struct GeneralCoupling {
  std::uint32_t target, source;
  std::uint32_t offset;  // number among those of the level
};

struct GeneralBlocks {
  struct Pair {
    std::uint32_t target, source;
  };
  std::vector<std::vector<GeneralCoupling>> couplings;  // by level, by target
  std::vector<std::vector<GeneralOffset>> offsets;      // by level
  std::vector<std::vector<Pair>> near;                  // by level, by target
  std::vector<Pair> equal;  // both clusters are one point each, and have too many points for a near block
  double near_pairs = 0;
  double bytes() const;
};

struct DivisionLimits {
  int separation;     // offsets beyond that are admissible
  double touching;    // pairs of points from which on two clusters that are not admissible are divided
  double worthwhile;  // pairs of points from which on a coupling is cheaper than all pairs
};

/// Divides clusters and lists the blocks. `sources` may be `targets`.
GeneralBlocks make_blocks(GeneralTree& targets, GeneralTree& sources, const DivisionLimits& limits,
                          std::size_t memory_limit);

/// Says which clusters have a basis and which of them are leaves; returns how many leaves there are.
std::size_t mark_bases(GeneralTree& tree, const std::vector<std::uint32_t>& coupled);

}  // namespace farfield::detail
