// Products of small matrices; see core/simd/pack.hpp for what may stand here.
#include "core/simd/product_block.hpp"
#include "farfield/kernels/set.hpp"

namespace farfield::detail::CORE_ISA {
namespace {

constexpr int rows_together = lanes == 8 ? 8 : 4;  // as many sums as there are registers for
constexpr int widest = 3;                          // packs
constexpr std::size_t deepest = 128;               // rows of B that stay in the first cache

/// `rows` rows of C, `columns` packs wide.
template <int rows, int columns>
CORE_INLINE void block(const ProductJob& job, const double* a, const double* b, double* c, std::size_t valid) {
  product_block<rows, columns>(job.depth, a, job.a_stride, b, job.b_stride, c, job.c_stride, valid);
}

/// The rows that are left, fewer than `rows`.
template <int rows, int columns>
CORE_INLINE void last_rows(const ProductJob& job, std::size_t count, const double* a, double* c, std::size_t valid) {
  if constexpr (rows > 0) {
    if (count == rows)
      block<rows, columns>(job, a, job.b, c, valid);
    else
      last_rows<rows - 1, columns>(job, count, a, c, valid);
  }
}

template <int columns>
CORE_INLINE void panel(ProductJob job, std::size_t valid) {
  constexpr std::size_t together = rows_together, width = columns * lanes;
  alignas(64) double packed[deepest * width];  // B's rows may be pages apart
  if (job.rows > together) {
    for (std::size_t k = 0; k < job.depth; ++k)
      for (std::size_t v = 0; v < width; v += lanes) store(packed + k * width + v, load(job.b + k * job.b_stride + v));
    job.b = packed;
    job.b_stride = width;
  }
  std::size_t i = 0;
  for (; i + together <= job.rows; i += together)
    block<rows_together, columns>(job, job.a + i * job.a_stride, job.b, job.c + i * job.c_stride, valid);
  last_rows<rows_together - 1, columns>(job, job.rows - i, job.a + i * job.a_stride, job.c + i * job.c_stride, valid);
}

}  // namespace

void product(const ProductJob& job) {
  for (std::size_t k = 0; k < job.depth; k += deepest)
    for (std::size_t x = 0; x < job.width; x += widest * lanes) {
      ProductJob part = job;
      part.depth = job.depth - k < deepest ? job.depth - k : deepest;
      part.a += k;
      part.b += k * job.b_stride + x;
      part.c += x;
      const std::size_t rest = job.width - x;
      if (rest >= widest * lanes) {
        panel<widest>(part, lanes);
        continue;
      }
      const std::size_t count = (rest + lanes - 1) / lanes, valid = rest - (count - 1) * lanes;
      if (count == 1) panel<1>(part, valid);
      if (count == 2) panel<2>(part, valid);
      if (count == 3) panel<3>(part, valid);
    }
}

}  // namespace farfield::detail::CORE_ISA
