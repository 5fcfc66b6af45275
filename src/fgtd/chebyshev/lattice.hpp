// The boxes of `chebyshev`: a lattice with a side of its own on every axis, sorting of points into it, and occupied
// boxes as a tree. Nothing has a size that depends on sigma.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/buffer.hpp"
#include "fgtd/boxes.hpp"

namespace fgtd::detail {

using gaussdrift::core::Buffer;

/// Box i of axis l covers origin + [i side, (i+1) side). Sides have 12 significant binary digits and origins are
/// multiples of the last of them, so that origin + i side is exact for |i| < 2^41.
template <int d>
struct BoxLattice {
  std::array<double, d> origin{}, side{};
  std::array<std::int64_t, d> boxes{};  // 0 .. boxes-1 cover the sources
};

/// Boxes that are at most `widest` wide and fit the extent; not narrower than needed. False if coordinates exceed 2^40
/// sides or the side is no ordinary number.
template <int d>
bool fit_lattice(const std::array<double, d>& low, const std::array<double, d>& extent, double widest,
                 BoxLattice<d>& lattice);

/// Points as they are given: coordinate l of point j is at data[l * axis_stride + j * point_stride].
struct PointView {
  const double* data;
  std::size_t axis_stride, point_stride, count;
};

/// Points sorted by box. `axis[0]` is the slowest axis of the order; points outside [low, high] are left out.
template <int d>
struct SortedPoints {
  Buffer<std::uint32_t> order;         // sorted point j is the caller's order[j]
  Buffer<double> local;                // [points][d], -1 .. 1 within the box
  std::vector<BoxIndex<d>> box;        // occupied, by axis
  std::vector<std::size_t> first;      // [boxes + 1], into the points
  std::vector<std::uint32_t> outside;  // points left out
};

/// At most 2^32 points.
template <int d>
SortedPoints<d> sort_points(const BoxLattice<d>& lattice, const PointView& points, const BoxIndex<d>& low,
                            const BoxIndex<d>& high, const std::array<int, d>& axis, int threads);

/// p^n, numbers of a box with p nodes an axis.
constexpr std::size_t to_power(std::size_t p, int n) {
  std::size_t result = 1;
  for (; n > 0; --n) result *= p;
  return result;
}

/// Bytes that sort_points() returns and takes beside, for so many points.
double sorting_bytes(int d, double points);

/// level[j] lists the distinct leading parts (i_{axis[0]}, ..., i_{axis[j]}); the children of a node are
/// first[node] .. first[node+1] of level[j+1]. The nodes of level[d-1] are the boxes.
template <int d>
std::array<BoxLevel, d> make_tree(const std::vector<BoxIndex<d>>& box, const std::array<int, d>& axis);

}  // namespace fgtd::detail
