// Method `spread`, for dense clouds. It uses a lattice whose spacing depends on the width of the Gaussian
// (fgtd/spread/filter.hpp). Weights are spread onto the nodes around each source once. Every derivative is then a pass of
// banded matrices along each axis: onto the nodes of a grid, or onto the lattice around scattered targets, from where
// phi interpolates.
//   s(y) = sum_k prod_l f(y_l - x_k_l) sum_j lambda_j prod_l phi((x_j - x_k)_l / h)
// The lattice exists in bricks around the sources: one for a cloud, several for clusters far apart. Sources are sorted
// into tiles of a brick. Tiles of one colour never touch the same node, so they are done in parallel, colour after
// colour, and every node still adds its tiles in the same order.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "core/buffer.hpp"
#include "fgtd/fgtd.hpp"
#include "fgtd/kernels/kernels.hpp"
#include "fgtd/request.hpp"
#include "fgtd/situation.hpp"
#include "fgtd/spread/cost.hpp"
#include "fgtd/spread/filter.hpp"
#include "fgtd/summation.hpp"

namespace fgtd::detail {

struct MethodEntry;

using gaussdrift::core::Buffer;

/// The positions k h of the lattice's nodes. Coordinates are taken from an anchor that leaves them exact, and h in two
/// parts of which the first has so few digits that its multiples are exact.
template <int d>
struct LatticeFrame {
  double spacing = 0, inverse_spacing = 0;  // h, 1/h
  double spacing_high = 0, spacing_low = 0;
  std::array<double, d> anchor{};
  int width = 0;  // w

  /// First of the w nodes around x (from the anchor); the kernels may differ from it by one.
  std::int64_t first_node(double x) const {
    constexpr double shift = 0x1.8p52;  // adding it rounds to an integer
    return static_cast<std::int64_t>((x * inverse_spacing + (0.5 - 0.5 * width) + shift) - shift);
  }
  /// x - k h
  double from_node(double x, std::int64_t k) const {
    const double node = static_cast<double>(k);
    return (x - node * spacing_high) - node * spacing_low;
  }
};

/// Nodes a side of a tile; more than the nodes that one source writes.
template <int d>
constexpr std::size_t tile_side(std::size_t axis) {
  static_assert(SpreadFilter::padded_window == 16, "tiles must be wider than what a source writes, and two to spare");
  if (d == 1) return 256;
  return d == 2 || axis == 0 ? 32 : 18;
}

/// Nodes a side of a cell, of which a tile has whole ones: points are sorted by cell, so that the nodes that successive
/// points write or read stay in the nearest cache. A tile of one or two dimensions is small enough.
template <int d>
constexpr std::size_t cell_side(std::size_t axis) {
  return d < 3 ? tile_side<d>(axis) : axis == 0 ? 8 : 6;
}
template <int d>
constexpr std::size_t cells_in_tile() {
  std::size_t cells = 1;
  for (std::size_t l = 0; l < d; ++l) cells *= tile_side<d>(l) / cell_side<d>(l);
  return cells;
}

/// A dense piece of the lattice and its tiles.
template <int d>
struct Brick {
  std::array<std::int64_t, d> first{};  // node of the corner
  std::array<std::size_t, d> nodes{};   // along axis 0 with the padding that kernels write zeros to
  std::array<std::size_t, d> tiles{};
  std::size_t first_tile = 0;  // number of its first tile among all
  std::size_t offset = 0;      // of one column of its nodes, among those of all bricks

  std::size_t size() const;
  std::size_t tile_count() const;
  std::size_t cell_count() const { return tile_count() * cells_in_tile<d>(); }
  /// Number of the cell in which the first node of a point is; cells of a tile follow each other.
  std::size_t cell_of(const LatticeFrame<d>& frame, const std::array<double, d>& x) const {
    std::size_t tile = 0, cell = 0;
    for (std::size_t l = d; l-- > 0;) {
      const std::size_t node = static_cast<std::size_t>(frame.first_node(x[l]) - first[l] - 1);
      tile = tile * tiles[l] + node / tile_side<d>(l);
      cell = cell * (tile_side<d>(l) / cell_side<d>(l)) + node % tile_side<d>(l) / cell_side<d>(l);
    }
    return tile * cells_in_tile<d>() + cell;
  }
};

/// The brick around points whose first nodes lie in low .. high: one node to spare on each side.
template <int d>
Brick<d> brick_around(const std::array<std::int64_t, d>& low, const std::array<std::int64_t, d>& high, int width);

/// Where sources lie.
template <int d>
struct SpreadLayout {
  LatticeFrame<d> frame;
  std::vector<Brick<d>> bricks;
  std::vector<std::uint16_t> brick_of;  // of each source; empty if there is one brick

  std::size_t nodes() const;  // of all bricks
};

/// Lays bricks around the points so that little of the lattice is empty. No bricks if coordinates cannot be told apart
/// on it, or if it would be much larger than the points justify. position [d][count].
template <int d>
std::optional<SpreadLayout<d>> lay_out(const Buffer<double>& position, std::size_t count,
                                       const std::array<double, d>& low, const std::array<double, d>& extent,
                                       double spacing, int width);

/// A Gaussian with its filter.
struct SpreadPart {
  double sigma;
  std::shared_ptr<const SpreadFilter> filter;  // of the same window for all of a lattice
};

template <int d>
class SpreadSum : public Summation<d> {
 public:
  /// One Gaussian, or the sum of several on one lattice. position [d][count]
  SpreadSum(std::vector<SpreadPart> parts, SpreadLayout<d> layout, Buffer<double> position, int threads);

  void set_weights(const double* weights, std::size_t columns) override;
  void evaluate(const Request<d>& request, const double* targets, std::size_t count, double* values) const override;
  void evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const override;

  /// The same for several Gaussians, with a request of each: of the same combinations.
  void evaluate(const std::vector<Request<d>>& requests, const double* targets, std::size_t count,
                double* values) const;
  void evaluate(const std::vector<Request<d>>& requests, const TensorGrid& grid, double* values) const;

  double plan_bytes(std::size_t columns) const override;
  double point_bytes(const Request<d>& request, std::size_t count) const override;
  double grid_bytes(const Request<d>& request, const TensorGrid& grid) const override;
  void count(Choice& choice) const override { std::get<Spread>(choice.parameters).bricks = layout_.bricks.size(); }

 private:
  struct Tile {
    std::size_t brick, number;
  };
  SpreadJob job_for(const Brick<d>& brick) const;
  /// The lattice of a brick of targets after the filters: [outputs][brick.size()], then padding.
  Buffer<double> filtered(const std::vector<Request<d>>& requests, const Brick<d>& source,
                          const Brick<d>& target) const;
  /// F_a(j h) = 0 for |j| beyond, for all Gaussians.
  int lattice_reach() const;
  /// Seconds of so many points that meet the lattice, for a vector of it that takes `vector`.
  double at_lattice(std::size_t points, std::size_t columns, double vector) const;
  /// The first of a tile.
  std::size_t sources_of(std::size_t tile) const { return cell_first_[tile * cells_in_tile<d>()]; }

  std::vector<SpreadPart> parts_;
  SpreadLayout<d> layout_;
  int threads_;
  std::size_t count_ = 0;
  Buffer<double> position_;                // [count][d] from the anchor, sorted by tile
  Buffer<std::uint32_t> place_;            // the caller's source j is sorted source place_[j]
  std::vector<std::uint32_t> cell_first_;  // sources of a cell
  std::array<std::vector<Tile>, std::size_t{1} << d> colour_;
  std::size_t columns_ = 0;
  Buffer<double> lattice_;  // bricks one after the other: [columns][brick.size()], then padding
};

/// The filter of all bricks onto a grid: values[(q columns + k) nodes + i]. Its nodes are coordinates, which f reaches,
/// or phi from a lattice that has been filtered; or they are lattice nodes, which F reaches.
template <int d>
struct FilterTargets {
  std::array<std::vector<double>, d> coordinate;  // from the anchor, ascending
  std::array<std::vector<std::int64_t>, d> node;  // ascending
  bool on_lattice = false;
  bool by_window = false;

  std::size_t size(std::size_t axis) const { return on_lattice ? node[axis].size() : coordinate[axis].size(); }
};

template <int d>
struct FilterJob {
  const SpreadFilter& filter;
  const LatticeFrame<d>& frame;
  double sigma;
  const Request<d>& request;
  std::size_t columns;
  std::vector<const Brick<d>*> bricks;
  std::vector<const double*> lattice;  // of each brick, [columns][brick.size()]
  int threads;
  bool add = false;  // to the result; else it is overwritten
};

/// row_stride: numbers from row to row (along axis 1) of the result; its other axes are without gaps.
template <int d>
void apply_filter(const FilterJob<d>& job, const FilterTargets<d>& targets, std::size_t row_stride,
                  std::size_t output_stride, double* values);

/// Bytes that apply_filter() holds beside its result.
template <int d>
double filter_bytes(const FilterJob<d>& job, const std::array<double, d>& sizes, bool on_lattice);

/// Sorts points into cells by a stable counting sort over fixed pieces: the cell of every point becomes its new place,
/// and move(point, place) is called for each. The points of a cell are at first[cell] .. first[cell + 1].
template <class Move>
void sort_into_cells(Buffer<std::uint32_t>& cell, std::size_t cells, int threads, std::vector<std::uint32_t>& first,
                     const Move& move) {
  const std::size_t count = cell.size();
  const std::size_t piece = std::max<std::size_t>(std::size_t{1} << 16, 4 * cells);
  const std::size_t pieces = (count + piece - 1) / piece;
  std::vector<std::uint32_t> start(pieces * cells, 0);  // [piece][cell]
  const gaussdrift::base::Pieces parts(pieces, 0.5 * cost::spread_sort * static_cast<double>(count));
  gaussdrift::base::parallel_for(parts, threads, [&](std::size_t i) {
    std::uint32_t* const counts = start.data() + i * cells;
    for (std::size_t j = i * piece; j < std::min(count, (i + 1) * piece); ++j) ++counts[cell[j]];
  });
  first.assign(cells + 1, 0);
  std::uint32_t sum = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    first[c] = sum;
    for (std::size_t i = 0; i < pieces; ++i) sum += std::exchange(start[i * cells + c], sum);
  }
  first[cells] = sum;
  gaussdrift::base::parallel_for(parts, threads, [&](std::size_t i) {
    std::uint32_t* const to = start.data() + i * cells;
    for (std::size_t j = i * piece; j < std::min(count, (i + 1) * piece); ++j) {
      cell[j] = to[cell[j]]++;
      move(j, cell[j]);
    }
  });
}

/// Calls body(begin, end) for pieces of 0 .. count, each of which takes so many seconds.
template <class Body>
void in_pieces(std::size_t count, double seconds, int threads, const Body& body) {
  constexpr std::size_t piece = 1 << 14;
  gaussdrift::base::parallel_for({(count + piece - 1) / piece, static_cast<double>(count) * seconds}, threads,
                                 [&](std::size_t i) { body(i * piece, std::min(count, (i + 1) * piece)); });
}

/// Bytes that a plan with that layout will hold, predicted.
template <int d>
double spread_plan_bytes(const Situation<d>& at, const SpreadLayout<d>& layout);

/// The method `spread` for the catalogue.
MethodEntry spread_method();

}  // namespace fgtd::detail
