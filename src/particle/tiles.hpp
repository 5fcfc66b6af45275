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
  /// counts where the grid point below it lies; one beyond the lattice counts at its rim. reach: how far a blob is felt, on a
  /// sphere as a chord.
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
  /// lattice as well. Not on a sphere.
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
  // Half the lengths of the box of coordinates that has all places within reach of x.
  Vector extent(const Vector& x) const;
  // The cells with grid points in [from, to] of an axis; nothing if there are none.
  bool cells_between(int axis, double from, double to, std::size_t& low, std::size_t& high) const;
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

inline bool Tiles::cells_between(int axis, double from, double to, std::size_t& low, std::size_t& high) const {
  const double first = std::ceil((from - lattice_.origin[axis]) / lattice_.spacing);
  const double last = std::floor((to - lattice_.origin[axis]) / lattice_.spacing);
  const auto end = static_cast<double>(lattice_.points[axis] - 1);
  if (!(first <= end && last >= 0 && first <= last)) return false;
  low = cell_of_index_[axis][static_cast<std::size_t>(std::max(first, 0.0))];
  high = cell_of_index_[axis][static_cast<std::size_t>(std::min(last, end))];
  return true;
}

template <class Use>
void Tiles::within_reach(const Vector& x, const Use& use) const {
  const Vector half = extent(x);
  Indices low{}, high{};  // cells
  for (int k = lattice_.sphere > 0 ? 1 : 0; k < lattice_.dimension; ++k)
    if (!cells_between(k, x[k] - half[k], x[k] + half[k], low[k], high[k])) return;
  if (!(lattice_.sphere > 0)) return for_each_of(low, high, use);
  // Longitudes come again after a turn: a tile that has been met before begins where those columns do, or before.
  std::size_t met = 0;  // columns below this have been met
  for (const double turn : {-360.0, 0.0, 360.0}) {
    std::size_t first = 0, last = 0;
    if (!cells_between(0, x[0] - half[0] + turn, x[0] + half[0] + turn, first, last)) continue;
    const std::size_t before = met;
    if (before > 0 && border_[0][last + 1] <= before) continue;
    low[0] = first, high[0] = last;
    for_each_of(low, high, [&](std::uint32_t tile) {
      if (before == 0 || list_[tile].first[0] >= before) use(tile);
    });
    met = border_[0][last + 1];
  }
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
