// The block partition decides which pairs of clusters are coupled, which are summed pair by pair, and where one side
// alone is interpolated. A pair of equal size is admissible if the cubes do not touch: diam <= sqrt(d) dist. Every pair
// of a target and a source is in exactly one of
//   couplings      clusters of one size whose parents touch and who do not
//   from_clusters  a leaf of targets and a smaller cluster of sources at a distance of the latter's side or more
//   from_points    a cluster of targets and a larger leaf of sources at a distance of the former's side or more
//   runs           everything else: ranges of sources for a leaf of targets
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "farfield/tree/tree.hpp"

namespace farfield::detail {

/// Lists of many clusters in one array: those of cluster i are entries begin[i] .. begin[i + 1].
template <class Entry>
struct Lists {
  std::vector<std::size_t> begin;
  std::vector<Entry> entries;

  const Entry* first(std::size_t i) const { return entries.data() + begin[i]; }
  std::size_t count(std::size_t i) const { return begin[i + 1] - begin[i]; }
};

/// Couplings of up to `size` targets that follow each other on a level, by offset.
struct CouplingChunk {
  static constexpr std::size_t size = 256;
  struct Pair {
    Index target, source;
  };
  struct Group {
    int k[3];         // centre of the target minus that of the source, in sides
    std::size_t end;  // of its pairs
  };
  int level = 0;
  std::vector<Group> groups;
  std::vector<Pair> pairs;
};

struct Partition {
  std::vector<CouplingChunk> couplings;
  Lists<Index> from_points;    // of clusters of targets
  Lists<Range> runs;           // of leaves of targets; ascending
  Lists<Index> from_clusters;  // of leaves of targets
  double bytes() const;
};

struct PartitionOptions {
  std::size_t enough = 0;  // one side is interpolated alone where the other has more points
  bool couple = true;  // false (method tree): no pair of clusters is coupled, leaves of targets see admissible clusters
  /// The largest size of potentials at the nodes of a cluster of targets, relative to the field that is fitted to them.
  /// Fitting divides their rounding by the side of the cluster.
  double steepest_fit = HUGE_VAL;
  int threads = 1;
};

template <int d>
Partition make_partition(const Tree<d>& tree, const PartitionOptions& options);

/// Counts the work of one evaluation for some clusters of targets, with this many nodes in place of a cluster.
template <int d>
Work work_of(const Partition& partition, const Tree<d>& tree, std::size_t nodes,
             const std::function<bool(Index)>& counts);

}  // namespace farfield::detail
