// Measures errors of the interpolation. The table of errors is made from them and tested with them.
#pragma once

#include <array>
#include <vector>

#include "farfield/interpolation/coupling.hpp"

namespace farfield::detail {

/// Highest degree in the table.
template <int d>
constexpr int table_degrees = d == 2 ? 32 : 27;

/// Offsets k_1 >= k_2 >= ... of clusters that do not touch while their parents do, in the order of the table.
template <int d>
std::vector<std::array<int, 3>> offset_classes();

/// Largest error, relative to |field| and |potential| of the pair (in 2D the potential's to 1), over `samples` points
/// in each cluster, corners and edges among them. With `climb` the search continues uphill from the worst of them.
template <int d>
double measure_pair_error(const Interpolation<d>& interpolation, const int* k, int samples, unsigned seed, bool climb);

/// The same with the sources alone interpolated, for targets at a distance of 1 or more.
template <int d>
double measure_one_sided_error(const Interpolation<d>& interpolation, int samples, unsigned seed, bool climb);

}  // namespace farfield::detail
