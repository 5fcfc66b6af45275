// Predicted times on one thread. Events are counted on a sample of the clusters of a fine tree, for every largest size
// of a leaf, and multiplied with their costs. The constants are those of a processor with AVX2; only their ratios
// matter for the choice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "farfield/interpolation/operators.hpp"
#include "farfield/near/near_field.hpp"
#include "farfield/tree/tree.hpp"

namespace farfield::detail {

constexpr double fitted_number = 1.2e-9;  // seconds of one function at one node for one function, in a fit
constexpr double table_entry = 12e-9;     // of the kernel at two nodes, with its share of the products

/// Seconds of one pair.
double pair_seconds(const Problem& problem, Precision precision);

/// Seconds of what depends on the degrees alone.
template <int d>
class Costs {
 public:
  Costs(const Problem& problem, const Degrees<d>& degrees, Precisions precisions);

  /// Seconds of making the tables for the degrees, if they do not exist yet.
  double setup(bool couple) const { return setup_ + (couple ? couplings_setup_ : 0); }
  double pair() const { return pair_; }
  double substitute_pair() const { return substitute_pair_; }
  double coupling(const int* k) const { return coupling_[octant_number<d>(k)]; }
  /// From or to the parent.
  double transfer() const { return transfer_; }
  double moments_of_point() const { return moments_; }
  double expansion_at_point() const { return expansion_; }
  /// Nodes that stand for a cluster of sources.
  std::size_t nodes() const { return nodes_; }
  /// Leaves of that size are about the best for points that fill a cube.
  double good_leaf_size() const { return good_leaf_size_; }

 private:
  double setup_ = 0, couplings_setup_ = 0, pair_ = 0, substitute_pair_ = 0, transfer_ = 0, moments_ = 0, expansion_ = 0,
         good_leaf_size_ = 0;
  std::size_t nodes_ = 0;
  double coupling_[octant_offsets<d>] = {};
};

struct Prediction {
  std::size_t leaf_size = 0;
  double seconds = 0;
};

constexpr std::size_t largest_leaf_size = 4096;  // that is ever predicted to be the best

/// The clusters of a level that one rank counts: first .. first + count of its tree. On all ranks there are `total`, and
/// `before` of these stand before its own. Each is counted by one rank.
struct LevelShare {
  std::size_t first = 0, count = 0, before = 0, total = 0;
};

/// Replaces numbers by their sums over all ranks.
using SumOverRanks = std::function<void(std::vector<std::int64_t>& numbers)>;

/// The best leaf size, at least that of the tree, and the time of one plan and one evaluation with it.
template <int d>
Prediction predict(const Tree<d>& fine, std::size_t fine_leaf_size, const Costs<d>& costs, bool couple,
                   const std::vector<LevelShare>& shares, const SumOverRanks& sum);

}  // namespace farfield::detail
