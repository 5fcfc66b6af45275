// Sorts points into boxes; see boxes.hpp.
#include "fgtd/boxes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace fgtd::detail {
namespace {

constexpr double far_index = 0x1p45;  // beyond every occupied box, and safe to subtract

/// The number of bits of a digit, so that few passes of about as many bits each sort keys up to `largest`.
constexpr int most_digit_bits = 11;
int digit_bits(std::uint64_t largest) {
  const int bits = static_cast<int>(std::bit_width(largest)), passes = (bits + most_digit_bits - 1) / most_digit_bits;
  return passes > 0 ? (bits + passes - 1) / passes : 1;
}

/// Where the keys with each digit begin, of all keys.
using DigitStarts = std::array<std::size_t, (std::size_t{1} << most_digit_bits) + 1>;
template <class DigitOf>
DigitStarts digit_starts(std::size_t count, const DigitOf& digit_of) {
  DigitStarts start{};
  for (std::size_t i = 0; i < count; ++i) ++start[digit_of(i) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  return start;
}

/// Stable radix sort of places 0, 1, ... by key.
std::vector<std::size_t> places_by_long_key(std::vector<std::uint64_t> key, std::uint64_t largest) {
  std::vector<std::size_t> place(key.size()), other_place(key.size());
  std::iota(place.begin(), place.end(), std::size_t{0});
  std::vector<std::uint64_t> other_key(key.size());
  const int bits = digit_bits(largest);
  for (int shift = 0; shift < 64 && (largest >> shift) > 0; shift += bits) {
    const auto digit = [&](std::size_t i) { return (key[i] >> shift) & ((std::uint64_t{1} << bits) - 1); };
    DigitStarts start = digit_starts(key.size(), digit);
    for (std::size_t i = 0; i < key.size(); ++i) {
      const std::size_t to = start[digit(i)]++;
      other_key[to] = key[i];
      other_place[to] = place[i];
    }
    key.swap(other_key);
    place.swap(other_place);
  }
  return place;
}

/// The same for keys and places below 2^32, which move together.
std::vector<std::size_t> places_by_short_key(std::vector<std::uint64_t> key, std::uint64_t largest) {
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = key[i] << 32 | i;
  std::vector<std::uint64_t> other(key.size());
  const int bits = digit_bits(largest);
  for (int shift = 0; shift < 32 && (largest >> shift) > 0; shift += bits) {
    const auto digit = [&](std::size_t i) { return (key[i] >> (32 + shift)) & ((std::uint64_t{1} << bits) - 1); };
    DigitStarts start = digit_starts(key.size(), digit);
    for (std::size_t i = 0; i < key.size(); ++i) other[start[digit(i)]++] = key[i];
    key.swap(other);
  }
  std::vector<std::size_t> place(key.size());
  for (std::size_t i = 0; i < key.size(); ++i) place[i] = key[i] & 0xffffffff;
  return place;
}

template <int d>
struct Corners {
  std::array<double, d> low{}, high{};
};

template <int d>
Corners<d> bounding_box(const Buffer<double>& position, std::size_t count) {
  Corners<d> corners;
  for (std::size_t l = 0; l < d; ++l) {
    if (count == 0) continue;
    const auto begin = position.begin() + static_cast<std::ptrdiff_t>(l * count);
    const auto [low, high] = std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(count));
    corners.low[l] = *low;
    corners.high[l] = *high;
  }
  return corners;
}

/// i_l = min(floor((x_l - low_l) / side), boxes of axis l - 1) for every point.
template <int d>
std::vector<BoxIndex<d>> box_indices(const Buffer<double>& position, std::size_t count, double side,
                                     const Corners<d>& corners) {
  std::vector<BoxIndex<d>> index(count);
  for (std::size_t l = 0; l < d; ++l) {
    const double last = std::max(0.0, std::ceil((corners.high[l] - corners.low[l]) / side) - 1);
    for (std::size_t j = 0; j < count; ++j)
      index[j][l] =
          static_cast<std::int64_t>(std::min(std::floor((position[l * count + j] - corners.low[l]) / side), last));
  }
  return index;
}

}  // namespace

template <int d>
std::int64_t Boxes<d>::index_at(std::size_t axis, double y) const {
  return static_cast<std::int64_t>(std::clamp(std::floor((y - low[axis]) / side), -far_index, far_index));
}

template <int d>
bool boxes_resolve(const Buffer<double>& position, std::size_t count, double side) {
  double largest = 0;
  for (std::size_t i = 0; i < d * count; ++i) largest = std::max(largest, std::abs(position[i]));
  return side > std::numeric_limits<double>::min() && std::isfinite(side) && largest <= side * 0x1p40;
}

template <int d>
std::vector<std::size_t> sorted_places(const std::vector<BoxIndex<d>>& index) {
  if (index.empty()) return {};

  // One 64-bit key for each box, if the lattice between the outermost indices has few enough boxes.
  BoxIndex<d> low = index[0], high = index[0];
  for (const auto& i : index)
    for (std::size_t l = 0; l < d; ++l) {
      low[l] = std::min(low[l], i[l]);
      high[l] = std::max(high[l], i[l]);
    }
  double boxes = 1;
  for (std::size_t l = 0; l < d; ++l) boxes *= static_cast<double>(high[l] - low[l] + 1);
  if (boxes < 0x1p62) {
    std::vector<std::uint64_t> key(index.size());
    for (std::size_t j = 0; j < index.size(); ++j) {
      std::uint64_t number = 0;
      for (std::size_t l = d; l-- > 0;)
        number = number * static_cast<std::uint64_t>(high[l] - low[l] + 1) +
                 static_cast<std::uint64_t>(index[j][l] - low[l]);
      key[j] = number;
    }
    const std::uint64_t largest = static_cast<std::uint64_t>(boxes) - 1;
    const bool is_short = (largest | key.size()) >> 32 == 0;
    return is_short ? places_by_short_key(std::move(key), largest) : places_by_long_key(std::move(key), largest);
  }
  std::vector<std::size_t> place(index.size());
  std::iota(place.begin(), place.end(), std::size_t{0});
  std::stable_sort(place.begin(), place.end(), [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(index[a].rbegin(), index[a].rend(), index[b].rbegin(), index[b].rend());
  });
  return place;
}

template <int d>
Boxes<d> make_boxes(Buffer<double>& position, std::size_t count, double side, std::vector<std::size_t>& order) {
  const Corners<d> corners = bounding_box<d>(position, count);
  const std::vector<BoxIndex<d>> index = box_indices<d>(position, count, side, corners);
  order = sorted_places<d>(index);

  Buffer<double> sorted(position.size());
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t j = 0; j < count; ++j) sorted[l * count + j] = position[l * count + order[j]];
  position.swap(sorted);

  Boxes<d> boxes;
  boxes.side = side;
  boxes.low = corners.low;
  for (std::size_t j = 0; j < count; ++j) {
    // The highest axis whose index changes opens a new node in its level and in all below.
    std::size_t opened = j == 0 ? d : 0;
    for (std::size_t l = d; j > 0 && opened == 0 && l-- > 0;)
      if (index[order[j]][l] != index[order[j - 1]][l]) opened = l + 1;
    for (std::size_t l = opened; l-- > 0;) {
      boxes.level[l].first.push_back(l == 0 ? j : boxes.level[l - 1].index.size());
      boxes.level[l].index.push_back(index[order[j]][l]);
    }
    if (opened > 0)
      for (std::size_t l = 0; l < d; ++l)
        boxes.centre.push_back(corners.low[l] + (static_cast<double>(index[order[j]][l]) + 0.5) * side);
  }
  for (std::size_t l = 0; l < d; ++l) boxes.level[l].first.push_back(l == 0 ? count : boxes.level[l - 1].index.size());
  return boxes;
}

template <int d>
Occupation<d> count_boxes(const Buffer<double>& position, std::size_t count, double side) {
  const std::vector<BoxIndex<d>> index = box_indices<d>(position, count, side, bounding_box<d>(position, count));
  const std::vector<std::size_t> order = sorted_places<d>(index);
  Occupation<d> occupation;
  for (std::size_t j = 0; j < count; ++j) {
    std::size_t opened = j == 0 ? d : 0;
    for (std::size_t l = d; j > 0 && opened == 0 && l-- > 0;)
      if (index[order[j]][l] != index[order[j - 1]][l]) opened = l + 1;
    for (std::size_t l = 0; l < opened; ++l) ++occupation.nodes[l];
  }
  return occupation;
}

#define FGTD_INSTANTIATE(d)                                                                         \
  template struct Boxes<d>;                                                                         \
  template bool boxes_resolve<d>(const Buffer<double>&, std::size_t, double);                       \
  template std::vector<std::size_t> sorted_places<d>(const std::vector<BoxIndex<d>>&);              \
  template Boxes<d> make_boxes<d>(Buffer<double>&, std::size_t, double, std::vector<std::size_t>&); \
  template Occupation<d> count_boxes<d>(const Buffer<double>&, std::size_t, double);
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
