// Layout of the lattice, sorting and spreading; see fgtd/spread/sum.hpp.
#include "fgtd/spread/sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.hpp"
#include "fgtd/boxes.hpp"

namespace fgtd::detail {
namespace {

constexpr std::size_t most_bricks = 64;
constexpr double dense_enough = 32;       // nodes for every source up to which one brick is laid without a second look
constexpr double small_lattice = 0x1p16;  // nodes that need no justification
constexpr double spare_sources = 4;       // bricks may hold so many times the nodes that single sources would need
constexpr double exact_nodes = 0x1p27;    // multiples of spacing_high are exact up to here

constexpr std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

/// A set of occupied tiles, and the part of the lattice around it.
template <int d>
struct Cluster {
  std::vector<std::size_t> tile;  // indices into a list
  std::array<std::int64_t, d> low{}, high{};
  bool settled = false;

  /// Nodes that a brick around it has.
  double nodes(int width) const {
    double product = 1;
    for (std::size_t l = 0; l < d; ++l)
      product *= static_cast<double>(high[l] - low[l] + 1) * static_cast<double>(tile_side<d>(l)) + width;
    return product;
  }
};

template <int d>
Cluster<d> enclose(const std::vector<BoxIndex<d>>& tiles, std::vector<std::size_t> member) {
  Cluster<d> cluster;
  cluster.low = cluster.high = tiles[member[0]];
  for (const std::size_t i : member)
    for (std::size_t l = 0; l < d; ++l) {
      cluster.low[l] = std::min(cluster.low[l], tiles[i][l]);
      cluster.high[l] = std::max(cluster.high[l], tiles[i][l]);
    }
  cluster.tile = std::move(member);
  return cluster;
}

/// Cuts a cluster in two by the plane that leaves the fewest nodes; false if no plane saves a fifth.
template <int d>
bool split(const std::vector<BoxIndex<d>>& tiles, int width, Cluster<d>& cluster, Cluster<d>& other) {
  const double whole = cluster.nodes(width);
  double best = 0.8 * whole;
  std::size_t best_axis = d, best_count = 0;
  std::vector<std::size_t> sorted = cluster.tile;
  std::vector<double> behind(sorted.size());
  const auto by_axis = [&](std::size_t axis) {
    std::sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
      return tiles[a][axis] != tiles[b][axis] ? tiles[a][axis] < tiles[b][axis] : a < b;
    });
  };
  for (std::size_t axis = 0; axis < d; ++axis) {
    by_axis(axis);
    Cluster<d> part;
    const auto grow = [&](std::size_t i, bool first) {
      if (first) part.low = part.high = tiles[i];
      for (std::size_t l = 0; l < d; ++l) {
        part.low[l] = std::min(part.low[l], tiles[i][l]);
        part.high[l] = std::max(part.high[l], tiles[i][l]);
      }
      return part.nodes(width);
    };
    for (std::size_t i = sorted.size(); i-- > 0;) behind[i] = grow(sorted[i], i + 1 == sorted.size());
    for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
      const double nodes = grow(sorted[i], i == 0) + behind[i + 1];
      if (nodes < best && tiles[sorted[i]][axis] != tiles[sorted[i + 1]][axis]) {
        best = nodes;
        best_axis = axis;
        best_count = i + 1;
      }
    }
  }
  if (best_axis == d) return false;
  by_axis(best_axis);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(best_count);
  other = enclose<d>(tiles, {middle, sorted.end()});
  cluster = enclose<d>(tiles, {sorted.begin(), middle});
  return true;
}

/// Clusters of tiles far apart, each in a box of its own.
template <int d>
std::vector<Cluster<d>> find_clusters(const std::vector<BoxIndex<d>>& tiles, int width) {
  std::vector<std::size_t> all(tiles.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  std::vector<Cluster<d>> clusters{enclose<d>(tiles, std::move(all))};
  while (clusters.size() < most_bricks) {
    std::size_t largest = clusters.size();
    for (std::size_t i = 0; i < clusters.size(); ++i)
      if (!clusters[i].settled &&
          (largest == clusters.size() || clusters[i].nodes(width) > clusters[largest].nodes(width)))
        largest = i;
    if (largest == clusters.size()) break;
    Cluster<d> other;
    if (split<d>(tiles, width, clusters[largest], other)) {
      clusters.push_back(std::move(other));
    } else {
      clusters[largest].settled = true;
    }
  }
  return clusters;
}

}  // namespace

template <int d>
Brick<d> brick_around(const std::array<std::int64_t, d>& low, const std::array<std::int64_t, d>& high, int width) {
  Brick<d> brick;
  for (std::size_t l = 0; l < d; ++l) {
    const std::size_t span = static_cast<std::size_t>(high[l] - low[l]) + 1;
    const std::size_t written = l == 0 ? SpreadFilter::padded_window : static_cast<std::size_t>(width);
    brick.first[l] = low[l] - 1;
    brick.nodes[l] = span + written + 1;
    brick.tiles[l] = (span + tile_side<d>(l) - 1) / tile_side<d>(l);
  }
  return brick;
}

template <int d>
std::size_t Brick<d>::size() const {
  std::size_t product = 1;
  for (const std::size_t n : nodes) product *= n;
  return product;
}

template <int d>
std::size_t Brick<d>::tile_count() const {
  std::size_t product = 1;
  for (const std::size_t n : tiles) product *= n;
  return product;
}

template <int d>
std::size_t SpreadLayout<d>::nodes() const {
  std::size_t sum = 0;
  for (const auto& brick : bricks) sum += brick.size();
  return sum;
}

namespace {

/// A brick around each cluster of sources, in the frame of `layout`. False if they would have far too many nodes.
template <int d>
bool lay_out_clusters(const Buffer<double>& position, std::size_t count, SpreadLayout<d>& layout) {
  const LatticeFrame<d>& frame = layout.frame;
  std::vector<BoxIndex<d>> node(count), index(count);
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t j = 0; j < count; ++j) {
      node[j][l] = frame.first_node(position[l * count + j] - frame.anchor[l]);
      index[j][l] = floor_divide(node[j][l], static_cast<std::int64_t>(tile_side<d>(l)));
    }
  const std::vector<std::size_t> order = sorted_places<d>(index);
  std::vector<BoxIndex<d>> tiles;
  std::vector<std::size_t> tile_of(count);
  for (const std::size_t j : order) {
    if (tiles.empty() || tiles.back() != index[j]) tiles.push_back(index[j]);
    tile_of[j] = tiles.size() - 1;
  }
  const std::vector<Cluster<d>> clusters = find_clusters<d>(tiles, frame.width);
  std::vector<std::uint16_t> cluster_of(tiles.size());
  for (std::size_t c = 0; c < clusters.size(); ++c)
    for (const std::size_t i : clusters[c].tile) cluster_of[i] = static_cast<std::uint16_t>(c);
  // Bricks fit their sources tightly.
  std::vector<BoxIndex<d>> lowest(clusters.size()), highest(clusters.size());
  std::vector<char> seen(clusters.size(), 0);
  layout.brick_of.resize(count);
  for (std::size_t j = 0; j < count; ++j) {
    const std::size_t c = cluster_of[tile_of[j]];
    layout.brick_of[j] = static_cast<std::uint16_t>(c);
    if (!seen[c]) lowest[c] = highest[c] = node[j];
    seen[c] = 1;
    for (std::size_t l = 0; l < d; ++l) {
      lowest[c][l] = std::min(lowest[c][l], node[j][l]);
      highest[c][l] = std::max(highest[c][l], node[j][l]);
    }
  }
  double nodes = 0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    double product = 1;
    for (std::size_t l = 0; l < d; ++l)
      product *= static_cast<double>(highest[c][l] - lowest[c][l]) + SpreadFilter::padded_window + 2;
    nodes += product;
  }
  const double enough = spare_sources * static_cast<double>(count) * std::pow(frame.width + 2, d);
  if (nodes > enough + most_bricks * small_lattice) return false;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    Brick<d> brick = brick_around<d>(lowest[c], highest[c], frame.width);
    if (c > 0) {
      brick.first_tile = layout.bricks.back().first_tile + layout.bricks.back().tile_count();
      brick.offset = layout.bricks.back().offset + layout.bricks.back().size();
    }
    layout.bricks.push_back(brick);
  }
  return true;
}

}  // namespace

template <int d>
std::optional<SpreadLayout<d>> lay_out(const Buffer<double>& position, std::size_t count,
                                       const std::array<double, d>& low, const std::array<double, d>& extent,
                                       double spacing, int width) {
  SpreadLayout<d> layout;
  LatticeFrame<d>& frame = layout.frame;
  if (!(spacing > 0x1p-900) || !(spacing < 0x1p900) || count == 0 ||
      count > std::numeric_limits<std::uint32_t>::max() / 2)
    return std::nullopt;
  frame.spacing = spacing;
  frame.inverse_spacing = 1 / spacing;
  frame.spacing_high = static_cast<double>(static_cast<float>(std::ldexp(spacing, -std::ilogb(spacing))));
  frame.spacing_high = std::ldexp(frame.spacing_high, std::ilogb(spacing));
  frame.spacing_low = spacing - frame.spacing_high;
  frame.width = width;
  double dense = 1;
  std::array<std::int64_t, d> first{}, last{};
  for (std::size_t l = 0; l < d; ++l) {
    if (!(extent[l] < 0.25 * exact_nodes * spacing)) return std::nullopt;
    // From the origin while nodes are exact there; else all coordinates are within a factor of two of each other.
    const double high = low[l] + extent[l];
    frame.anchor[l] = std::max(std::abs(low[l]), std::abs(high)) < 0.5 * exact_nodes * spacing ? 0 : low[l];
    if (std::abs(frame.anchor[l]) > 0x1p43 * spacing) return std::nullopt;
    first[l] = frame.first_node(low[l] - frame.anchor[l]);
    last[l] = frame.first_node(high - frame.anchor[l]) + 1;
    dense *= static_cast<double>(last[l] - first[l] + 1 + width);
  }
  if (dense <= dense_enough * static_cast<double>(count) + small_lattice) {
    layout.bricks.push_back(brick_around<d>(first, last, width));
    return layout;
  }
  if (!lay_out_clusters<d>(position, count, layout)) return std::nullopt;
  return layout;
}

template <int d>
SpreadSum<d>::SpreadSum(std::vector<SpreadPart> parts, SpreadLayout<d> layout, Buffer<double> position, int threads)
    : parts_(std::move(parts)), layout_(std::move(layout)), threads_(threads), count_(position.size() / d) {
  const auto from_anchor = [&](std::size_t j) {
    std::array<double, d> x;
    for (std::size_t l = 0; l < d; ++l) x[l] = position[l * count_ + j] - layout_.frame.anchor[l];
    return x;
  };
  place_.resize(count_);  // the cell first
  in_pieces(count_, 0.5 * cost::spread_sort, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const Brick<d>& brick = layout_.bricks[layout_.brick_of.empty() ? 0 : layout_.brick_of[j]];
      place_[j] = static_cast<std::uint32_t>(brick.first_tile * cells_in_tile<d>() +
                                             brick.cell_of(layout_.frame, from_anchor(j)));
    }
  });
  const Brick<d>& last = layout_.bricks.back();
  position_.resize(position.size());
  sort_into_cells(place_, last.first_tile * cells_in_tile<d>() + last.cell_count(), threads_, cell_first_,
                  [&](std::size_t j, std::size_t place) {
                    const std::array<double, d> x = from_anchor(j);
                    std::copy_n(x.begin(), d, position_.begin() + static_cast<std::ptrdiff_t>(place * d));
                  });
  for (std::size_t b = 0; b < layout_.bricks.size(); ++b) {
    const Brick<d>& brick = layout_.bricks[b];
    for (std::size_t number = 0; number < brick.tile_count(); ++number) {
      if (sources_of(brick.first_tile + number) == sources_of(brick.first_tile + number + 1)) continue;
      std::size_t rest = number, colour = 0;
      for (std::size_t l = 0; l < d; ++l) {
        colour |= (rest % brick.tiles[l] % 2) << l;
        rest /= brick.tiles[l];
      }
      colour_[colour].push_back({b, brick.first_tile + number});
    }
  }
}

template <int d>
SpreadJob SpreadSum<d>::job_for(const Brick<d>& brick) const {
  SpreadJob job{};
  job.dimension = d;
  const SpreadFilter& filter = *parts_[0].filter;
  job.width = filter.width();
  job.degree = filter.degree();
  job.window = filter.coefficients();
  job.spacing_high = layout_.frame.spacing_high;
  job.spacing_low = layout_.frame.spacing_low;
  job.inverse_spacing = layout_.frame.inverse_spacing;
  std::size_t stride = 1;
  for (std::size_t l = 0; l < d; ++l) {
    job.first[l] = brick.first[l];
    job.stride[l] = stride;
    stride *= brick.nodes[l];
  }
  job.lattice_stride = brick.size();
  return job;
}

template <int d>
void SpreadSum<d>::set_weights(const double* weights, std::size_t columns) {
  columns_ = columns;
  lattice_.resize(columns * layout_.nodes() + SpreadFilter::padded_window);
  in_pieces(lattice_.size(), cost::spread_value, threads_, [&](std::size_t begin, std::size_t end) {
    std::fill(lattice_.data() + begin, lattice_.data() + end, 0.0);
  });
  Buffer<double> sorted(columns * count_);
  in_pieces(count_, 2e-9 * static_cast<double>(columns), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = 0; k < columns; ++k)
      for (std::size_t j = begin; j < end; ++j) sorted[k * count_ + place_[j]] = weights[k * count_ + j];
  });
  for (const auto& tiles : colour_) {
    std::size_t sources = 0;
    for (const Tile& tile : tiles) sources += sources_of(tile.number + 1) - sources_of(tile.number);
    const gaussdrift::base::Pieces pieces(tiles.size(), at_lattice(sources, columns, cost::spread_row));
    gaussdrift::base::parallel_for(pieces, threads_, [&](std::size_t i) {
      const Brick<d>& brick = layout_.bricks[tiles[i].brick];
      SpreadJob job = job_for(brick);
      job.position = position_.data();
      job.weights_stride = count_;
      job.begin = sources_of(tiles[i].number);
      job.end = sources_of(tiles[i].number + 1);
      job.columns = columns;
      job.weights = sorted.data();
      job.lattice = lattice_.data() + columns * brick.offset;
      kernels().spread(job);
    });
  }
}

template <int d>
double SpreadSum<d>::at_lattice(std::size_t points, std::size_t columns, double vector) const {
  const double width = layout_.frame.width, vectors = std::ceil(width / 8);
  return static_cast<double>(points) * vectors *
         (d * (width + 2) * cost::spread_place + static_cast<double>(columns) * std::pow(width, d - 1) * vector);
}

/// Sorted positions and places, the lattice, and while weights are set their sorted copy.
template <int d>
double SpreadSum<d>::plan_bytes(std::size_t columns) const {
  const double cells = static_cast<double>(cell_first_.size());
  return static_cast<double>(count_) * (8.0 * static_cast<double>(d + columns) + 6) +
         (12 + 24.0 / cells_in_tile<d>()) * cells +
         8.0 * static_cast<double>(columns) * static_cast<double>(layout_.nodes());
}

#define FGTD_INSTANTIATE(d)                                                                                            \
                                                                                                                       \
  template struct Brick<d>;                                                                                            \
  template struct SpreadLayout<d>;                                                                                     \
  template Brick<d> brick_around<d>(const std::array<std::int64_t, d>&, const std::array<std::int64_t, d>&, int);      \
  template std::optional<SpreadLayout<d>> lay_out<d>(const Buffer<double>&, std::size_t, const std::array<double, d>&, \
                                                     const std::array<double, d>&, double, int);                       \
  template SpreadSum<d>::SpreadSum(std::vector<SpreadPart>, SpreadLayout<d>, Buffer<double>, int);                     \
  template SpreadJob SpreadSum<d>::job_for(const Brick<d>&) const;                                                     \
  template double SpreadSum<d>::at_lattice(std::size_t, std::size_t, double) const;                                    \
  template void SpreadSum<d>::set_weights(const double*, std::size_t);                                                 \
  template double SpreadSum<d>::plan_bytes(std::size_t) const;
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
