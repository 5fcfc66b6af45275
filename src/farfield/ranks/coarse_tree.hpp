// The upper part of the cluster tree, which all ranks have. Its leaves are cut into as many parts as there are ranks. It
// follows from numbers of points in cells, summed over the ranks.
#pragma once

#include <cstddef>
#include <vector>

#include "farfield/ranks/channel.hpp"
#include "farfield/tree/division.hpp"

namespace farfield::detail {

struct CoarseTree {
  std::vector<Cluster> clusters;   // level by level; ranges count the points of all ranks, in the order of the tree
  std::vector<Index> leaves;       // in the order of the tree
  std::vector<std::size_t> begin;  // of rank r's points: begin[r] .. begin[r + 1]

  std::size_t points() const { return clusters[0].source_count(); }
  Range own(std::size_t rank) const { return {begin[rank], begin[rank + 1]}; }
  /// The rank that a point belongs to.
  std::size_t owner(std::size_t point) const;
  bool is_of(const Cluster& cluster, std::size_t rank) const {
    return begin[rank] <= cluster.sources.begin && cluster.sources.end <= begin[rank + 1] && cluster.source_count() > 0;
  }
};

/// Divides clusters of more points than the rule allows. Afterwards the points of this rank are in the order of the
/// leaves; here[i]: those of leaf i.
template <int d>
CoarseTree make_coarse_tree(const Channel& channel, const DivisionRule& rule, SortedPoints& points,
                            std::vector<Range>& here);

/// May a cluster within `leaf` or around it, of the level of `cluster` or the smallest that it can be, touch the cluster?
/// Then the rank of this leaf needs to know the cluster's children.
template <int d>
bool sees_children(const Cluster& leaf, const Cluster& cluster);

}  // namespace farfield::detail
