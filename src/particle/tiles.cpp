#include "particle/tiles.hpp"

#include <bit>
#include <numbers>
#include <utility>

#include "base/parallel.hpp"
#include "base/sphere.hpp"

namespace gaussdrift {

namespace {

// A tile of fewer points on an axis would be mostly border.
constexpr double fewest_points = 16;

// Pieces of points for threads: not too many, because each keeps a count for every tile.
struct Chunks {
  explicit Chunks(std::size_t points) : length(std::max<std::size_t>(65536, points / 64 + 1)) {
    count = (points + length - 1) / length;
    end = points;
  }
  std::size_t length, count, end;
  template <class Use>
  void each(std::size_t chunk, const Use& use) const {
    for (std::size_t j = chunk * length; j < std::min(end, (chunk + 1) * length); ++j) use(j);
  }
  base::Pieces pieces() const { return {count, 30e-9 * static_cast<double>(end)}; }
};

}  // namespace

TileLimits usual_tiles(int dimension) {
  return {.particles = std::int64_t{1} << (dimension == 2 ? 18 : 20), .points = std::int64_t{1} << 22};
}

Tiles::Tiles(const Lattice& lattice, double reach, const PointsView& particles, const TileLimits& limits,
             const SumOverProcesses& sum)
    : lattice_(lattice), reach_(reach), pieces_(limits.pieces) {
  std::vector<std::int64_t> all{static_cast<std::int64_t>(particles.count)};
  if (sum) sum(all);
  const bool large = all[0] > limits.particles || static_cast<std::int64_t>(lattice.size()) > limits.points;
  const double shortest =
      std::max(fewest_points, std::ceil(limits.reaches * reach / (lattice.spacing * lattice.unit())));
  std::size_t cells = 1;
  for (int k = 0; k < max_dimension; ++k) {
    const std::size_t points = lattice.points[k];
    const double times = static_cast<double>(points) / shortest;
    if (large && k < lattice.dimension && times >= 2) levels_[k] = std::bit_width(static_cast<std::size_t>(times)) - 1;
    levels_[k] = std::max(levels_[k], pieces_[k]);
    const std::size_t count = std::size_t{1} << levels_[k];
    cells *= count;
    for (std::size_t c = 0; c <= count; ++c) border_[k].push_back(c * points / count);
    for (std::size_t c = 0; c < count; ++c)
      cell_of_index_[k].insert(cell_of_index_[k].end(), border_[k][c + 1] - border_[k][c],
                               static_cast<std::uint32_t>(c));
    depth_ = std::max(depth_, levels_[k] - pieces_[k]);
  }

  std::vector<std::vector<std::int64_t>> counts(static_cast<std::size_t>(depth_) + 1);
  std::vector<std::int64_t>& smallest = counts.back();
  smallest.assign(cells, 0);
  if (cells == 1) {
    smallest = all;
  } else {
    for (std::size_t j = 0; j < particles.count; ++j) ++smallest[cell_of(particles.at(j))];
    if (sum) sum(smallest);
  }
  for (int level = depth_; level > 0; --level) {
    const auto at = static_cast<std::size_t>(level);
    const Indices from = cells_at(level), to = cells_at(level - 1);
    counts[at - 1].assign(to[0] * to[1] * to[2], 0);
    for (std::size_t c = 0; c < counts[at].size(); ++c) {
      Indices index{c % from[0], c / from[0] % from[1], c / from[0] / from[1]};
      for (int k = 0; k < max_dimension; ++k)
        if (from[k] > to[k]) index[k] /= 2;
      counts[at - 1][index[0] + to[0] * (index[1] + to[1] * index[2])] += counts[at][c];
    }
  }
  tile_of_cell_.assign(cells, 0);
  const Indices pieces = cells_at(0);
  for (std::size_t l = 0; l < pieces[2]; ++l)
    for (std::size_t j = 0; j < pieces[1]; ++j)
      for (std::size_t i = 0; i < pieces[0]; ++i) divide(counts, limits, 0, {i, j, l});
  for (Tile& tile : list_) tile.sources = sources_of(tile, counts.back());
}

// A cap of the angle theta around the latitude y has longitudes up to asin(sin theta / cos y) to either side, or all of
// them where it has a pole in it.
Vector Tiles::extent(const Vector& x) const {
  if (!(lattice_.sphere > 0)) return {reach_, reach_, reach_};
  const double theta = 2 * std::asin(std::min(1.0, reach_ / (2 * lattice_.sphere)));
  const double y = radians(x[1]), part = std::sin(theta) / std::cos(y);
  const bool has_pole = !(std::abs(y) + theta < std::numbers::pi / 2);
  return {has_pole ? 180 : degrees(std::asin(std::min(1.0, part))), degrees(theta), 0};
}

Tiles::Indices Tiles::cells_at(int level) const {
  Indices cells{};
  for (int k = 0; k < max_dimension; ++k) cells[k] = std::size_t{1} << halvings(k, level);
  return cells;
}

// The longest axes are halved first, so that tiles are nearly cubes.
void Tiles::divide(const std::vector<std::vector<std::int64_t>>& counts, const TileLimits& limits, int level,
                   Indices cell) {
  const Indices cells = cells_at(level);
  Tile tile;
  tile.particles = counts[static_cast<std::size_t>(level)][cell[0] + cells[0] * (cell[1] + cells[1] * cell[2])];
  Indices low{}, high{};  // of the smallest cells in it
  for (int k = 0; k < max_dimension; ++k) {
    const int left = levels_[k] - halvings(k, level);
    low[k] = cell[k] << left, high[k] = (cell[k] + 1) << left;
    tile.first[k] = border_[k][low[k]];
    tile.points[k] = border_[k][high[k]] - tile.first[k];
  }
  const bool large = tile.particles > limits.particles || static_cast<std::int64_t>(tile.size()) > limits.points;
  if (level == depth_ || !large) {
    for (std::size_t l = low[2]; l < high[2]; ++l)
      for (std::size_t j = low[1]; j < high[1]; ++j)
        for (std::size_t i = low[0]; i < high[0]; ++i)
          tile_of_cell_[i + ((j + (l << levels_[1])) << levels_[0])] = static_cast<std::uint32_t>(list_.size());
    list_.push_back(tile);
    return;
  }
  Indices parts{};
  for (int k = 0; k < max_dimension; ++k) parts[k] = halvings(k, level + 1) > halvings(k, level) ? 2 : 1;
  for (std::size_t l = 0; l < parts[2]; ++l)
    for (std::size_t j = 0; j < parts[1]; ++j)
      for (std::size_t i = 0; i < parts[0]; ++i)
        divide(counts, limits, level + 1, {cell[0] * parts[0] + i, cell[1] * parts[1] + j, cell[2] * parts[2] + l});
}

// As if particles were spread evenly over each of the smallest cells.
double Tiles::sources_of(const Tile& tile, const std::vector<std::int64_t>& smallest) const {
  const double reach = reach_ / (lattice_.spacing * lattice_.unit());  // in grid points
  Indices low{}, high{};                                               // cells that have a part within reach
  std::array<std::vector<double>, max_dimension> within;               // that part of each of them
  for (int k = 0; k < max_dimension; ++k) {
    const double from = static_cast<double>(tile.first[k]) - reach;
    const double to = static_cast<double>(tile.first[k] + tile.points[k]) + std::max(0.0, reach - 1);
    low[k] = border_[k].size(), high[k] = 0;
    for (std::size_t c = 0; c + 1 < border_[k].size(); ++c) {
      const auto begin = static_cast<double>(border_[k][c]), end = static_cast<double>(border_[k][c + 1]);
      const double part = (std::min(end, to) - std::max(begin, from)) / (end - begin);
      if (part <= 0) continue;
      low[k] = std::min(low[k], c), high[k] = c + 1;
      within[k].push_back(part);
    }
  }
  double sources = 0;
  for (std::size_t l = low[2]; l < high[2]; ++l)
    for (std::size_t j = low[1]; j < high[1]; ++j)
      for (std::size_t i = low[0]; i < high[0]; ++i)
        sources += within[0][i - low[0]] * within[1][j - low[1]] * within[2][l - low[2]] *
                   static_cast<double>(smallest[i + ((j + (l << levels_[1])) << levels_[0])]);
  return sources;
}

std::vector<std::vector<std::size_t>> Tiles::gather(const PointsView& points, const std::vector<char>& wanted,
                                                    int threads) const {
  const Chunks chunks(points.count);
  std::vector<std::vector<std::size_t>> start(chunks.count, std::vector<std::size_t>(list_.size(), 0));
  base::parallel_for(chunks.pieces(), threads, [&](std::size_t c) {
    chunks.each(c, [&](std::size_t j) { within_reach(points.at(j), [&](std::uint32_t t) { ++start[c][t]; }); });
  });
  std::vector<std::vector<std::size_t>> of_tile(list_.size());
  for (std::size_t t = 0; t < list_.size(); ++t) {
    std::size_t before = 0;
    for (auto& of_chunk : start) before += std::exchange(of_chunk[t], before);
    if (wanted[t]) of_tile[t].resize(before);
  }
  base::parallel_for(chunks.pieces(), threads, [&](std::size_t c) {
    chunks.each(c, [&](std::size_t j) {
      within_reach(points.at(j), [&](std::uint32_t t) {
        if (wanted[t]) of_tile[t][start[c][t]++] = j;
      });
    });
  });
  return of_tile;
}

}  // namespace gaussdrift
