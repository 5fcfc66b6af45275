#include "fgtd/chebyshev/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "fgtd/chebyshev/cost.hpp"
#include "fgtd/chebyshev/jobs.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {
namespace {

constexpr int side_digits = 12;
constexpr std::size_t block = 256;             // points located at a time
constexpr std::size_t piece_points = 1 << 16;  // points of one piece of parallel work
constexpr double most_counters = 0x1p22;       // of all pieces together

/// The number of `side_digits` binary digits next to x, below or above.
double rounded(double x, bool up) {
  int exponent = 0;
  const double digits = std::ldexp(std::frexp(x, &exponent), side_digits);
  return std::ldexp(up ? std::ceil(digits) : std::floor(digits), exponent - side_digits);
}

/// Boxes of the points begin .. end, one at a time: visit(point, box, local or nullptr).
template <int d, class Visit>
void locate_points(const BoxLattice<d>& lattice, const PointView& points, const BoxIndex<d>& low,
                   const BoxIndex<d>& high, bool with_local, std::size_t begin, std::size_t end, const Visit& visit) {
  double index[d][block], local[d][block];
  for (std::size_t start = begin; start < end; start += block) {
    const std::size_t size = std::min(block, end - start);
    for (std::size_t l = 0; l < d; ++l)
      kernels().locate({.count = size,
                        .coordinate = points.data + l * points.axis_stride + start * points.point_stride,
                        .stride = points.point_stride,
                        .origin = lattice.origin[l],
                        .side = lattice.side[l],
                        .inverse_side = 1 / lattice.side[l],
                        .first = static_cast<double>(low[l] - 1),
                        .last = static_cast<double>(high[l] + 1),
                        .index = index[l],
                        .local = with_local ? local[l] : nullptr});
    for (std::size_t j = 0; j < size; ++j) {
      double at[d], inside[d];
      for (std::size_t l = 0; l < d; ++l) {
        at[l] = index[l][j];
        inside[l] = with_local ? local[l][j] : 0;
      }
      visit(start + j, at, inside);
    }
  }
}

}  // namespace

template <int d>
bool fit_lattice(const std::array<double, d>& low, const std::array<double, d>& extent, double widest,
                 BoxLattice<d>& lattice) {
  if (!(widest > 1e-290) || !(widest < 1e290)) return false;
  for (std::size_t l = 0; l < d; ++l) {
    const double high = low[l] + extent[l];
    double boxes = std::max(1.0, std::ceil(extent[l] / widest));
    if (boxes > 100) boxes = std::ceil(boxes * (1 + 0x1p-10));  // room for the rounding of the side
    if (!(std::max(std::abs(low[l]), std::abs(high)) <= widest * 0x1p39)) return false;
    const double longest = rounded(widest, false);
    for (;; ++boxes) {
      const double side = boxes == 1 ? longest : rounded(extent[l] / boxes, true);
      if (side > longest) continue;
      int exponent = 0;
      std::frexp(side, &exponent);
      const double digit = std::ldexp(1.0, exponent - side_digits);
      lattice.side[l] = side;
      lattice.origin[l] = std::floor(low[l] / digit) * digit;
      if (lattice.origin[l] + boxes * side > high) break;
    }
    lattice.boxes[l] = static_cast<std::int64_t>(boxes);
  }
  return true;
}

namespace {

/// What is sorted: points in the boxes low .. high of a lattice, `axis[0]` the slowest axis of the order.
template <int d>
struct Sorting {
  const BoxLattice<d>& lattice;
  const PointView& points;
  const BoxIndex<d>&low, &high;
  const std::array<int, d>& axis;

  std::size_t place(std::size_t l) const { return static_cast<std::size_t>(axis[l]); }

  bool outside(const double* at) const {
    bool any = false;
    for (std::size_t l = 0; l < d; ++l) {
      any |= at[l] < static_cast<double>(low[l]);
      any |= at[l] > static_cast<double>(high[l]);
    }
    return any;
  }

  double boxes() const {
    double product = 1;
    for (std::size_t l = 0; l < d; ++l) product *= static_cast<double>(high[l] - low[l] + 1);
    return product;
  }

  /// The box of a number in the order.
  BoxIndex<d> box(std::uint64_t number) const {
    BoxIndex<d> index;
    for (std::size_t l = d; l-- > 0;) {
      const std::uint64_t size = static_cast<std::uint64_t>(high[place(l)] - low[place(l)] + 1);
      index[place(l)] = low[place(l)] + static_cast<std::int64_t>(number % size);
      number /= size;
    }
    return index;
  }

  template <class Visit>
  void locate(bool with_local, std::size_t begin, std::size_t end, const Visit& visit) const {
    locate_points<d>(lattice, points, low, high, with_local, begin, end, visit);
  }
};

/// From the numbers of points of every piece and box (`start`, [piece][bin]; the last bin is for points outside) to the
/// places where those points begin, and the boxes that have points. Returns the number of points inside.
template <int d>
std::uint32_t place_bins(const Sorting<d>& sorting, std::size_t pieces, std::size_t bins,
                         std::vector<std::uint32_t>& start, SortedPoints<d>& sorted) {
  std::uint32_t total = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const std::uint32_t begin = total;
    for (std::size_t piece = 0; piece < pieces; ++piece) {
      const std::uint32_t count = start[piece * bins + bin];
      start[piece * bins + bin] = total;
      total += count;
    }
    if (bin + 1 == bins) {
      sorted.outside.resize(total - begin);
      total = begin;
    } else if (total > begin) {
      sorted.box.push_back(sorting.box(bin));
      sorted.first.push_back(begin);
    }
  }
  sorted.first.push_back(total);
  return total;
}

/// The numbers of points of every box and piece give every point its place.
template <int d>
SortedPoints<d> sort_by_counting(const Sorting<d>& sorting, int threads) {
  SortedPoints<d> sorted;
  const std::size_t count = sorting.points.count;
  const std::size_t bins = static_cast<std::size_t>(sorting.boxes()) + 1;  // the last for points outside
  const std::size_t most_pieces = std::max<std::size_t>(1, static_cast<std::size_t>(most_counters) / bins);
  const std::size_t pieces = std::max<std::size_t>(1, std::min((count + piece_points - 1) / piece_points, most_pieces));
  const auto begin_of = [&](std::size_t piece) { return count * piece / pieces; };
  std::array<double, d> stride{};
  double step = 1;
  for (std::size_t l = d; l-- > 0;) {
    const std::size_t at = sorting.place(l);
    stride[at] = step;
    step *= static_cast<double>(sorting.high[at] - sorting.low[at] + 1);
  }
  Buffer<std::uint32_t> key(count);
  const gaussdrift::base::Pieces parts(pieces, 0.5 * cost::chebyshev_sort * static_cast<double>(count));
  std::vector<std::uint32_t> start(pieces * bins, 0);
  gaussdrift::base::parallel_for(parts, threads, [&](std::size_t piece) {
    std::uint32_t* counter = start.data() + piece * bins;
    sorting.locate(false, begin_of(piece), begin_of(piece + 1), [&](std::size_t j, const double* at, const double*) {
      double number = 0;
      for (std::size_t l = 0; l < d; ++l) number += (at[l] - static_cast<double>(sorting.low[l])) * stride[l];
      const std::uint32_t bin =
          sorting.outside(at) ? static_cast<std::uint32_t>(bins - 1) : static_cast<std::uint32_t>(number);
      key[j] = bin;
      ++counter[bin];
    });
  });
  const std::uint32_t total = place_bins<d>(sorting, pieces, bins, start, sorted);
  sorted.order.resize(total);
  sorted.local.resize(d * static_cast<std::size_t>(total));
  gaussdrift::base::parallel_for(parts, threads, [&](std::size_t piece) {
    std::uint32_t* next = start.data() + piece * bins;
    sorting.locate(true, begin_of(piece), begin_of(piece + 1), [&](std::size_t j, const double*, const double* local) {
      const std::size_t to = next[key[j]]++;
      if (key[j] + 1 == bins) {
        sorted.outside[to - total] = static_cast<std::uint32_t>(j);
        return;
      }
      sorted.order[to] = static_cast<std::uint32_t>(j);
      for (std::size_t l = 0; l < d; ++l) sorted.local[to * d + l] = local[l];
    });
  });
  return sorted;
}

/// For far more boxes than points.
template <int d>
SortedPoints<d> sort_by_comparison(const Sorting<d>& sorting) {
  SortedPoints<d> sorted;
  std::vector<BoxIndex<d>> index;  // the slowest axis last, as sorted_places() wants it
  std::vector<std::uint32_t> inside;
  std::vector<double> local;
  sorting.locate(true, 0, sorting.points.count, [&](std::size_t j, const double* at, const double* where) {
    if (sorting.outside(at)) {
      sorted.outside.push_back(static_cast<std::uint32_t>(j));
      return;
    }
    BoxIndex<d> i;
    for (std::size_t l = 0; l < d; ++l) i[d - 1 - l] = static_cast<std::int64_t>(at[sorting.place(l)]);
    index.push_back(i);
    inside.push_back(static_cast<std::uint32_t>(j));
    local.insert(local.end(), where, where + d);
  });
  const std::vector<std::size_t> places = sorted_places<d>(index);
  for (std::size_t j = 0; j < places.size(); ++j) {
    const std::size_t from = places[j];
    if (j == 0 || index[from] != index[places[j - 1]]) {
      BoxIndex<d> box;
      for (std::size_t l = 0; l < d; ++l) box[sorting.place(l)] = index[from][d - 1 - l];
      sorted.box.push_back(box);
      sorted.first.push_back(j);
    }
    sorted.order.push_back(inside[from]);
    for (std::size_t l = 0; l < d; ++l) sorted.local.push_back(local[from * d + l]);
  }
  sorted.first.push_back(places.size());
  return sorted;
}

}  // namespace

template <int d>
SortedPoints<d> sort_points(const BoxLattice<d>& lattice, const PointView& points, const BoxIndex<d>& low,
                            const BoxIndex<d>& high, const std::array<int, d>& axis, int threads) {
  const Sorting<d> sorting{lattice, points, low, high, axis};
  const double boxes = sorting.boxes();
  if (boxes <= 2 * static_cast<double>(points.count) + 4096 && boxes < most_counters)
    return sort_by_counting<d>(sorting, threads);
  return sort_by_comparison<d>(sorting);
}

double sorting_bytes(int d, double points) {
  // order, local and key; or, by sorted_places(), vectors that grew by doubling; and the boxes, at most one a point
  return points * (8.0 * d * 5 + 64) + 4 * most_counters;
}

template <int d>
std::array<BoxLevel, d> make_tree(const std::vector<BoxIndex<d>>& box, const std::array<int, d>& axis) {
  std::array<BoxLevel, d> level;
  for (std::size_t b = 0; b < box.size(); ++b) {
    std::size_t opened = 0;  // the first place in which the box differs from the one before
    if (b > 0)
      while (box[b][static_cast<std::size_t>(axis[opened])] == box[b - 1][static_cast<std::size_t>(axis[opened])])
        ++opened;
    for (std::size_t j = opened; j < d; ++j) {
      level[j].first.push_back(j + 1 < d ? level[j + 1].index.size() : b);
      level[j].index.push_back(box[b][static_cast<std::size_t>(axis[j])]);
    }
  }
  for (std::size_t j = 0; j < d; ++j) level[j].first.push_back(j + 1 < d ? level[j + 1].index.size() : box.size());
  return level;
}

#define FGTD_INSTANTIATE(d)                                                                                         \
  template bool fit_lattice<d>(const std::array<double, d>&, const std::array<double, d>&, double, BoxLattice<d>&); \
  template SortedPoints<d> sort_points<d>(const BoxLattice<d>&, const PointView&, const BoxIndex<d>&,               \
                                          const BoxIndex<d>&, const std::array<int, d>&, int);                      \
  template std::array<BoxLevel, d> make_tree<d>(const std::vector<BoxIndex<d>>&, const std::array<int, d>&);
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
