// The kernel of `direct`; see core/simd/pack.hpp for what may stand here.
#include "core/simd/functions.hpp"
#include "fgtd/kernels/dimensions.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

constexpr std::size_t source_chunk = 256;  // partial sums of so many terms, then added: rounding grows with N/256 + 256
constexpr std::size_t max_outputs = 16;    // sums kept at a time

/// The plain Gaussian, `columns` columns of weights at a time and two packs of targets:
///   out[k][i] = sum_j weights[k][j] exp(-sigma |y_i - x_j|^2)
template <int d, int columns>
void direct_values(const DirectJob& job, const double* weights, double* out) {
  constexpr std::size_t packs = 2 * lanes <= group_size ? 2 : 1;
  for (std::size_t first = 0; first < group_size; first += packs * lanes) {
    Pack y[d][packs];
    for (int l = 0; l < d; ++l)
      for (std::size_t v = 0; v < packs; ++v)
        y[l][v] = load(job.target + static_cast<std::size_t>(l) * group_size + first + v * lanes);
    Pack total[columns][packs] = {};
    for (std::size_t begin = 0; begin < job.sources; begin += source_chunk) {
      const std::size_t end = begin + source_chunk < job.sources ? begin + source_chunk : job.sources;
      Pack partial[columns][packs] = {};
      for (std::size_t j = begin; j < end; ++j) {
        for (std::size_t v = 0; v < packs; ++v) {
          Pack squared{};
          for (int l = 0; l < d; ++l) {
            const Pack distance = y[l][v] - job.position[static_cast<std::size_t>(l) * job.sources + j];
            squared += distance * distance;
          }
          const Pack gaussian = exp_interpolated(squared * -job.sigma);
          for (int k = 0; k < columns; ++k)
            partial[k][v] += gaussian * weights[static_cast<std::size_t>(k) * job.sources + j];
        }
      }
      for (int k = 0; k < columns; ++k)
        for (std::size_t v = 0; v < packs; ++v) total[k][v] += partial[k][v];
    }
    for (int k = 0; k < columns; ++k)
      for (std::size_t v = 0; v < packs; ++v)
        store(out + static_cast<std::size_t>(k) * group_size + first + v * lanes, total[k][v]);
  }
}

template <int d>
void direct_all_values(const DirectJob& job) {
  const double scale = job.coefficient[0];
  for (std::size_t k = 0; k < job.columns; k += 4) {
    const double* weights = job.weights + k * job.sources;
    double* out = job.out + k * group_size;
    switch (job.columns - k) {
      case 1:
        direct_values<d, 1>(job, weights, out);
        break;
      case 2:
        direct_values<d, 2>(job, weights, out);
        break;
      case 3:
        direct_values<d, 3>(job, weights, out);
        break;
      default:
        direct_values<d, 4>(job, weights, out);
    }
  }
  for (std::size_t i = 0; i < job.columns * group_size; ++i) job.out[i] *= scale;
}

/// Derivatives: combinations [q0, q1) for columns [k0, k1). Every |t_l| is clamped to 27: beyond it the Gaussian is
/// exactly 0 and the polynomials stay finite.
template <int d>
void direct_terms(const DirectJob& job, std::size_t q0, std::size_t q1, std::size_t k0, std::size_t k1) {
  for (std::size_t first = 0; first < group_size; first += lanes) {
    Pack total[max_outputs] = {};
    for (std::size_t begin = 0; begin < job.sources; begin += source_chunk) {
      const std::size_t end = begin + source_chunk < job.sources ? begin + source_chunk : job.sources;
      Pack partial[max_outputs] = {};
      for (std::size_t j = begin; j < end; ++j) {
        Pack polynomial[d][max_derivative_order + 1];  // H_n(t_l) / sqrt(2^n n!)
        Pack squared{};
        for (int l = 0; l < d; ++l) {
          const std::size_t axis = static_cast<std::size_t>(l);
          const Pack t = clamp(
              (load(job.target + axis * group_size + first) - job.position[axis * job.sources + j]) * job.root_sigma,
              27.0);
          squared += t * t;
          Pack previous{}, current = broadcast(1.0);
          for (int n = 0; n < job.highest[l]; ++n) {
            const Pack next = t * current * job.recurrence.up[n] - previous * job.recurrence.back[n];
            previous = current;
            current = next;
            polynomial[l][n + 1] = next;
          }
        }
        const Pack gaussian = exp_interpolated(-squared);
        std::size_t output = 0;
        for (std::size_t q = q0; q < q1; ++q) {
          Pack sum{};
          for (std::size_t term = job.first_term[q]; term < job.first_term[q + 1]; ++term) {
            Pack value = gaussian;
            for (int l = 0; l < d; ++l) {
              const int order = job.order[term * max_dimension + static_cast<std::size_t>(l)];
              if (order > 0) value *= polynomial[l][order];
            }
            sum += value * job.coefficient[term];
          }
          for (std::size_t k = k0; k < k1; ++k) partial[output++] += sum * job.weights[k * job.sources + j];
        }
      }
      for (std::size_t output = 0; output < (q1 - q0) * (k1 - k0); ++output) total[output] += partial[output];
    }
    std::size_t output = 0;
    for (std::size_t q = q0; q < q1; ++q)
      for (std::size_t k = k0; k < k1; ++k)
        store(job.out + (q * job.columns + k) * group_size + first, total[output++]);
  }
}

template <int d>
void direct_in(const DirectJob& job) {
  bool plain = job.combinations == 1 && job.first_term[1] == 1;
  for (int l = 0; l < d; ++l) plain = plain && job.highest[l] == 0;
  if (plain) {
    direct_all_values<d>(job);
    return;
  }
  const std::size_t block = job.combinations < max_outputs ? job.combinations : max_outputs;
  const std::size_t column_block = max_outputs / (block > 0 ? block : 1);
  for (std::size_t q = 0; q < job.combinations; q += block)
    for (std::size_t k = 0; k < job.columns; k += column_block)
      direct_terms<d>(job, q, q + block < job.combinations ? q + block : job.combinations, k,
                      k + column_block < job.columns ? k + column_block : job.columns);
}

}  // namespace

void direct(const DirectJob& job) {
  in_dimension(job.dimension, [&](auto dimension) { direct_in<dimension.d>(job); });
}

}  // namespace fgtd::detail::CORE_ISA
