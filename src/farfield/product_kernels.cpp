// Products of small matrices; see kernels_vector.hpp for what may stand here.
#include "farfield/kernels_set.hpp"
#include "farfield/kernels_vector.hpp"

namespace farfield::detail::FARFIELD_ISA {
namespace {

/// `rows` rows of C, `columns` vectors wide, of which the last has `valid` numbers. What is read of B beyond them is
/// the next row or the padding; what comes of it is not stored.
template <int rows, int columns>
FARFIELD_INLINE void block(const ProductJob& job, const double* a, const double* b, double* c, std::size_t valid) {
  Vector sum[rows][columns] = {};
  for (std::size_t k = 0; k < job.depth; ++k) {
    Vector right[columns];
    for (int v = 0; v < columns; ++v) right[v] = load(b + k * job.b_stride + static_cast<std::size_t>(v) * lanes);
    for (int i = 0; i < rows; ++i) {
      const double left = a[static_cast<std::size_t>(i) * job.a_stride + k];
      for (int v = 0; v < columns; ++v) sum[i][v] += right[v] * left;
    }
  }
  for (int i = 0; i < rows; ++i)
    for (int v = 0; v < columns; ++v) {
      double* const to = c + static_cast<std::size_t>(i) * job.c_stride + static_cast<std::size_t>(v) * lanes;
      if (v + 1 < columns || valid == lanes) {
        store(to, load(to) + sum[i][v]);
      } else {
        for (std::size_t x = 0; x < valid; ++x) to[x] += sum[i][v][x];
      }
    }
}

template <int columns>
FARFIELD_INLINE void panel(const ProductJob& job, std::size_t first, std::size_t valid) {
  const double* const b = job.b + first;
  std::size_t i = 0;
  for (; i + 4 <= job.rows; i += 4)
    block<4, columns>(job, job.a + i * job.a_stride, b, job.c + first + i * job.c_stride, valid);
  const double* const a = job.a + i * job.a_stride;
  double* const c = job.c + first + i * job.c_stride;
  if (job.rows - i == 3) block<3, columns>(job, a, b, c, valid);
  if (job.rows - i == 2) block<2, columns>(job, a, b, c, valid);
  if (job.rows - i == 1) block<1, columns>(job, a, b, c, valid);
}

}  // namespace

void product(const ProductJob& job) {
  std::size_t x = 0;
  for (; x + 3 * lanes <= job.width; x += 3 * lanes) panel<3>(job, x, lanes);
  const std::size_t rest = job.width - x;
  if (rest == 0) return;
  const std::size_t count = (rest + lanes - 1) / lanes, valid = rest - (count - 1) * lanes;
  if (count == 1) panel<1>(job, x, valid);
  if (count == 2) panel<2>(job, x, valid);
  if (count == 3) panel<3>(job, x, valid);
}

}  // namespace farfield::detail::FARFIELD_ISA
