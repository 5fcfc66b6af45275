// Tiles: parts of an output grid that are summed on their own. They are the leaves of a tree that halves the grid.
// They follow from how many particles lie where and from nothing else, so that any number of processes finds the same.
// docs/distributed.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "gaussdrift/lattice.hpp"
#include "gaussdrift/lattice_pieces.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// When a tile is divided.
struct TileLimits {
  std::int64_t particles = 0;  // if it holds more
  std::int64_t points = 0;     // if it has more grid points
  double reaches = 8;          // and if its halves are no shorter than this many reaches of a blob
  // Whatever these say, a tile lies in one piece of the lattice (lattice_pieces.hpp), which has halved it so often.
  std::array<int, max_dimension> pieces{};
};

/// Those of a run: cases of usual size have one tile.
TileLimits usual_tiles(int dimension);

struct Tile : LatticeBox {
  std::int64_t particles = 0;  // that lie in it
  double sources = 0;          // about how many reach it, these among them
};

class Tiles {
 public:
  /// Adds the counts of all processes to those of this one, entry by entry.
  using SumOverProcesses = std::function<void(std::vector<std::int64_t>&)>;

  /// The tiles of this lattice for these particles, and for those of other processes where `sum` is given. A particle
  /// counts where the grid point below it lies; one beyond the lattice counts at its rim. reach: how far a blob is felt.
  Tiles(const Lattice& lattice, double reach, const PointsView& particles, const TileLimits& limits,
        const SumOverProcesses& sum = {});

  /// Piece after piece, and in each in the order of its tree, so that neighbours in the list are mostly neighbours in
  /// space.
  const std::vector<Tile>& list() const { return list_; }

  /// The number of the tile where a particle at this place counts.
  std::size_t of(const Vector& x) const { return tile_of_cell_[cell_of(x)]; }

  /// Calls use(tile) once for each tile that has grid points within reach of x along every axis.
  template <class Use>
  void within_reach(const Vector& x, const Use& use) const;

  /// Calls use(tile) once for each tile where a particle within reach of x along every axis may count, one beyond the
  /// lattice as well.
  template <class Use>
  void near(const Vector& x, const Use& use) const;

  /// For each tile, the numbers of the points within reach of its grid points, ascending. Only tiles that are wanted
  /// have any. Points far beyond the lattice are in none.
  std::vector<std::vector<std::size_t>> gather(const PointsView& points, const std::vector<char>& wanted,
                                               int threads) const;

 private:
  using Indices = std::array<std::size_t, max_dimension>;

  Indices cells_at(int level) const;
  int halvings(int axis, int level) const {
    return pieces_[axis] + std::max(0, level - (depth_ - (levels_[axis] - pieces_[axis])));
  }
  void divide(const std::vector<std::vector<std::int64_t>>& counts, const TileLimits& limits, int level, Indices cell);
  template <class Use>
  void for_each_of(const Indices& low, const Indices& high, const Use& use) const;
  double sources_of(const Tile& tile, const std::vector<std::int64_t>& smallest) const;
  // Of the grid point at or below a coordinate; those beyond the lattice get the first or the last.
  std::size_t index_below(int axis, double x) const {
    const double steps = std::floor((x - lattice_.origin[axis]) / lattice_.spacing);
    const auto last = static_cast<double>(lattice_.points[axis] - 1);
    return steps > 0 ? static_cast<std::size_t>(std::min(steps, last)) : 0;  // NaN: 0
  }
  std::size_t cell_of(const Vector& x) const {
    std::size_t cell = 0;
    for (int k = lattice_.dimension - 1; k >= 0; --k)
      cell = (cell << levels_[k]) + cell_of_index_[k][index_below(k, x[k])];
    return cell;
  }

  Lattice lattice_;
  double reach_ = 0;
  // The smallest cells that a tile may be: 2^levels_[k] on an axis, of nearly equal numbers of grid points.
  std::array<int, max_dimension> levels_{}, pieces_{};
  int depth_ = 0;  // the most of them, within a piece
  std::array<std::vector<std::uint32_t>, max_dimension> cell_of_index_;
  std::array<std::vector<std::size_t>, max_dimension> border_;  // first index of each cell, and the end
  std::vector<std::uint32_t> tile_of_cell_;                     // first axis fastest
  std::vector<Tile> list_;
};

template <class Use>
void Tiles::within_reach(const Vector& x, const Use& use) const {
  Indices low{}, high{};  // cells
  for (int k = 0; k < lattice_.dimension; ++k) {
    const double first = std::ceil((x[k] - reach_ - lattice_.origin[k]) / lattice_.spacing);
    const double last = std::floor((x[k] + reach_ - lattice_.origin[k]) / lattice_.spacing);
    const auto end = static_cast<double>(lattice_.points[k] - 1);
    if (!(first <= end && last >= 0 && first <= last)) return;
    low[k] = cell_of_index_[k][static_cast<std::size_t>(std::max(first, 0.0))];
    high[k] = cell_of_index_[k][static_cast<std::size_t>(std::min(last, end))];
  }
  for_each_of(low, high, use);
}

template <class Use>
void Tiles::near(const Vector& x, const Use& use) const {
  Indices low{}, high{};
  for (int k = 0; k < lattice_.dimension; ++k) {
    low[k] = cell_of_index_[k][index_below(k, x[k] - reach_)];
    high[k] = cell_of_index_[k][index_below(k, x[k] + reach_)];
  }
  for_each_of(low, high, use);
}

// The tiles of a box of cells.
template <class Use>
void Tiles::for_each_of(const Indices& low, const Indices& high, const Use& use) const {
  const auto tile_at = [&](std::size_t i, std::size_t j, std::size_t l) {
    return tile_of_cell_[i + ((j + (l << levels_[1])) << levels_[0])];
  };
  if (low == high) {
    use(tile_at(low[0], low[1], low[2]));
    return;
  }
  // A tile of several cells is used at the first of them: where no neighbour before belongs to it. Cells of a tile fill
  // a box, so that neighbours tell.
  for (std::size_t l = low[2]; l <= high[2]; ++l)
    for (std::size_t j = low[1]; j <= high[1]; ++j)
      for (std::size_t i = low[0]; i <= high[0]; ++i) {
        const std::uint32_t tile = tile_at(i, j, l);
        const bool seen = (i > low[0] && tile_at(i - 1, j, l) == tile) ||
                          (j > low[1] && tile_at(i, j - 1, l) == tile) || (l > low[2] && tile_at(i, j, l - 1) == tile);
        if (!seen) use(tile);
      }
}

}  // namespace gaussdrift
