// The coupling of two clusters of one size: from moments of the sources of one to coefficients of the potential in the
// other, both interpolated (symmetric interpolation [Boe22]):
//   g(x, y) ~ sum_ab h_a(x) M_ab h_b(y),   M_ab = sum_ij weight[a][i] g(k + node_i, node_j) weight[b][j]
// for cubes of side 1 whose centres are the whole numbers k apart. The degree follows from k: the farther, the lower.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/buffer.hpp"
#include "farfield/interpolation/interpolation.hpp"

namespace farfield::detail {

using gaussdrift::core::Buffer;

constexpr int farthest = 3;  // |k_l| of clusters whose parents touch

/// It is kept for k_l >= 0 only, because a reflection s of k has sign(a, s) M_ab sign(b, s). Where k_l = 0, functions
/// even in t_l do not couple with odd ones, so M consists of one block or several.
struct Coupling {
  /// The first `count` functions of one parity.
  struct Run {
    unsigned parity;
    std::size_t count;
  };
  struct Block {
    std::vector<Run> runs;               // both of rows and of columns
    std::vector<std::size_t> functions;  // the same one by one
    Buffer<double> matrix;               // [function b of the source][function a of the target]
  };
  int degree = 0;  // 0 where clusters touch: there is none
  std::vector<Block> blocks;
};

/// Number of an offset with all k_l >= 0.
template <int d>
std::size_t octant_number(const int* k) {
  std::size_t number = 0;
  for (int l = d - 1; l >= 0; --l) number = number * (farthest + 1) + static_cast<std::size_t>(k[l]);
  return number;
}
template <int d>
constexpr std::size_t octant_offsets = d == 2 ? 16 : 64;

/// 1/r in 3D, ln r in 2D.
template <int d>
Coupling make_coupling(const Interpolation<d>& interpolation, const int* k);

}  // namespace farfield::detail
