// Points on their way between the ranks that the caller has them on, their homes, and the ranks that sum for them, their
// owners.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "farfield/ranks/coarse_tree.hpp"

namespace farfield::detail {

template <int d>
class Homes {
 public:
  /// Brings the points of this rank, in the order of the leaves (here[i]: those of leaf i), to their owners. `numbers` are
  /// by the caller's order. `own` becomes the points that this rank owns: in the order of the leaves and, within each, of
  /// their numbers. Their `original` counts the points in the order in which they arrived.
  Homes(const Channel& channel, const CoarseTree& coarse, const SortedPoints& points, const std::vector<Range>& here,
        std::span<const std::int64_t> numbers, SortedPoints& own, double& received);

  /// Charges by the caller's order to those by arrival, and results back.
  Buffer<double> charges_here(const Channel& channel, const Buffer<double>& charges) const;
  void results_home(const Channel& channel, const Sums& here, bool potential, Sums& at_home) const;

  std::size_t arrived() const { return arrived_.back(); }
  /// Bytes of charges and results that come from other ranks.
  double received(std::size_t rank, bool potential) const;

 private:
  std::vector<Index> sent_;           // numbers in the caller's order, in the order in which they were sent
  std::vector<std::size_t> sent_to_;  // rank r got sent_[sent_to_[r]] .. sent_[sent_to_[r + 1]]
  std::vector<std::size_t> arrived_;  // those of home r: arrived_[r] .. arrived_[r + 1]
};

}  // namespace farfield::detail
