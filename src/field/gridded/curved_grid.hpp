// The places of a curvilinear grid: where its points lie, and at which fractional indices a place is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// Between its points a cell is the (bi- or tri-) linear image of a square or cube. Index k of a place counts along axis
/// k of the grid, from 0. The same bits for any number of threads: nothing is remembered between calls.
class CurvedGrid {
 public:
  using Matrix = std::array<Vector, max_dimension>;

  /// `places`: [point * dimension + axis], the first index fastest; `rounding`: by how much they may be wrong. Throws
  /// std::invalid_argument with the indices of a cell that is flat or folded, or turned against the others. Of 3D cells
  /// the volume element is looked at in 27 places.
  CurvedGrid(int dimension, std::array<std::size_t, max_dimension> points, std::vector<double> places, double rounding);

  /// The fractional indices of a place; nothing outside of the grid. By damped Newton steps, to rounding.
  std::optional<Vector> find(const Vector& x) const;
  /// Where fractional indices lie.
  Vector place(const Vector& index) const;
  /// [m][l] = d index m / d x_l, of the cell of these indices.
  Matrix slopes(const Vector& index) const;

  const Vector& least() const { return least_; }
  const Vector& most() const { return most_; }
  /// The largest distance between a place and that of the indices which find() gives for it, of some thousand places.
  double residual() const { return residual_; }
  /// Are all points where those of the other grid are, as far as their rounding tells?
  bool same_places(const CurvedGrid& other) const;

 private:
  struct Cell;
  Cell cell(std::size_t number) const;
  std::size_t cell_at(const Vector& index, Vector& inside) const;
  std::array<std::size_t, max_dimension> bin_of(const Vector& x) const;
  void check_cells() const;
  void sort_into_bins();
  template <class Use>
  void each_bin(std::size_t number, const Use& use) const;

  int dimension_;
  std::array<std::size_t, max_dimension> points_, cells_{1, 1, 1};
  std::vector<double> places_;
  double rounding_, tolerance_ = 0, residual_ = 0;
  Vector least_{}, most_{};
  std::size_t count_ = 1;  // of cells
  // Boxes of equal size cover the grid. Those cells that have a part in box b are in_bin_[first_[b]] and the next ones.
  std::array<std::size_t, max_dimension> bins_{1, 1, 1};
  std::vector<std::uint32_t> first_, in_bin_;
};

}  // namespace gaussdrift
