// What particles give to the nodes of an unbounded lattice, where they give something.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "effect/nodes.hpp"

namespace gaussdrift {

/// What one particle gives to the nodes first .. first + weights.size() - 1 of an axis.
struct AxisWeights {
  std::int64_t first = 0;
  std::vector<double> weights;
};
using NodeWeights = std::array<AxisWeights, max_dimension>;

/// Sums on nodes, in blocks of nodes that exist only where particles are. On several ranks each sums some of the blocks.
class NodeSums {
 public:
  /// Whether the block with this first node is summed here. Empty: all are.
  using IsOwn = std::function<bool(const NodeIndex& first)>;

  /// Throws NumericalError where the blocks would need more bytes than the limit.
  NodeSums(int dimension, std::size_t memory_limit, IsOwn is_own = {});

  /// Calls use(first node) for every block that a particle with these weights reaches.
  template <class Use>
  static void for_each_block(const NodeWeights& axes, int dimension, const Use& use);

  void add(const NodeWeights& axes, double weight);

  double largest() const;

  /// Calls visit(index, value) for all nodes of all blocks that are summed here, line by line: the last axis is slowest.
  template <class Visit>
  void for_each(const Visit& visit) const;

 private:
  static constexpr std::int64_t side = 8;  // nodes of a block on an axis: a few kilobytes in space

  struct Block {
    NodeIndex first{};
    std::vector<double> values;  // none: another rank sums it
  };
  struct Line {  // of nodes along the first axis
    NodeIndex first{};
    const double* values = nullptr;
  };

  static std::int64_t floor_mod(std::int64_t i) { return ((i % side) + side) % side; }
  static std::int64_t first_of_block(std::int64_t i) { return i - floor_mod(i); }

  double* node(const NodeIndex& at);
  std::size_t find_or_make(const NodeIndex& first);
  std::vector<Line> lines() const;

  int dimension_;
  std::size_t memory_limit_, block_size_ = 1, last_ = 0, own_ = 0;
  IsOwn is_own_;
  std::vector<Block> blocks_;
  std::vector<double> elsewhere_;  // what is added to blocks of others comes here and is not looked at
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> by_key_;
};

template <class Use>
void NodeSums::for_each_block(const NodeWeights& axes, int dimension, const Use& use) {
  NodeIndex low{}, high{};
  for (int k = 0; k < dimension; ++k) {
    low[k] = first_of_block(axes[k].first);
    high[k] = first_of_block(axes[k].first + static_cast<std::int64_t>(axes[k].weights.size()) - 1);
  }
  NodeIndex at = low;
  for (at[2] = low[2]; at[2] <= high[2]; at[2] += side)
    for (at[1] = low[1]; at[1] <= high[1]; at[1] += side)
      for (at[0] = low[0]; at[0] <= high[0]; at[0] += side) use(static_cast<const NodeIndex&>(at));
}

template <class Visit>
void NodeSums::for_each(const Visit& visit) const {
  for (const Line& line : lines()) {
    NodeIndex at = line.first;
    for (std::int64_t i = 0; i < side; ++i, ++at[0]) visit(static_cast<const NodeIndex&>(at), line.values[i]);
  }
}

}  // namespace gaussdrift
