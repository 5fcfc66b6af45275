// The cluster tree: cubes of a lattice that is halved from level to level, down to clusters of few points. It follows
// the points, so it resolves groups of points far smaller than the whole, down to sides of 2^-40 of it. Sides and
// centres are exact numbers, so that clusters are whole numbers of sides apart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "farfield/problem.hpp"

namespace farfield::detail {

using Index = std::uint32_t;  // of points and clusters

constexpr int max_level = 40;

struct Cluster {
  Index parent = 0;
  Index first_child = 0;
  std::uint8_t children = 0;  // they follow each other; 0: a leaf
  std::uint8_t level = 0;
  std::uint8_t octant = 0;  // within the parent: bit l is set in the upper half of axis l
  /// All sources and targets of this leaf are equal; only told of leaves that could not be divided.
  bool one_point = false;
  std::array<std::int64_t, 3> cell{};  // number on the lattice of its level
  Range sources{}, targets{};          // in the order of the tree

  bool leaf() const { return children == 0; }
  std::size_t source_count() const { return sources.end - sources.begin; }
  std::size_t target_count() const { return targets.end - targets.begin; }
};

/// Points in the order of the tree.
struct SortedPoints {
  Coordinates position;
  std::vector<Index> original;  // number in the caller's order
};

template <int d>
class Tree {
 public:
  /// Clusters of more than `leaf_size` sources or targets are divided, unless their side is below 2 smallest_side.
  Tree(const Problem& problem, std::size_t leaf_size, double smallest_side, int threads);

  /// Clusters of at most `leaf_size` sources and targets are not divided any more.
  void prune(std::size_t leaf_size);

  bool self() const { return self_; }
  const std::vector<Cluster>& clusters() const { return clusters_; }
  /// Clusters of level i: level_begin(i) .. level_begin(i + 1).
  std::size_t levels() const { return level_begin_.size() - 1; }
  std::size_t level_begin(std::size_t level) const { return level_begin_[level]; }

  const SortedPoints& sources() const { return sources_; }
  const SortedPoints& targets() const { return self_ ? sources_ : targets_; }

  double side(int level) const;
  double centre(const Cluster& cluster, std::size_t axis) const {
    return corner_[axis] + (static_cast<double>(cluster.cell[axis]) + 0.5) * side(cluster.level);
  }

 private:
  /// Sets corner and side of the root so that it holds all points.
  void enclose();

  bool self_;
  double corner_[3] = {}, side_ = 1;  // of the root
  std::vector<Cluster> clusters_;
  std::vector<std::size_t> level_begin_;
  SortedPoints sources_, targets_;
};

/// Do the closed cubes have a point in common?
template <int d>
bool touch(const Cluster& a, const Cluster& b);

}  // namespace farfield::detail
