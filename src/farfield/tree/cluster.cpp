#include "farfield/tree/cluster.hpp"

#include <algorithm>

namespace farfield::detail {

void Extent::include(const Coordinates& points, std::size_t dimension, Range range) {
  for (std::size_t l = 0; l < dimension; ++l)
    for (std::size_t i = range.begin; i < range.end; ++i) {
      low[l] = std::min(low[l], points[l][i]);
      high[l] = std::max(high[l], points[l][i]);
    }
}

double Extent::widest(std::size_t dimension) const {
  double widest = 0;
  for (std::size_t l = 0; l < dimension; ++l) widest = std::max(widest, high[l] - low[l]);
  return widest;
}

template <int d>
Cube enclose(const Extent& extent) {
  // A corner of 10 digits after the point and a side of 8 in all: with 41 for the levels these are 53 for coordinates
  // below 4, which the engine sees to.
  Cube cube;
  double widest = 0;
  for (std::size_t l = 0; l < d; ++l) {
    cube.corner[l] = extent.low[l] <= extent.high[l] ? std::floor(std::ldexp(extent.low[l], 10)) / 1024 : 0;
    widest = std::max(widest, extent.high[l] - cube.corner[l]);
  }
  const int exponent = std::max(std::ilogb(std::max(widest, 0x1p-3)), -3) - 7;
  cube.side = std::ldexp(std::floor(std::ldexp(widest, -exponent)) + 1, exponent);
  return cube;
}

template <int d>
bool touch(const Cluster& a, const Cluster& b) {
  const Cluster &coarse = a.level <= b.level ? a : b, &fine = a.level <= b.level ? b : a;
  const int levels = fine.level - coarse.level;
  for (std::size_t l = 0; l < d; ++l) {
    const std::int64_t low = coarse.cell[l] << levels, high = (coarse.cell[l] + 1) << levels;
    if (fine.cell[l] < low - 1 || fine.cell[l] > high) return false;
  }
  return true;
}

template Cube enclose<2>(const Extent&);
template Cube enclose<3>(const Extent&);
template bool touch<2>(const Cluster&, const Cluster&);
template bool touch<3>(const Cluster&, const Cluster&);

}  // namespace farfield::detail
