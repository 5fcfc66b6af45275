// Clusters are divided, and their points put in the order of the parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "farfield/tree/cluster.hpp"

namespace farfield::detail {

template <int d>
constexpr std::size_t octants = std::size_t{1} << d;

/// Second copy of the points, where parts of the array are put in order.
struct Scratch {
  SortedPoints points;
  std::vector<std::uint8_t> octant;
};
void make_scratch(const SortedPoints& points, std::size_t dimension, Scratch& scratch);

/// Puts the points of a range in the order of their octants around `centre`; end[o]: end of octant o. Points of one
/// octant stay in their order.
template <int d>
void sort_by_octant(SortedPoints& points, Scratch& scratch, Range range, const double* centre, std::size_t* end);

/// Where the octants of a cluster end among its points.
template <int d>
struct Ends {
  std::size_t sources[octants<d>], targets[octants<d>];
  bool divided = false;
};

/// Appends the octants of cluster `number` that have points.
template <int d>
void add_children(std::vector<Cluster>& clusters, std::size_t number, const Ends<d>& ends);

/// Which clusters are divided: those of more than `leaf_size` sources or targets, unless their side is below 2
/// smallest_side.
struct DivisionRule {
  Cube cube;
  std::size_t leaf_size = 1;
  double smallest_side = 0;

  bool is_small(const Cluster& cluster) const {
    return std::max(cluster.source_count(), cluster.target_count()) <= leaf_size;
  }
  /// A cluster that is not divided however many points it has.
  bool is_last(const Cluster& cluster) const {
    return cluster.level == max_level || cube.side_of(cluster.level + 1) < smallest_side;
  }
  /// Equal points cannot be divided. They are looked for where the last division divided nothing, and at the ends.
  bool may_be_one_point(const std::vector<Cluster>& clusters, const Cluster& cluster) const {
    const Cluster& parent = clusters[cluster.parent];
    return cluster.level == 0 || is_last(cluster) ||
           (parent.source_count() == cluster.source_count() && parent.target_count() == cluster.target_count());
  }
};

template <int d>
class Divider {
 public:
  /// targets: null if the sources are the targets.
  Divider(const DivisionRule& rule, SortedPoints& sources, SortedPoints* targets, int threads);

  /// Divides some clusters where the rule says so. Returns their children, which are at the end of `clusters` now.
  std::vector<Index> divide(std::vector<Cluster>& clusters, const std::vector<Index>& some);

 private:
  void divide(Cluster& cluster, bool may_be_one_point, Ends<d>& ends);

  const DivisionRule rule_;
  SortedPoints& sources_;
  SortedPoints* const targets_;
  const int threads_;
  Scratch source_scratch_, target_scratch_;
};

}  // namespace farfield::detail
