#include "rbf/near/cells.hpp"

#include <algorithm>
#include <cmath>

namespace rbf::detail {
namespace {

constexpr std::int64_t most_cells = std::int64_t{1} << 20;  // an axis: three of them fit a key

}  // namespace

template <int d>
bool CellGrid<d>::make(const Eigen::Matrix<double, d, 1>& low, const Eigen::Matrix<double, d, 1>& high, double side,
                       CellGrid& lattice) {
  lattice.low = low;
  lattice.side = side;
  for (std::size_t l = 0; l < d; ++l) {
    const double cells = (high[static_cast<Eigen::Index>(l)] - low[static_cast<Eigen::Index>(l)]) / side;
    if (!(cells < static_cast<double>(most_cells - 8))) return false;
    lattice.count[l] = static_cast<std::int64_t>(cells) + 1;
  }
  return true;
}

template <int d>
std::array<std::int64_t, d> CellGrid<d>::cell(const double* point) const {
  std::array<std::int64_t, d> at;
  for (std::size_t l = 0; l < d; ++l) {
    const double x = std::floor((point[l] - low[static_cast<Eigen::Index>(l)]) / side);
    at[l] = static_cast<std::int64_t>(std::clamp(x, -2.0, static_cast<double>(count[l]) + 1));
  }
  return at;
}

template <int d>
std::uint64_t CellGrid<d>::key(const std::array<std::int64_t, d>& at) const {
  std::uint64_t number = 0;
  for (std::size_t l = d; l-- > 0;)
    number = number * static_cast<std::uint64_t>(count[l] + 8) + static_cast<std::uint64_t>(at[l] + 4);
  return number;
}

/// Sorted by eleven bits of the key at a time, from the lowest, which keeps the order of equal keys.
template <int d>
SortedPoints<d>::SortedPoints(const CellGrid<d>& lattice, const double* points, std::size_t count) {
  constexpr std::size_t bits = 11, buckets = std::size_t{1} << bits;
  struct Place {
    std::uint64_t key;
    std::size_t point;
  };
  std::vector<Place> places(count), moved(count);
  std::uint64_t largest = 0;
  for (std::size_t j = 0; j < count; ++j) {
    places[j] = {lattice.key(lattice.cell(points + j * d)), j};
    largest = std::max(largest, places[j].key);
  }
  for (std::size_t shift = 0; shift < 64 && largest >> shift > 0; shift += bits) {
    std::vector<std::size_t> begin(buckets + 1);
    for (const Place& place : places) ++begin[(place.key >> shift) % buckets + 1];
    for (std::size_t i = 0; i < buckets; ++i) begin[i + 1] += begin[i];
    for (const Place& place : places) moved[begin[(place.key >> shift) % buckets]++] = place;
    places.swap(moved);
  }
  order.resize(count);
  for (std::size_t j = 0; j < count; ++j) {
    order[j] = places[j].point;
    if (j == 0 || places[j].key != places[j - 1].key) {
      keys.push_back(places[j].key);
      first.push_back(j);
    }
  }
  first.push_back(count);
}

template struct CellGrid<1>;
template struct CellGrid<2>;
template struct CellGrid<3>;
template struct SortedPoints<1>;
template struct SortedPoints<2>;
template struct SortedPoints<3>;

}  // namespace rbf::detail
