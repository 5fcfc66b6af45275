// A cluster, and the cube that all clusters are parts of. Sides and centres are exact numbers, so that clusters are whole
// numbers of sides apart.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "farfield/problem.hpp"

namespace farfield::detail {

using Index = std::uint32_t;  // of points and clusters

constexpr int max_level = 40;

/// Where the points of a cluster are, as a rank sees it.
enum class Part : std::uint8_t {
  own,     // all of them here
  shared,  // on several ranks
  foreign  // all of them on another rank
};

struct Cluster {
  Index parent = 0;
  Index first_child = 0;
  std::uint8_t children =
      0;  // they follow each other; 0: a leaf, or a foreign cluster whose children are not known here
  std::uint8_t level = 0;
  std::uint8_t octant = 0;  // within the parent: bit l is set in the upper half of axis l
  /// All sources and targets of this leaf are equal; only told of leaves that could not be divided.
  bool one_point : 1 = false;
  Part part : 7 = Part::own;
  Index number = 0;                    // on several ranks: in the forest of the rank that has it; essential_tree.hpp
  std::array<std::int64_t, 3> cell{};  // number on the lattice of its level
  Range sources{}, targets{};          // in the order of the tree

  bool leaf() const { return children == 0; }
  std::size_t source_count() const { return sources.end - sources.begin; }
  std::size_t target_count() const { return targets.end - targets.begin; }
};

/// Lowest and highest coordinates.
struct Extent {
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void include(const Coordinates& points, std::size_t dimension, Range range);
  double widest(std::size_t dimension) const;
};

/// The root.
struct Cube {
  double corner[3] = {}, side = 1;

  double side_of(int level) const { return std::ldexp(side, -level); }
  double centre(const Cluster& cluster, std::size_t axis) const {
    return corner[axis] + (static_cast<double>(cluster.cell[axis]) + 0.5) * side_of(cluster.level);
  }
};

/// A cube that holds all points.
template <int d>
Cube enclose(const Extent& extent);

/// Points in the order of the tree.
struct SortedPoints {
  Coordinates position;
  std::vector<Index> original;  // number in the caller's order
};

/// Do the closed cubes have a point in common?
template <int d>
bool touch(const Cluster& a, const Cluster& b);

}  // namespace farfield::detail
