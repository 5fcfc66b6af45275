// The cluster tree: cubes of a lattice that is halved from level to level, down to clusters of few points. It follows
// the points, so it resolves groups of points far smaller than the whole, down to sides of 2^-40 of it.
#pragma once

#include <cstddef>
#include <vector>

#include "farfield/tree/cluster.hpp"

namespace farfield::detail {

template <int d>
class Tree {
 public:
  /// Clusters of more than `leaf_size` sources or targets are divided, unless their side is below 2 smallest_side.
  Tree(const Problem& problem, std::size_t leaf_size, double smallest_side, int threads);
  /// What a rank knows of the clusters of all ranks, the sources being the targets: those of level i are
  /// level_begin[i] .. level_begin[i + 1]. It has no points yet.
  Tree(const Cube& cube, std::vector<Cluster> clusters, std::vector<std::size_t> level_begin)
      : self_(true), cube_(cube), clusters_(std::move(clusters)), level_begin_(std::move(level_begin)) {}

  /// Clusters of at most `leaf_size` sources and targets are not divided any more.
  void prune(std::size_t leaf_size);

  /// On several ranks: the points of this one and what it needs of others, with ranges of clusters that fit. `original`
  /// is that of its own points alone, which begin at own_begin().
  void take_points(SortedPoints points, std::size_t own_begin, std::vector<Cluster> clusters);

  bool self() const { return self_; }
  const std::vector<Cluster>& clusters() const { return clusters_; }
  /// Clusters of level i: level_begin(i) .. level_begin(i + 1).
  std::size_t levels() const { return level_begin_.size() - 1; }
  std::size_t level_begin(std::size_t level) const { return level_begin_[level]; }

  const SortedPoints& sources() const { return sources_; }
  const SortedPoints& targets() const { return self_ ? sources_ : targets_; }
  /// Place among the positions that sources().original and targets().original begin at.
  std::size_t own_begin() const { return own_begin_; }

  double side(int level) const { return cube_.side_of(level); }
  double centre(const Cluster& cluster, std::size_t axis) const { return cube_.centre(cluster, axis); }

 private:
  bool self_;
  Cube cube_;
  std::vector<Cluster> clusters_;
  std::vector<std::size_t> level_begin_;
  SortedPoints sources_, targets_;
  std::size_t own_begin_ = 0;
};

}  // namespace farfield::detail
