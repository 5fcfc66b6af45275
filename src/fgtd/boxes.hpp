// The boxes of `hermite`: a lattice of cubes that starts at the lower corner of the sources. Only occupied boxes exist.
// They are sorted with the last axis slowest and form a tree: slabs of equal last index, in them lines, in them boxes.
// Nothing has a size that depends on sigma.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/buffer.hpp"

namespace fgtd::detail {

using gaussdrift::core::Buffer;

template <int d>
using BoxIndex = std::array<std::int64_t, d>;

/// level[l] lists the distinct (i_l, ..., i_{d-1}); a node's children in level[l-1] are first[node] .. first[node+1].
/// The nodes of level[0] are the boxes, and their "children" are sources.
struct BoxLevel {
  std::vector<std::int64_t> index;  // i_l
  std::vector<std::size_t> first;
};

template <int d>
struct Boxes {
  double side = 0;
  std::array<double, d> low{};  // lower corner of box (0, ..., 0)
  std::array<BoxLevel, d> level;
  std::vector<double> centre;  // [boxes][d]

  std::size_t count() const { return level[0].index.size(); }

  /// Index of the box that holds coordinate y of any target, also outside the lattice.
  std::int64_t index_at(std::size_t axis, double y) const;
};

/// True if boxes of this side can be told apart: every |x| is below 2^40 sides, so that the rounding of a centre moves
/// it by less than side/1000.
template <int d>
bool boxes_resolve(const Buffer<double>& position, std::size_t count, double side);

/// Sorts `position` ([d][count]) into boxes; `order[new place] = old place`. A point on the upper face of the bounding
/// box belongs to the last box.
template <int d>
Boxes<d> make_boxes(Buffer<double>& position, std::size_t count, double side, std::vector<std::size_t>& order);

/// The places of `index` in ascending order (last axis slowest); equal ones keep their order.
template <int d>
std::vector<std::size_t> sorted_places(const std::vector<BoxIndex<d>>& index);

/// How many distinct boxes, lines, ... hold the sample points (level by level), and the extent in boxes.
template <int d>
struct Occupation {
  std::array<double, d> nodes{};  // of level l
};
template <int d>
Occupation<d> count_boxes(const Buffer<double>& position, std::size_t count, double side);

}  // namespace fgtd::detail
