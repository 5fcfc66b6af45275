// Products of matrices in registers, the block that fills them. For the sources that may include pack.hpp.
#pragma once

#include "core/simd/pack.hpp"

namespace gaussdrift::core::CORE_ISA {
namespace {

/// C += A B for a block of `rows` rows and `packs` packs of C, the last pack of which holds `valid` numbers. All
/// are row-major. B must be readable up to whole packs; what comes of numbers beyond is not stored.
template <int rows, int packs>
CORE_INLINE void product_block(std::size_t depth, const double* a, std::size_t a_stride, const double* b,
                               std::size_t b_stride, double* c, std::size_t c_stride, std::size_t valid) {
  Pack sum[rows][packs] = {};
  for (std::size_t k = 0; k < depth; ++k) {
    Pack right[packs];
    for (int v = 0; v < packs; ++v) right[v] = load(b + k * b_stride + static_cast<std::size_t>(v) * lanes);
    for (int i = 0; i < rows; ++i) {
      const double left = a[static_cast<std::size_t>(i) * a_stride + k];
      for (int v = 0; v < packs; ++v) sum[i][v] += right[v] * left;
    }
  }
  for (int i = 0; i < rows; ++i) {
    double* row = c + static_cast<std::size_t>(i) * c_stride;
    for (int v = 0; v < packs; ++v) {
      double* at = row + static_cast<std::size_t>(v) * lanes;
      if (v + 1 < packs || valid == lanes) {
        store(at, load(at) + sum[i][v]);
      } else {
        for (std::size_t x = 0; x < valid; ++x) at[x] += sum[i][v][x];
      }
    }
  }
}

}  // namespace
}  // namespace gaussdrift::core::CORE_ISA
