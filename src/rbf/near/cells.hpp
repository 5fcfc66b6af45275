// Points sorted into the occupied cells of a lattice.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rbf/rbf.hpp"

namespace rbf::detail {

/// The lattice: cells of one side, of which `count` an axis. Cells outside do not exist.
template <int d>
struct CellGrid {
  Eigen::Matrix<double, d, 1> low = Eigen::Matrix<double, d, 1>::Zero();
  double side = 1;
  std::array<std::int64_t, d> count{};

  /// Cells that contain the box [low, high].
  /// @returns nothing, if they are too many to be numbered
  static bool make(const Eigen::Matrix<double, d, 1>& low, const Eigen::Matrix<double, d, 1>& high, double side,
                   CellGrid& lattice);

  /// Cell of a point; -1 or count where the point lies outside on an axis.
  std::array<std::int64_t, d> cell(const double* point) const;
  /// Number of a cell: the first axis runs fastest, and with a cell between rows neighbours never wrap around.
  std::uint64_t key(const std::array<std::int64_t, d>& cell) const;
};

/// Points by cell: points of cell i are order[first[i]] .. order[first[i+1]].
template <int d>
struct SortedPoints {
  std::vector<std::uint64_t> keys;  // of occupied cells, ascending
  std::vector<std::size_t> first;
  std::vector<std::size_t> order;  // equal cells in the order of the points

  SortedPoints() = default;
  SortedPoints(const CellGrid<d>& lattice, const double* points, std::size_t count);
};

}  // namespace rbf::detail
