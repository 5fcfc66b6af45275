// Where ranks meet that have to do with the same node of a lattice.
#pragma once

#include <cstddef>
#include <cstdint>

#include "effect/nodes.hpp"

namespace gaussdrift {

/// A rank that follows from the node alone. Blocks of 32 nodes a side are spread over the ranks as if at random.
inline std::size_t meeting_rank(const NodeIndex& node, int dimension, std::size_t ranks) {
  std::uint64_t key = 0;
  for (int k = 0; k < dimension; ++k) key = (key ^ static_cast<std::uint64_t>(node[k] >> 5)) * 0x9e3779b97f4a7c15u;
  return static_cast<std::size_t>((key >> 32) % ranks);
}

}  // namespace gaussdrift
