// The kernels of `chebyshev` on nodes of boxes (fgtd/chebyshev/jobs.hpp): chain, moments and interpolate; see core/simd/pack.hpp for what
// may stand here.
#include "core/simd/pack.hpp"
#include "fgtd/chebyshev/jobs.hpp"
#include "fgtd/chebyshev/quad.hpp"
#include "fgtd/kernels/contract.hpp"
#include "fgtd/kernels/dimensions.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {

// ---------------------------------------------------------------------------------------------------------------
// chain

namespace {

template <int rows, int packs>
CORE_INLINE void chain_block(const ChainJob& job, std::size_t row, std::size_t x, std::size_t valid) {
  Pack sum[rows][packs] = {};
  for (std::size_t link = 0; link < job.links; ++link) {
    const double* b = job.b[link] + row * job.b_stride;
    const double* d = job.d[link] + x;
    for (std::size_t k = 0; k < job.depth; ++k, d += job.d_stride) {
      Pack right[packs];
      for (int v = 0; v < packs; ++v) right[v] = load(d + static_cast<std::size_t>(v) * lanes);
      for (int i = 0; i < rows; ++i) {
        const double left = b[static_cast<std::size_t>(i) * job.b_stride + k];
        for (int v = 0; v < packs; ++v) sum[i][v] += right[v] * left;
      }
    }
  }
  for (int i = 0; i < rows; ++i) {
    double* to = job.c + (row + static_cast<std::size_t>(i)) * job.c_stride + x;
    for (int v = 0; v < packs; ++v, to += lanes) {
      if (v + 1 < packs || valid == lanes) {
        store(to, job.add ? load(to) + sum[i][v] : sum[i][v]);
      } else {
        double last[lanes];
        store(last, sum[i][v]);
        for (std::size_t n = 0; n < valid; ++n) to[n] = job.add ? to[n] + last[n] : last[n];
      }
    }
  }
}

/// Cuts rows into blocks of nearly the same height. They are so tall that no addition waits for the one before, and
/// small enough for the registers.
template <int packs>
CORE_INLINE void chain_columns(const ChainJob& job, std::size_t x, std::size_t valid) {
  constexpr std::size_t tall = packs == 1 ? 8 : 4;
  std::size_t blocks = (job.rows + tall - 1) / tall;
  for (std::size_t row = 0; row < job.rows; --blocks) {
    const std::size_t height = (job.rows - row + blocks - 1) / blocks;
    if constexpr (tall == 8) {
      if (height == 8) chain_block<8, packs>(job, row, x, valid);
      if (height == 7) chain_block<7, packs>(job, row, x, valid);
      if (height == 6) chain_block<6, packs>(job, row, x, valid);
      if (height == 5) chain_block<5, packs>(job, row, x, valid);
    }
    if (height == 4) chain_block<4, packs>(job, row, x, valid);
    if (height == 3) chain_block<3, packs>(job, row, x, valid);
    if (height == 2) chain_block<2, packs>(job, row, x, valid);
    if (height == 1) chain_block<1, packs>(job, row, x, valid);
    row += height;
  }
}

}  // namespace

void chain(const ChainJob& job) {
  std::size_t x = 0;
  for (; x + 3 * lanes <= job.width && x + 4 * lanes != job.width; x += 3 * lanes) chain_columns<3>(job, x, lanes);
  if (x + 4 * lanes == job.width) {
    chain_columns<2>(job, x, lanes);
    x += 2 * lanes;
  }
  const std::size_t rest = job.width - x;
  if (rest == 0) return;
  const std::size_t packs = (rest + lanes - 1) / lanes;
  const std::size_t valid = rest - (packs - 1) * lanes;
  if (packs == 1) chain_columns<1>(job, x, valid);
  if (packs == 2) chain_columns<2>(job, x, valid);
  if (packs == 3) chain_columns<3>(job, x, valid);
}

// ---------------------------------------------------------------------------------------------------------------
// moments and interpolate

namespace {

/// to[i stride] = T_i(z).
CORE_INLINE void polynomials(int count, Pack z, double* to, std::size_t stride) {
  Pack before = broadcast(1.0), now = z;
  const Pack twice = z + z;
  store(to, before);
  for (int i = 1; i < count; ++i) {
    store(to + static_cast<std::size_t>(i) * stride, now);
    const Pack next = twice * now - before;
    before = now;
    now = next;
  }
}

/// to[i stride] = l_i(z): products of the factors before i and of those after it; or T_i(z).
CORE_INLINE void evaluate_basis(const AxisBasis& basis, Pack z, double* to, std::size_t stride) {
  if (basis.node == nullptr) {
    polynomials(basis.nodes, z, to, stride);
    return;
  }
  Pack before = broadcast(1.0);
  for (int i = 0; i < basis.nodes; ++i) {
    store(to + static_cast<std::size_t>(i) * stride, before * basis.scale[i]);
    before *= z - basis.node[i];
  }
  Pack after = broadcast(1.0);
  for (int i = basis.nodes - 1; i >= 0; --i) {
    double* at = to + static_cast<std::size_t>(i) * stride;
    store(at, load(at) * after);
    after *= z - basis.node[i];
  }
}

/// Coordinates of the points first .. first + count as rows to[l][j], l < d, and behind them the weight that records
/// carry. The last point is repeated up to a whole pack of 8.
template <int d>
CORE_INLINE void bring_apart(const double* local, std::size_t step, std::size_t count, double* to, std::size_t stride) {
  const std::size_t padded = (count + 7) / 8 * 8;
  std::size_t j = 0;
  if (step == record_numbers) {
    for (; j + quad <= count; j += quad) {
      const double* from = local + j * record_numbers;
      Quad a = load_quad(from), b = load_quad(from + 4), c = load_quad(from + 8), e = load_quad(from + 12);
      transpose(a, b, c, e);
      store_quad(to + j, a);
      if constexpr (d > 1) store_quad(to + stride + j, b);
      if constexpr (d > 2) store_quad(to + 2 * stride + j, c);
      store_quad(to + 3 * stride + j, e);
    }
  }
  const std::size_t numbers = step == record_numbers ? record_numbers : d;
  for (; j < padded; ++j)
    for (std::size_t l = 0; l < numbers; ++l) to[l * stride + j] = local[(j < count ? j : count - 1) * step + l];
}

/// Where the moments of a box keep what they multiply, for p nodes an axis, padded to whole quads.
template <int d>
struct MomentTables {
  static constexpr std::size_t right_axes = d <= 2 ? 1 : 2;  // leading axes that stand on the right

  std::size_t p, padded;
  std::size_t right_width, right_stride;
  std::size_t left_rows;
  double* point;  // [record_numbers][moments_chunk]
  double* table;  // [d][padded][moments_chunk]
  double* rows;   // [moments_chunk][padded]
  double* left;   // [columns][p^(d - right_axes)][moments_chunk]
  double* right;  // [count][right_stride]
};

template <int d>
CORE_INLINE MomentTables<d> moment_tables(const MomentsJob& job) {
  MomentTables<d> t{};
  t.p = static_cast<std::size_t>(job.basis.nodes);
  t.padded = (t.p + 3) / 4 * 4;
  t.right_width = t.right_axes == 1 ? t.p : t.p * t.p;
  t.right_stride = t.right_width + t.padded + chain_padding;
  t.left_rows = 1;
  for (std::size_t l = t.right_axes; l < d; ++l) t.left_rows *= t.p;
  t.point = job.scratch;
  t.table = t.point + record_numbers * moments_chunk;
  t.rows = t.table + d * t.padded * moments_chunk;
  t.left = t.rows + t.padded * moments_chunk;
  t.right = t.left + job.columns * t.left_rows * moments_chunk;
  return t;
}

/// The right matrix: a row of every point, of the first axis or of the products of the first two.
template <int d>
CORE_INLINE void fill_right(const MomentTables<d>& t, std::size_t count) {
  double* const table = t.table;
  const std::size_t p = t.p, padded = t.padded, right_stride = t.right_stride;
  // the first axis by point; beyond p the rows hold anything finite
  for (std::size_t n = p; n < padded; ++n)
    for (std::size_t j = 0; j < count + quad && j < moments_chunk; ++j) table[n * moments_chunk + j] = 0;
  double* first_axis = t.right_axes == 1 ? t.right : t.rows;
  const std::size_t first_stride = t.right_axes == 1 ? right_stride : padded;
  for (std::size_t j = 0; j < count; j += quad)
    for (std::size_t n = 0; n < padded; n += quad) {
      const double* from = table + n * moments_chunk + j;
      Quad a = load_quad(from), b = load_quad(from + moments_chunk), c = load_quad(from + 2 * moments_chunk),
           e = load_quad(from + 3 * moments_chunk);
      transpose(a, b, c, e);
      double* to = first_axis + j * first_stride + n;
      store_quad(to, a);
      store_quad(to + first_stride, b);
      store_quad(to + 2 * first_stride, c);
      store_quad(to + 3 * first_stride, e);
    }
  if constexpr (MomentTables<d>::right_axes == 2) {
    // times the second axis; whole quads run over into the next row, which is written after
    const double* second = table + padded * moments_chunk;
    for (std::size_t j = 0; j < count; ++j) {
      double* row = t.right + j * right_stride;
      const double* x = t.rows + j * padded;
      for (std::size_t i = 0; i < p; ++i) {
        const Quad factor = every(second[i * moments_chunk + j]);
        for (std::size_t n = 0; n < padded; n += quad) store_quad(row + i * p + n, load_quad(x + n) * factor);
      }
    }
  }
}

/// The left matrix: the weights times the other axes.
template <int d>
CORE_INLINE void fill_left(const MomentsJob& job, const MomentTables<d>& t) {
  const std::size_t p = t.p;
  for (std::size_t k = 0; k < job.columns; ++k) {
    const bool in_record = k == 0 && record_has_weight(d) && job.local_stride == record_numbers;
    const double* weight = in_record ? t.point + 3 * moments_chunk : job.weights + k * job.weight_stride;
    double* to = t.left + k * t.left_rows * moments_chunk;
    if constexpr (d == 1) {
      for (std::size_t j = 0; j < job.count; ++j) to[j] = weight[j];
    } else {
      const double* last = t.table + (d - 1) * t.padded * moments_chunk;
      for (std::size_t i = 0; i < p; ++i) {
        if constexpr (d == 4) {
          const double* third = t.table + 2 * t.padded * moments_chunk;
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
}

/// The moments of a box are a product of two matrices: the leading one or two axes at each point on the right, the
/// other axes times the weights on the left.
template <int d>
void moments_in(const MomentsJob& job) {
  const MomentTables<d> t = moment_tables<d>(job);
  bring_apart<d>(job.local, job.local_stride, job.count, t.point, moments_chunk);
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t j = 0; j < job.count; j += lanes)
      evaluate_basis(job.basis, load(t.point + l * moments_chunk + j), t.table + l * t.padded * moments_chunk + j,
                     moments_chunk);
  fill_right<d>(t, job.count);
  fill_left<d>(job, t);
  const double* const b = t.left;
  const double* const r = t.right;
  chain({.rows = job.columns * t.left_rows,
         .depth = job.count,
         .width = t.right_width,
         .links = 1,
         .b = &b,
         .b_stride = moments_chunk,
         .d = &r,
         .d_stride = t.right_stride,
         .c = job.moments,
         .c_stride = t.right_width,
         .add = true});
}

}  // namespace

void moments(const MomentsJob& job) {
  in_dimension(job.dimension, [&](auto dimension) { moments_in<dimension.d>(job); });
}

namespace {

template <int d, int packs>
CORE_INLINE void interpolate_at(const InterpolateJob& job, std::size_t first, std::size_t size) {
  const std::size_t p = static_cast<std::size_t>(job.basis.nodes);
  const double* g[d];
  double* point = job.scratch + d * p * packs * lanes;
  bring_apart<d>(job.local + first * job.local_stride, job.local_stride, size, point, 2 * 8);
  for (std::size_t l = 0; l < d; ++l) {
    double* table = job.scratch + l * p * packs * lanes;
    g[l] = table;
    for (std::size_t v = 0; v < packs; ++v)
      evaluate_basis(job.basis, load(point + l * 2 * 8 + v * lanes), table + v * lanes, packs * lanes);
  }
  const double* coefficients = job.coefficients;
  for (std::size_t q = 0; q < job.outputs; ++q) {
    Pack sum[packs];
    contract<d - 1, packs>(p, coefficients, g, sum);
    double* to = job.values + q * job.value_stride + first;
    if (size == packs * lanes) {
      for (std::size_t v = 0; v < packs; ++v) store(to + v * lanes, sum[v]);
    } else {
      double all[packs * lanes];
      for (std::size_t v = 0; v < packs; ++v) store(all + v * lanes, sum[v]);
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
  in_dimension(job.dimension, [&](auto dimension) { interpolate_in<dimension.d>(job); });
}

}  // namespace fgtd::detail::CORE_ISA
