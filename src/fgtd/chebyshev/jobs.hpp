// What the kernels of `chebyshev` are given (fgtd/chebyshev/sort_kernels.cpp, node_kernels.cpp). Coordinates within a box are local: -1 on its
// lower face, 1 on its upper.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {

/// Finds boxes and local coordinates of points on one axis: box i covers origin + [i side, (i+1) side). origin and
/// side have so few digits that origin + i side is exact for |i| < 2^41; so is the place in the box, but for one
/// rounding.
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
/// or, with `node` null, the Chebyshev polynomials T_i(z), i < P.
struct AxisBasis {
  int nodes;            // P
  const double* node;   // [P]
  const double* scale;  // [P]
};

/// Points are brought to moments in chunks of so many at most.
constexpr std::size_t moments_chunk = 64;
/// A point sorted by sort_block() is a record of so many numbers: its coordinates and, for d < 4, its first weight.
constexpr std::size_t record_numbers = 4;
constexpr bool record_has_weight(int dimension) { return dimension < static_cast<int>(record_numbers); }
/// Products read so many numbers beyond a row. Set them: a denormal there takes a hundred times as long, though unused.
constexpr std::size_t chain_padding = 8;

/// moments[k][i] += sum_j weights[k][j] prod_l l_{i_l}(z_jl), first axis fastest.
struct MomentsJob {
  int dimension;
  AxisBasis basis;
  std::size_t count;         // <= moments_chunk
  const double* local;       // [count][local_stride]: coordinates of a point; in records its first weight may follow
  std::size_t local_stride;  //
  std::size_t columns;
  const double* weights;  // [columns][weight_stride], but for the first column of records that carry it
  std::size_t weight_stride;
  double* moments;  // [columns][P^dimension]
  double* scratch;  // moments_scratch(...) numbers
};

constexpr std::size_t moments_scratch(int dimension, int nodes, std::size_t columns) {
  const std::size_t p = static_cast<std::size_t>(nodes), padded = (p + 3) / 4 * 4;
  const std::size_t left = dimension <= 1 ? 1 : dimension <= 3 ? p : p * p;
  const std::size_t right = (dimension <= 2 ? p : p * p) + padded + chain_padding;
  return moments_chunk *
             (record_numbers + static_cast<std::size_t>(dimension) * padded + padded + columns * left + right) +
         4 * chain_padding;
}

/// values[q][j] = sum_i coefficients[q][i] prod_l l_{i_l}(z_jl).
struct InterpolateJob {
  int dimension;
  AxisBasis basis;
  std::size_t count;
  const double* local;  // as in MomentsJob
  std::size_t local_stride;
  std::size_t outputs;
  const double* coefficients;  // [outputs][P^dimension]
  double* values;              // [outputs][value_stride]
  std::size_t value_stride;
  double* scratch;  // interpolate_scratch(...) numbers
};

constexpr std::size_t interpolate_scratch(int dimension, int nodes) {
  return static_cast<std::size_t>(dimension) * static_cast<std::size_t>(nodes) * 32 + record_numbers * 32;
}

/// Some points sorted by box, together with their weights. Box i of axis l covers origin + [i side, (i+1) side). The
/// boxes are low .. high. A point elsewhere belongs to the nearest of them, or to none (the last) if its box is beyond
/// least .. most. The box may be missed by rounding: a local coordinate then is beyond 1 by as much.
struct SortBlockJob {
  int dimension;
  std::size_t count;
  const double* coordinate;  // coordinate l of point j at [l axis_stride + j point_stride]
  std::size_t axis_stride, point_stride;
  double origin[max_dimension], side[max_dimension];
  double low[max_dimension], high[max_dimension], least[max_dimension], most[max_dimension];
  double step[max_dimension];  // numbers of boxes from one index to the next
  std::size_t boxes;
  std::size_t columns;
  const double* given_weights;  // [columns][given_stride]
  std::size_t given_stride;
  std::uint32_t* first;  // [boxes + 2]: the points of a box are first[box] .. first[box + 1]; those of none follow
  std::uint32_t* order;  // [count]: which point was sorted there; null: not wanted
  std::uint32_t* key;    // [count + sort_padding], scratch
  double* unsorted;      // [count + sort_padding][record_numbers], scratch
  double* local;         // [count][record_numbers], sorted
  double* weight;        // [columns][weight_stride], sorted; but for the first column where records carry it
  std::size_t weight_stride;
};
constexpr std::size_t sort_padding = 8;

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
