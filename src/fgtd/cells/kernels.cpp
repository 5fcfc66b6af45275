// The kernel of `cells`: sums over runs of sources; see core/simd/pack.hpp for what may stand here. Packs run over
// the targets of a group.
#include "core/simd/pack.hpp"
#include "fgtd/cells/job.hpp"
#include "fgtd/kernels/dimensions.hpp"
#include "fgtd/kernels/power.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

constexpr std::size_t source_chunk = 256;  // partial sums of so many terms, then added: rounding grows with N/256 + 256
constexpr std::size_t max_outputs = 16;    // sums kept at a time

/// The runs of a group in chunks: chunk(begin, end).
template <class Chunk>
CORE_INLINE void for_each_chunk(const CellsJob& job, const CellsGroup& group, const Chunk& chunk) {
  for (std::size_t run = group.first_run; run < group.end_run; ++run) {
    const std::size_t last = job.run[2 * run + 1];
    for (std::size_t begin = job.run[2 * run]; begin < last; begin += source_chunk)
      chunk(begin, begin + source_chunk < last ? begin + source_chunk : last);
  }
}

/// The plain Gaussian at `packs` packs of targets from `first` on, `columns` columns of weights from k on. |y - x|
/// is scaled by sqrt(sigma log2 e), so that the exponential is 2^-squared.
template <int d, int degree, int columns, int packs>
CORE_INLINE void cells_values(const CellsJob& job, const CellsGroup& group, std::size_t first, std::size_t k) {
  const double scale = job.sigma * log2_e, limit = job.squared_reach / job.sigma;
  Pack y[d][packs];
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t v = 0; v < packs; ++v) y[l][v] = load(job.target + l * job.target_stride + first + v * lanes);
  const double* weights = job.weights + k * job.stride;
  Pack total[columns][packs] = {};
  for_each_chunk(job, group, [&](std::size_t begin, std::size_t end) {
    Pack partial[columns][packs] = {};
    for (std::size_t j = begin; j < end; ++j)
      for (int v = 0; v < packs; ++v) {
        Pack squared{};
        for (std::size_t l = 0; l < d; ++l) {
          const Pack apart = y[l][v] - job.position[l * job.stride + j];
          squared += apart * apart;
        }
        const Pack gaussian = power_of_half<degree>(squared, scale, limit);
        for (std::size_t c = 0; c < columns; ++c) partial[c][v] += gaussian * weights[c * job.stride + j];
      }
    for (int c = 0; c < columns; ++c)
      for (int v = 0; v < packs; ++v) total[c][v] += partial[c][v];
  });
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t v = 0; v < packs; ++v)
      store(job.out + (k + c) * job.target_stride + first + v * lanes, total[c][v] * job.coefficient[0]);
}

template <int d, int degree, int columns>
CORE_INLINE void cells_columns(const CellsJob& job, std::size_t k) {
  for (std::size_t g = 0; g < job.groups; ++g) {
    const CellsGroup& group = job.group[g];
    std::size_t i = 0;
    for (; i + lanes < group.targets; i += 2 * lanes)
      cells_values<d, degree, columns, 2>(job, group, group.first + i, k);
    if (i < group.targets) cells_values<d, degree, columns, 1>(job, group, group.first + i, k);
  }
}

template <int d, int degree>
void cells_all_values(const CellsJob& job) {
  std::size_t k = 0;
  for (; k + 4 <= job.columns; k += 4) cells_columns<d, degree, 4>(job, k);
  if (k + 2 <= job.columns) {
    cells_columns<d, degree, 2>(job, k);
    k += 2;
  }
  if (k < job.columns) cells_columns<d, degree, 1>(job, k);
}

/// Combinations [q0, q1) for columns [k0, k1) at `packs` packs of targets.
template <int d, int packs>
void cells_terms(const CellsJob& job, const CellsGroup& group, std::size_t first, std::size_t q0, std::size_t q1,
                 std::size_t k0, std::size_t k1) {
  Pack y[d][packs];
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t v = 0; v < packs; ++v) y[l][v] = load(job.target + l * job.target_stride + first + v * lanes);
  const std::size_t outputs = (q1 - q0) * (k1 - k0);
  Pack total[max_outputs][packs];
  for (std::size_t output = 0; output < outputs; ++output)
    for (int v = 0; v < packs; ++v) total[output][v] = Pack{};
  for_each_chunk(job, group, [&](std::size_t begin, std::size_t end) {
    Pack partial[max_outputs][packs];
    for (std::size_t output = 0; output < outputs; ++output)
      for (int v = 0; v < packs; ++v) partial[output][v] = Pack{};
    for (std::size_t j = begin; j < end; ++j) {
      Pack polynomial[d][max_derivative_order + 1][packs];  // H_n(t_l) / sqrt(2^n n!)
      Pack gaussian[packs];
      Bits within[packs];  // beyond the reach the polynomials may overflow
      for (int v = 0; v < packs; ++v) {
        Pack squared{};
        for (std::size_t l = 0; l < d; ++l) {
          const Pack t = (y[l][v] - job.position[l * job.stride + j]) * job.root_sigma;
          squared += t * t;
          Pack previous{}, current = broadcast(1.0);
          for (int n = 0; n < job.highest[l]; ++n) {
            const Pack next = t * current * job.recurrence.up[n] - previous * job.recurrence.back[n];
            previous = current;
            current = next;
            polynomial[l][n + 1][v] = next;
          }
        }
        within[v] = reinterpret_cast<Bits>(squared <= job.squared_reach);
        gaussian[v] = power_of_half<11>(squared, log2_e, job.squared_reach);
      }
      std::size_t output = 0;
      for (std::size_t q = q0; q < q1; ++q) {
        Pack sum[packs] = {};
        for (std::size_t term = job.first_term[q]; term < job.first_term[q + 1]; ++term) {
          Pack value[packs];
          for (int v = 0; v < packs; ++v) value[v] = gaussian[v] * job.coefficient[term];
          for (int l = 0; l < d; ++l) {
            const int order = job.order[term * max_dimension + static_cast<std::size_t>(l)];
            if (order == 0) continue;
            for (int v = 0; v < packs; ++v) value[v] *= polynomial[l][order][v];
          }
          for (int v = 0; v < packs; ++v) sum[v] += value[v];
        }
        for (int v = 0; v < packs; ++v) sum[v] = select(within[v], sum[v]);
        for (std::size_t k = k0; k < k1; ++k, ++output)
          for (int v = 0; v < packs; ++v) partial[output][v] += sum[v] * job.weights[k * job.stride + j];
      }
    }
    for (std::size_t output = 0; output < outputs; ++output)
      for (int v = 0; v < packs; ++v) total[output][v] += partial[output][v];
  });
  std::size_t output = 0;
  for (std::size_t q = q0; q < q1; ++q)
    for (std::size_t k = k0; k < k1; ++k, ++output)
      for (std::size_t v = 0; v < packs; ++v)
        store(job.out + (q * job.columns + k) * job.target_stride + first + v * lanes, total[output][v]);
}

template <int d>
void cells_all_terms(const CellsJob& job) {
  const std::size_t block = job.combinations < max_outputs ? job.combinations : max_outputs;
  const std::size_t column_block = max_outputs / (block > 0 ? block : 1);
  for (std::size_t q = 0; q < job.combinations; q += block)
    for (std::size_t k = 0; k < job.columns; k += column_block) {
      const std::size_t q_end = q + block < job.combinations ? q + block : job.combinations;
      const std::size_t k_end = k + column_block < job.columns ? k + column_block : job.columns;
      for (std::size_t g = 0; g < job.groups; ++g) {
        const CellsGroup& group = job.group[g];
        std::size_t i = 0;
        for (; i + lanes < group.targets; i += 2 * lanes)
          cells_terms<d, 2>(job, group, group.first + i, q, q_end, k, k_end);
        if (i < group.targets) cells_terms<d, 1>(job, group, group.first + i, q, q_end, k, k_end);
      }
    }
}

template <int d>
void cells_in(const CellsJob& job) {
  bool plain = job.combinations == 1 && job.first_term[1] == 1;
  for (int l = 0; l < d; ++l) plain = plain && job.highest[l] == 0;
  if (!plain) return cells_all_terms<d>(job);
  switch (job.degree) {
    case 4:
      return cells_all_values<d, 4>(job);
    case 6:
      return cells_all_values<d, 6>(job);
    case 8:
      return cells_all_values<d, 8>(job);
    default:
      return cells_all_values<d, 11>(job);
  }
}

}  // namespace

void cells(const CellsJob& job) {
  in_dimension(job.dimension, [&](auto dimension) { cells_in<dimension.d>(job); });
}

}  // namespace fgtd::detail::CORE_ISA
