// Small products of matrices in registers: the inner loop of `hermite`, `outer_product` and the filters of `spread`.
// For the sources that may include core/simd/pack.hpp.
#pragma once

#include "core/simd/product_block.hpp"

namespace fgtd::detail::CORE_ISA {

using namespace gaussdrift::core::CORE_ISA;

namespace {

template <int packs>
CORE_INLINE void product_columns(std::size_t rows, std::size_t depth, const double* b, std::size_t b_stride,
                                 const double* d, std::size_t d_stride, double* c, std::size_t c_stride,
                                 std::size_t valid) {
  std::size_t i = 0;
  for (; i + 4 <= rows; i += 4)
    product_block<4, packs>(depth, b + i * b_stride, b_stride, d, d_stride, c + i * c_stride, c_stride, valid);
  b += i * b_stride;
  c += i * c_stride;
  if (rows - i == 3) product_block<3, packs>(depth, b, b_stride, d, d_stride, c, c_stride, valid);
  if (rows - i == 2) product_block<2, packs>(depth, b, b_stride, d, d_stride, c, c_stride, valid);
  if (rows - i == 1) product_block<1, packs>(depth, b, b_stride, d, d_stride, c, c_stride, valid);
}

/// C(rows x width) += B(rows x depth) D(depth x width), all row-major; see ProductJob for what must be readable.
CORE_INLINE void multiply_add(std::size_t rows, std::size_t depth, std::size_t width, const double* b,
                              std::size_t b_stride, const double* d, std::size_t d_stride, double* c,
                              std::size_t c_stride) {
  std::size_t x = 0;
  for (; x + 3 * lanes <= width; x += 3 * lanes)
    product_columns<3>(rows, depth, b, b_stride, d + x, d_stride, c + x, c_stride, lanes);
  const std::size_t rest = width - x;
  if (rest == 0) return;
  const std::size_t packs = (rest + lanes - 1) / lanes, valid = rest - (packs - 1) * lanes;
  if (packs == 1) product_columns<1>(rows, depth, b, b_stride, d + x, d_stride, c + x, c_stride, valid);
  if (packs == 2) product_columns<2>(rows, depth, b, b_stride, d + x, d_stride, c + x, c_stride, valid);
  if (packs == 3) product_columns<3>(rows, depth, b, b_stride, d + x, d_stride, c + x, c_stride, valid);
}

}  // namespace
}  // namespace fgtd::detail::CORE_ISA
