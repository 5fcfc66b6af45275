// The kernels of `chebyshev` (jobs: chebyshev_jobs.hpp); see kernels_vector.hpp for what may stand here.
#include "fgtd/chebyshev_jobs.hpp"
#include "fgtd/kernels_contract.hpp"
#include "fgtd/kernels_set.hpp"
#include "fgtd/kernels_vector.hpp"

namespace fgtd::detail::FGTD_ISA {
namespace {

// ---------------------------------------------------------------------------------------------------------------
// locate

/// The largest whole number <= x, for |x| < 2^50: adding `shift` rounds to a whole number.
FGTD_INLINE Vector floor_of(Vector x) {
  constexpr double shift = 0x1.8p52;
  const Vector whole = (x + shift) - shift;
  return whole - select(reinterpret_cast<Bits>(whole > x), broadcast(1.0));
}

FGTD_INLINE void locate_vector(const LocateJob& job, Vector x, double* index, double* local) {
  Vector i = clamp((x - job.origin) * job.inverse_side, 0x1p45);
  i = floor_of(i);
  i = i < job.first ? broadcast(job.first) : i;
  i = i > job.last ? broadcast(job.last) : i;
  // The rounding of the quotient may miss the box by one; what is left over says so.
  Vector rest = x - (i * job.side + job.origin);
  const Vector below =
      select(reinterpret_cast<Bits>(rest < 0.0) & reinterpret_cast<Bits>(i > job.first), broadcast(1.0));
  const Vector above =
      select(reinterpret_cast<Bits>(rest >= job.side) & reinterpret_cast<Bits>(i < job.last), broadcast(1.0));
  i = i - below + above;
  store(index, i);
  if (local == nullptr) return;
  rest = x - (i * job.side + job.origin);
  store(local, clamp(rest * (2 * job.inverse_side) - 1.0, 1.0));
}

}  // namespace

void locate(const LocateJob& job) {
  std::size_t j = 0;
  for (; j + lanes <= job.count; j += lanes) {
    Vector x{};
    if (job.stride == 1) {
      x = load(job.coordinate + j);
    } else {
      for (std::size_t v = 0; v < lanes; ++v) x[v] = job.coordinate[(j + v) * job.stride];
    }
    locate_vector(job, x, job.index + j, job.local == nullptr ? nullptr : job.local + j);
  }
  if (j == job.count) return;
  double x[lanes] = {}, index[lanes], local[lanes];
  for (std::size_t v = 0; v < lanes; ++v)
    x[v] = job.coordinate[(j + v < job.count ? j + v : job.count - 1) * job.stride];
  locate_vector(job, load(x), index, local);
  for (std::size_t v = 0; j + v < job.count; ++v) {
    job.index[j + v] = index[v];
    if (job.local != nullptr) job.local[j + v] = local[v];
  }
}

namespace {

// ---------------------------------------------------------------------------------------------------------------
// chain

template <int rows, int vectors>
FGTD_INLINE void chain_block(const ChainJob& job, std::size_t row, std::size_t x, std::size_t valid) {
  Vector sum[rows][vectors] = {};
  for (std::size_t link = 0; link < job.links; ++link) {
    const double* b = job.b[link] + row * job.b_stride;
    const double* d = job.d[link] + x;
    for (std::size_t k = 0; k < job.depth; ++k, d += job.d_stride) {
      Vector right[vectors];
      for (int v = 0; v < vectors; ++v) right[v] = load(d + static_cast<std::size_t>(v) * lanes);
      for (int i = 0; i < rows; ++i) {
        const double left = b[static_cast<std::size_t>(i) * job.b_stride + k];
        for (int v = 0; v < vectors; ++v) sum[i][v] += right[v] * left;
      }
    }
  }
  for (int i = 0; i < rows; ++i) {
    double* to = job.c + (row + static_cast<std::size_t>(i)) * job.c_stride + x;
    for (int v = 0; v < vectors; ++v, to += lanes) {
      if (v + 1 < vectors || valid == lanes) {
        store(to, job.add ? load(to) + sum[i][v] : sum[i][v]);
      } else {
        double last[lanes];
        store(last, sum[i][v]);
        for (std::size_t n = 0; n < valid; ++n) to[n] = job.add ? to[n] + last[n] : last[n];
      }
    }
  }
}

/// Tall enough that the additions of a sum wait for nobody, and no larger than the registers.
template <int vectors>
FGTD_INLINE void chain_columns(const ChainJob& job, std::size_t x, std::size_t valid) {
  constexpr int tall = vectors == 1 ? 8 : 4;
  std::size_t row = 0;
  for (; row + tall <= job.rows; row += tall) chain_block<tall, vectors>(job, row, x, valid);
  if constexpr (tall == 8) {
    if (row + 4 <= job.rows) {
      chain_block<4, vectors>(job, row, x, valid);
      row += 4;
    }
  }
  switch (job.rows - row) {
    case 3:
      return chain_block<3, vectors>(job, row, x, valid);
    case 2:
      return chain_block<2, vectors>(job, row, x, valid);
    case 1:
      return chain_block<1, vectors>(job, row, x, valid);
    default:
      return;
  }
}

}  // namespace

void chain(const ChainJob& job) {
  std::size_t x = 0;
  for (; x + 3 * lanes <= job.width; x += 3 * lanes) chain_columns<3>(job, x, lanes);
  const std::size_t rest = job.width - x;
  if (rest == 0) return;
  const std::size_t vectors = (rest + lanes - 1) / lanes;
  const std::size_t valid = rest - (vectors - 1) * lanes;
  if (vectors == 1) chain_columns<1>(job, x, valid);
  if (vectors == 2) chain_columns<2>(job, x, valid);
  if (vectors == 3) chain_columns<3>(job, x, valid);
}

namespace {

// ---------------------------------------------------------------------------------------------------------------
// moments and interpolate

/// to[i stride] = l_i(z): products of the factors before i and of those after it.
FGTD_INLINE void lagrange(const LagrangeBasis& basis, Vector z, double* to, std::size_t stride) {
  Vector before = broadcast(1.0);
  for (int i = 0; i < basis.nodes; ++i) {
    store(to + static_cast<std::size_t>(i) * stride, before * basis.scale[i]);
    before *= z - basis.node[i];
  }
  Vector after = broadcast(1.0);
  for (int i = basis.nodes - 1; i >= 0; --i) {
    double* at = to + static_cast<std::size_t>(i) * stride;
    store(at, load(at) * after);
    after *= z - basis.node[i];
  }
}

/// Local coordinate `axis` of the points j .. j + lanes, the last point repeated.
template <int d>
FGTD_INLINE Vector local_of(const double* local, std::size_t count, std::size_t j, std::size_t axis) {
  Vector z{};
  if (j + lanes <= count) {
    for (std::size_t v = 0; v < lanes; ++v) z[v] = local[(j + v) * d + axis];
  } else {
    for (std::size_t v = 0; v < lanes; ++v) z[v] = local[(j + v < count ? j + v : count - 1) * d + axis];
  }
  return z;
}

/// The moments of a box are a product of two matrices: the leading one or two axes at each point on the right, the
/// other axes times the weights on the left.
template <int d>
void moments_in(const MomentsJob& job) {
  const std::size_t p = static_cast<std::size_t>(job.basis.nodes);
  constexpr std::size_t right_axes = d <= 2 ? 1 : 2;
  const std::size_t right_width = right_axes == 1 ? p : p * p;
  const std::size_t right_stride = right_width + chain_padding;
  double* table = job.scratch;                   // [d][p][moments_chunk]
  double* left = table + d * p * moments_chunk;  // [columns][p^(d - right_axes)][moments_chunk]
  std::size_t left_rows = 1;
  for (std::size_t l = right_axes; l < d; ++l) left_rows *= p;
  double* right = left + job.columns * left_rows * moments_chunk;  // [count][right_stride]

  for (std::size_t j = 0; j < job.count; j += lanes)
    for (std::size_t l = 0; l < d; ++l)
      lagrange(job.basis, local_of<d>(job.local, job.count, j, l), table + l * p * moments_chunk + j, moments_chunk);

  for (std::size_t j = 0; j < job.count; ++j) {
    double* row = right + j * right_stride;
    if constexpr (right_axes == 1) {
      for (std::size_t i = 0; i < p; ++i) row[i] = table[i * moments_chunk + j];
    } else {
      // whole vectors run over into the next row, which is written after
      alignas(64) double first[24] = {};
      for (std::size_t i = 0; i < p; ++i) first[i] = table[i * moments_chunk + j];
      const double* second = table + p * moments_chunk + j;
      if (p <= lanes) {
        const Vector x = load(first);
        for (std::size_t i = 0; i < p; ++i) store(row + i * p, x * second[i * moments_chunk]);
      } else {
        for (std::size_t i = 0; i < p; ++i)
          for (std::size_t n = 0; n < p; n += lanes)
            store(row + i * p + n, load(first + n) * second[i * moments_chunk]);
      }
    }
  }

  for (std::size_t k = 0; k < job.columns; ++k) {
    const double* weight = job.weights + k * job.weight_stride;
    double* to = left + k * left_rows * moments_chunk;
    if constexpr (d == 1) {
      for (std::size_t j = 0; j < job.count; ++j) to[j] = weight[j];
    } else {
      const double* last = table + (d - 1) * p * moments_chunk;
      for (std::size_t i = 0; i < p; ++i) {
        if constexpr (d == 4) {
          const double* third = table + 2 * p * moments_chunk;
          for (std::size_t m = 0; m < p; ++m)
            for (std::size_t j = 0; j < job.count; ++j)
              to[(i * p + m) * moments_chunk + j] =
                  weight[j] * last[i * moments_chunk + j] * third[m * moments_chunk + j];
        } else {
          for (std::size_t j = 0; j < job.count; ++j)
            to[i * moments_chunk + j] = weight[j] * last[i * moments_chunk + j];
        }
      }
    }
  }

  const double* const b = left;
  const double* const r = right;
  chain({.rows = job.columns * left_rows,
         .depth = job.count,
         .width = right_width,
         .links = 1,
         .b = &b,
         .b_stride = moments_chunk,
         .d = &r,
         .d_stride = right_stride,
         .c = job.moments,
         .c_stride = right_width,
         .add = true});
}

}  // namespace

void moments(const MomentsJob& job) {
  switch (job.dimension) {
    case 1:
      return moments_in<1>(job);
    case 2:
      return moments_in<2>(job);
    case 3:
      return moments_in<3>(job);
    default:
      return moments_in<4>(job);
  }
}

namespace {

template <int d, int vectors>
FGTD_INLINE void interpolate_at(const InterpolateJob& job, std::size_t first, std::size_t size) {
  const std::size_t p = static_cast<std::size_t>(job.basis.nodes);
  const double* g[d];
  for (std::size_t l = 0; l < d; ++l) {
    double* table = job.scratch + l * p * vectors * lanes;
    g[l] = table;
    for (std::size_t v = 0; v < vectors; ++v)
      lagrange(job.basis, local_of<d>(job.local, job.count, first + v * lanes, l), table + v * lanes, vectors * lanes);
  }
  const double* coefficients = job.coefficients;
  for (std::size_t q = 0; q < job.outputs; ++q) {
    Vector sum[vectors];
    contract<d - 1, vectors>(p, coefficients, g, sum);
    double* to = job.values + q * job.value_stride + first;
    if (size == vectors * lanes) {
      for (std::size_t v = 0; v < vectors; ++v) store(to + v * lanes, sum[v]);
    } else {
      double all[vectors * lanes];
      for (std::size_t v = 0; v < vectors; ++v) store(all + v * lanes, sum[v]);
      for (std::size_t j = 0; j < size; ++j) to[j] = all[j];
    }
  }
}

template <int d>
void interpolate_in(const InterpolateJob& job) {
  for (std::size_t first = 0; first < job.count; first += 2 * lanes) {
    const std::size_t rest = job.count - first;
    if (rest <= lanes) {
      interpolate_at<d, 1>(job, first, rest);
    } else {
      interpolate_at<d, 2>(job, first, rest < 2 * lanes ? rest : 2 * lanes);
    }
  }
}

}  // namespace

void interpolate(const InterpolateJob& job) {
  switch (job.dimension) {
    case 1:
      return interpolate_in<1>(job);
    case 2:
      return interpolate_in<2>(job);
    case 3:
      return interpolate_in<3>(job);
    default:
      return interpolate_in<4>(job);
  }
}

}  // namespace fgtd::detail::FGTD_ISA
