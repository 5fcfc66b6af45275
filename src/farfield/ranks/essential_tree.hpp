// The tree that is essential to a rank: all clusters that it owns, the coarse tree, and of the clusters of other ranks
// those that its own may be coupled with or have beside them. Ranges count the points of all ranks. So the block partition
// of this tree is that of the whole tree, as far as targets of this rank are concerned.
#pragma once

#include <vector>

#include "farfield/cost.hpp"
#include "farfield/ranks/coarse_tree.hpp"
#include "farfield/tree/tree.hpp"

namespace farfield::detail {

/// The forest of a rank: the coarse tree, and behind it the parts of its own leaves; `points` are put in their order. Its
/// clusters are known to all ranks by their numbers in this list.
template <int d>
std::vector<Cluster> make_forest(const CoarseTree& coarse, const DivisionRule& rule, std::size_t rank,
                                 SortedPoints& points, int threads);

/// Exchanges what other ranks need to know of the forests: which clusters there are, and how many points they have.
/// Cluster::number is that in the forest of the cluster's rank. Clusters without targets of this rank have none at all.
template <int d>
Tree<d> make_essential_tree(const Channel& channel, const Cube& cube, const CoarseTree& coarse,
                            const std::vector<Cluster>& forest, double& received);

/// Which clusters of each level a rank counts: its own, and shared ones whose first point is its own. Levels of all ranks.
template <int d>
std::vector<LevelShare> share_levels(const Channel& channel, const CoarseTree& coarse, const Tree<d>& tree);

}  // namespace farfield::detail
