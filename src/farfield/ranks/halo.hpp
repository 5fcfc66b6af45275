// What a rank needs of others for its own targets, and gives them: moments of clusters that its own are coupled with, and
// points near its own. Each rank asks once a plan for what its block partition names, so both sides know what is sent.
#pragma once

#include <vector>

#include "farfield/ranks/coarse_tree.hpp"
#include "farfield/tree/partition.hpp"
#include "farfield/tree/transformation.hpp"

namespace farfield::detail {

template <int d>
class Halo {
 public:
  /// `own`: the points of this rank in the order of the tree. Gives the tree these and those of other ranks that are
  /// needed; ranges of the tree and of the partition then count the points that are here.
  Halo(const Channel& channel, const CoarseTree& coarse, SortedPoints own, Tree<d>& tree, Partition& partition,
       Received& received);

  /// Sets the charges of points of other ranks, and moments of their clusters.
  void exchange(Buffer<double>& charges, PerCluster& moments, std::size_t functions) const;

  /// What one exchange brings: numbers of moments times functions, and charges.
  void add_received(std::size_t functions, Received& received) const;

 private:
  struct Wanted {
    std::vector<Index> moments;  // clusters of the tree
    std::vector<Range> points;   // in their order on this rank
  };
  std::vector<Wanted> ask(const Tree<d>& tree, const Partition& partition, const CoarseTree& coarse);
  void place_points(const SortedPoints& own, const std::vector<Bytes>& positions, const std::vector<Wanted>& wanted,
                    const CoarseTree& coarse, Tree<d>& tree, Partition& partition);

  const Channel& channel_;
  std::vector<Wanted> take_, give_;  // by rank
};

}  // namespace farfield::detail
