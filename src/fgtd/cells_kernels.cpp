// The kernel of `cells`: pair sums over runs of sources; see kernels_vector.hpp for what may stand here. Vectors run
// over sources, which are brought near first: shifted to an origin among the targets, scaled, and without gaps.
#include "fgtd/cells_job.hpp"
#include "fgtd/kernels_power.hpp"
#include "fgtd/kernels_set.hpp"
#include "fgtd/kernels_vector.hpp"

namespace fgtd::detail::FGTD_ISA {
namespace {

/// The sum of the lanes, in pairs.
FGTD_INLINE double sum_of_lanes(Vector x) {
  double part[lanes];
  store(part, x);
  for (std::size_t width = lanes / 2; width > 0; width /= 2)
    for (std::size_t i = 0; i < width; ++i) part[i] += part[i + width];
  return part[0];
}

constexpr std::size_t chunk_stride = cell_chunk + source_padding;

/// Brings the next sources of the runs near, at most cell_chunk of them: local [d][chunk_stride] = (x - origin) scale,
/// then `columns` weights. Returns their number, rounded up to whole vectors by sources of weight 0.
template <int d>
FGTD_INLINE std::size_t bring_near(const CellsJob& job, double scale, const double* weights, std::size_t columns,
                                   std::size_t& run, std::size_t& begin, double* local) {
  std::size_t filled = 0;
  while (run < job.runs && filled < cell_chunk) {
    const std::size_t left = job.run[2 * run + 1] - begin, room = cell_chunk - filled;
    const std::size_t taken = left < room ? left : room;
    for (int l = 0; l < d; ++l) {
      const double* from = job.position + static_cast<std::size_t>(l) * job.stride + begin;
      double* to = local + static_cast<std::size_t>(l) * chunk_stride + filled;
      for (std::size_t j = 0; j < taken; j += lanes) store(to + j, (load(from + j) - job.origin[l]) * scale);
    }
    for (std::size_t k = 0; k < columns; ++k) {
      double* to = local + (d + k) * chunk_stride + filled;
      for (std::size_t j = 0; j < taken; j += lanes) store(to + j, load(weights + k * job.stride + begin + j));
    }
    filled += taken;
    begin += taken;
    if (taken == left && ++run < job.runs) begin = job.run[2 * run];
  }
  for (std::size_t row = 0; row < d + columns; ++row) store(local + row * chunk_stride + filled, Vector{});
  return (filled + lanes - 1) / lanes * lanes;
}

/// Plain sums of `targets` targets from i on, over one chunk of `sources` sources; one column.
template <int d, int degree, int targets>
FGTD_INLINE void cells_values_at(const CellsJob& job, double scale, double limit, const double* local,
                                 std::size_t sources, std::size_t i, double* out) {
  double y[d][targets];
  for (int l = 0; l < d; ++l)
    for (std::size_t a = 0; a < targets; ++a)
      y[l][a] = (job.target[static_cast<std::size_t>(l) * cell_targets + i + a] - job.origin[l]) * scale;
  Vector sum[targets] = {};
  for (std::size_t j = 0; j < sources; j += lanes) {
    Vector x[d];
    for (int l = 0; l < d; ++l) x[l] = load(local + static_cast<std::size_t>(l) * chunk_stride + j);
    const Vector weight = load(local + d * chunk_stride + j);
    for (std::size_t a = 0; a < targets; ++a) {
      Vector squared{};
      for (int l = 0; l < d; ++l) {
        const Vector distance = x[l] - y[l][a];
        squared += distance * distance;
      }
      sum[a] += power_of_half<degree>(squared, limit) * weight;
    }
  }
  for (std::size_t a = 0; a < targets; ++a) out[i + a] += sum_of_lanes(sum[a]);
}

/// |y - x| is scaled by sqrt(sigma log2 e), so that the exponential is 2^-squared.
template <int d, int degree>
void cells_values(const CellsJob& job) {
  const double scale = job.root_sigma * 0x1.337cc2183b050p+0;  // sqrt(log2 e)
  const double limit = job.squared_reach * log2_e;
  for (std::size_t k = 0; k < job.columns; ++k) {
    double* out = job.out + k * cell_targets;
    for (std::size_t i = 0; i < job.targets; ++i) out[i] = 0;
    std::size_t run = 0, begin = job.runs > 0 ? job.run[0] : 0;
    while (run < job.runs) {
      const std::size_t sources = bring_near<d>(job, scale, job.weights + k * job.stride, 1, run, begin, job.scratch);
      std::size_t i = 0;
      for (; i + 4 <= job.targets; i += 4)
        cells_values_at<d, degree, 4>(job, scale, limit, job.scratch, sources, i, out);
      if (i + 2 <= job.targets) {
        cells_values_at<d, degree, 2>(job, scale, limit, job.scratch, sources, i, out);
        i += 2;
      }
      if (i < job.targets) cells_values_at<d, degree, 1>(job, scale, limit, job.scratch, sources, i, out);
    }
    for (std::size_t i = 0; i < job.targets; ++i) out[i] *= job.coefficient[0];
  }
}

template <int d>
void cells_all_values(const CellsJob& job) {
  switch (job.degree) {
    case 4:
      return cells_values<d, 4>(job);
    case 6:
      return cells_values<d, 6>(job);
    case 8:
      return cells_values<d, 8>(job);
    default:
      return cells_values<d, 11>(job);
  }
}

/// Combinations [q0, q1) for columns [k0, k1). Every |t_l| is clamped to 27, beyond every reach, so that the
/// polynomials stay finite where the Gaussian is 0.
template <int d>
void cells_terms(const CellsJob& job, std::size_t q0, std::size_t q1, std::size_t k0, std::size_t k1) {
  const std::size_t columns = k1 - k0, outputs = (q1 - q0) * columns;
  for (std::size_t q = q0; q < q1; ++q)
    for (std::size_t k = k0; k < k1; ++k)
      for (std::size_t i = 0; i < job.targets; ++i) job.out[(q * job.columns + k) * cell_targets + i] = 0;
  std::size_t run = 0, begin = job.runs > 0 ? job.run[0] : 0;
  while (run < job.runs) {
    const std::size_t sources =
        bring_near<d>(job, job.root_sigma, job.weights + k0 * job.stride, columns, run, begin, job.scratch);
    for (std::size_t i = 0; i < job.targets; ++i) {
      double y[d];
      for (std::size_t l = 0; l < d; ++l) y[l] = (job.target[l * cell_targets + i] - job.origin[l]) * job.root_sigma;
      Vector sums[cells_outputs];
      for (std::size_t output = 0; output < outputs; ++output) sums[output] = Vector{};
      for (std::size_t j = 0; j < sources; j += lanes) {
        Vector polynomial[d][max_derivative_order + 1];  // H_n(t_l) / sqrt(2^n n!)
        Vector squared{};
        for (int l = 0; l < d; ++l) {
          const Vector t = clamp(y[l] - load(job.scratch + static_cast<std::size_t>(l) * chunk_stride + j), 27.0);
          squared += t * t;
          Vector previous{}, current = broadcast(1.0);
          for (int n = 0; n < job.highest[l]; ++n) {
            const Vector next = t * current * job.recurrence.up[n] - previous * job.recurrence.back[n];
            previous = current;
            current = next;
            polynomial[l][n + 1] = next;
          }
        }
        const Vector gaussian =
            select(reinterpret_cast<Bits>(squared <= job.squared_reach), power_of_half<11>(squared * log2_e, 1000.0));
        std::size_t output = 0;
        for (std::size_t q = q0; q < q1; ++q) {
          Vector sum{};
          for (std::size_t term = job.first_term[q]; term < job.first_term[q + 1]; ++term) {
            Vector value = gaussian;
            for (int l = 0; l < d; ++l) {
              const int order = job.order[term * max_dimension + static_cast<std::size_t>(l)];
              if (order > 0) value *= polynomial[l][order];
            }
            sum += value * job.coefficient[term];
          }
          for (std::size_t k = 0; k < columns; ++k)
            sums[output++] += sum * load(job.scratch + (d + k) * chunk_stride + j);
        }
      }
      std::size_t output = 0;
      for (std::size_t q = q0; q < q1; ++q)
        for (std::size_t k = k0; k < k1; ++k)
          job.out[(q * job.columns + k) * cell_targets + i] += sum_of_lanes(sums[output++]);
    }
  }
}

template <int d>
void cells_in(const CellsJob& job) {
  bool plain = job.columns == 1 && job.combinations == 1 && job.first_term[1] == 1;
  for (int l = 0; l < d; ++l) plain = plain && job.highest[l] == 0;
  if (plain) {
    cells_all_values<d>(job);
    return;
  }
  const std::size_t block = job.combinations < cells_outputs ? job.combinations : cells_outputs;
  const std::size_t column_block = cells_outputs / (block > 0 ? block : 1);
  for (std::size_t q = 0; q < job.combinations; q += block)
    for (std::size_t k = 0; k < job.columns; k += column_block)
      cells_terms<d>(job, q, q + block < job.combinations ? q + block : job.combinations, k,
                     k + column_block < job.columns ? k + column_block : job.columns);
}

}  // namespace

void cells(const CellsJob& job) {
  switch (job.dimension) {
    case 1:
      return cells_in<1>(job);
    case 2:
      return cells_in<2>(job);
    case 3:
      return cells_in<3>(job);
    default:
      return cells_in<4>(job);
  }
}

}  // namespace fgtd::detail::FGTD_ISA
