// What the kernels of `chebyshev` are given (chebyshev_kernels.cpp). Coordinates within a box are local: -1 on its
// lower face, 1 on its upper.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fgtd::detail {

/// Finds boxes and local coordinates of points on one axis: box i covers origin + [i side, (i+1) side).
/// origin and side have so few digits that origin + i side is exact for |i| < 2^41; so is the place in the box then,
/// but for one rounding.
struct LocateJob {
  std::size_t count;
  const double* coordinate;
  std::size_t stride;  // from one point to the next
  double origin, side, inverse_side;
  double first, last;  // box indices are clamped to these
  double* index;       // [count] as whole numbers
  double* local;       // [count]; none if null
};

/// The Lagrange polynomials of the Chebyshev nodes z_i = cos(pi (i + 1/2) / P) of every axis,
///   l_i(z) = scale_i prod_{k != i} (z - z_k).
struct LagrangeBasis {
  int nodes;            // P
  const double* node;   // [P]
  const double* scale;  // [P]
};

/// Points are brought to moments in chunks of so many at most.
constexpr std::size_t moments_chunk = 64;
/// Products read so many numbers beyond a row.
constexpr std::size_t chain_padding = 8;

/// moments[k][i] += sum_j weights[k][j] prod_l l_{i_l}(z_jl), first axis fastest.
struct MomentsJob {
  int dimension;
  LagrangeBasis basis;
  std::size_t count;    // <= moments_chunk
  const double* local;  // [count][dimension]
  std::size_t columns;
  const double* weights;  // [columns][weight_stride]
  std::size_t weight_stride;
  double* moments;  // [columns][P^dimension]
  double* scratch;  // moments_scratch(...) numbers
};

constexpr std::size_t moments_scratch(int dimension, int nodes, std::size_t columns) {
  const std::size_t p = static_cast<std::size_t>(nodes);
  const std::size_t left = dimension <= 1 ? 1 : dimension <= 3 ? p : p * p;
  const std::size_t right = dimension <= 2 ? p : p * p;
  return moments_chunk * (static_cast<std::size_t>(dimension) * p + columns * left + right + 2 * chain_padding + p) +
         4 * chain_padding;
}

/// values[q][j] = sum_i coefficients[q][i] prod_l l_{i_l}(z_jl).
struct InterpolateJob {
  int dimension;
  LagrangeBasis basis;
  std::size_t count;
  const double* local;  // [count][dimension]
  std::size_t outputs;
  const double* coefficients;  // [outputs][P^dimension]
  double* values;              // [outputs][value_stride]
  std::size_t value_stride;
  double* scratch;  // interpolate_scratch(...) numbers
};

constexpr std::size_t interpolate_scratch(int dimension, int nodes) {
  return static_cast<std::size_t>(dimension) * static_cast<std::size_t>(nodes) * 32;
}

/// C(rows x width) = [C +] sum_i B_i(rows x depth) D_i(depth x width), all row-major. Rows of D must be readable up to
/// chain_padding numbers beyond their end.
struct ChainJob {
  std::size_t rows, depth, width;
  std::size_t links;
  const double* const* b;
  std::size_t b_stride;
  const double* const* d;
  std::size_t d_stride;
  double* c;
  std::size_t c_stride;
  bool add;
};

}  // namespace fgtd::detail
