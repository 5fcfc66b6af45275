// The kernels of `chebyshev` (jobs: fgtd/chebyshev/jobs.hpp); see core/simd/vector.hpp for what may stand here.
#include "core/simd/vector.hpp"
#include "fgtd/chebyshev/jobs.hpp"
#include "fgtd/kernels/contract.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

// ---------------------------------------------------------------------------------------------------------------
// locate

/// The largest whole number <= x, for |x| < 2^50: adding `shift` rounds to a whole number.
CORE_INLINE Vector floor_of(Vector x) {
  constexpr double shift = 0x1.8p52;
  const Vector whole = (x + shift) - shift;
  return whole - select(reinterpret_cast<Bits>(whole > x), broadcast(1.0));
}

CORE_INLINE void locate_vector(const LocateJob& job, Vector x, double* index, double* local) {
  Vector i = clamp((x - job.origin) * job.inverse_side, 0x1p45);
  i = floor_of(i);
  i = i < job.first ? broadcast(job.first) : i;
  i = i > job.last ? broadcast(job.last) : i;
  // The rounding of the quotient may miss the box by one; the remainder shows it.
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

// ---------------------------------------------------------------------------------------------------------------
// Four points, whatever the instruction set: numbers of one point side by side

namespace {

constexpr std::size_t quad = 4;
using Quad = double __attribute__((vector_size(32)));
using QuadIndex = long long __attribute__((vector_size(32)));
using QuadKey = int __attribute__((vector_size(16)));
typedef double UnalignedQuad __attribute__((vector_size(32), aligned(8), may_alias));
static_assert(alignof(UnalignedQuad) == 8);  // as in core/simd/vector.hpp

CORE_INLINE Quad load_quad(const double* from) { return *reinterpret_cast<const UnalignedQuad*>(from); }
CORE_INLINE void store_quad(double* to, Quad x) { *reinterpret_cast<UnalignedQuad*>(to) = x; }
CORE_INLINE Quad every(double x) { return Quad{x, x, x, x}; }

#if __has_builtin(__builtin_shufflevector)
#define FGTD_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else  // g++ before 12
#define FGTD_SHUFFLE(a, b, ...) __builtin_shuffle(a, b, QuadIndex{__VA_ARGS__})
#endif

CORE_INLINE void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad ab0 = FGTD_SHUFFLE(a, b, 0, 4, 2, 6), ab1 = FGTD_SHUFFLE(a, b, 1, 5, 3, 7);
  const Quad cd0 = FGTD_SHUFFLE(c, d, 0, 4, 2, 6), cd1 = FGTD_SHUFFLE(c, d, 1, 5, 3, 7);
  a = FGTD_SHUFFLE(ab0, cd0, 0, 1, 4, 5);
  b = FGTD_SHUFFLE(ab1, cd1, 0, 1, 4, 5);
  c = FGTD_SHUFFLE(ab0, cd0, 2, 3, 6, 7);
  d = FGTD_SHUFFLE(ab1, cd1, 2, 3, 6, 7);
}

}  // namespace

// ---------------------------------------------------------------------------------------------------------------
// sort_block

namespace {

/// Coordinates of four points, the last point repeated.
CORE_INLINE Quad coordinates(const SortBlockJob& job, std::size_t l, std::size_t j) {
  const double* from = job.coordinate + l * job.axis_stride;
  const std::size_t step = job.point_stride;
  if (j + quad <= job.count) {
    if (step == 1) return load_quad(from + j);
    from += j * step;
    return Quad{from[0], from[step], from[2 * step], from[3 * step]};
  }
  Quad x;
  for (std::size_t v = 0; v < quad; ++v) x[v] = from[(j + v < job.count ? j + v : job.count - 1) * step];
  return x;
}

/// All points are in the one box there is.
CORE_INLINE void keep_order(const SortBlockJob& job) {
  const std::size_t count = job.count;
  job.first[1] = job.first[2] = static_cast<std::uint32_t>(count);
  const double* unsorted = job.unsorted;
  double* local = job.local;
  for (std::size_t i = 0; i < count * record_numbers; i += quad) store_quad(local + i, load_quad(unsorted + i));
  std::uint32_t* order = job.order;
  if (order != nullptr)
    for (std::size_t j = 0; j < count; ++j) order[j] = static_cast<std::uint32_t>(j);
  for (std::size_t k = record_has_weight(job.dimension) ? 1 : 0; k < job.columns; ++k)
    for (std::size_t j = 0; j < count; ++j)
      job.weight[k * job.weight_stride + j] = job.given_weights[k * job.given_stride + j];
}

template <int d>
void sort_block_in(const SortBlockJob& job) {
  constexpr double shift = 0x1.8p52;  // adding it rounds to a whole number
  struct Axis {
    Quad origin, side, inverse, twice_inverse, low, high, least, most, below, above, step;
  } axis[d];
  for (std::size_t l = 0; l < d; ++l)
    axis[l] = {every(job.origin[l]),    every(job.side[l]),     every(1 / job.side[l]), every(2 / job.side[l]),
               every(job.low[l]),       every(job.high[l]),     every(job.least[l]),    every(job.most[l]),
               every(job.least[l] - 1), every(job.most[l] + 1), every(job.step[l])};
  const std::size_t count = job.count;
  std::uint32_t *next = job.first + 1, *key = job.key;  // next: where the next point of a box goes
  const Quad no_box = every(static_cast<double>(job.boxes));
  const bool with_weight = record_has_weight(d) && job.columns > 0;
  for (std::size_t box = 0; box < job.boxes + 2; ++box) job.first[box] = 0;

  const bool one_box = job.boxes == 1;
  QuadIndex any{};  // points without a box
  for (std::size_t j = 0; j < count; j += quad) {
    Quad number{}, z[4];
    for (std::size_t l = d; l < 4; ++l) z[l] = every(0);
    QuadIndex none{};
    for (std::size_t l = 0; l < d; ++l) {
      const Axis& a = axis[l];
      const Quad x = coordinates(job, l, j);
      Quad i = (x - a.origin) * a.inverse - 0.5;
      i = i < a.below ? a.below : i;
      i = i > a.above ? a.above : i;
      i = (i + shift) - shift;
      none |= (i < a.least) | (i > a.most);
      i = i < a.low ? a.low : i;
      i = i > a.high ? a.high : i;
      number += (i - a.low) * a.step;
      z[l] = (x - (i * a.side + a.origin)) * a.twice_inverse - 1.0;
    }
    if constexpr (record_has_weight(d))
      if (with_weight) {
        if (j + quad <= count) {
          z[3] = load_quad(job.given_weights + j);
        } else {
          for (std::size_t v = 0; j + v < count; ++v) z[3][v] = job.given_weights[j + v];
        }
      }
    any |= none;
    number = none ? no_box : number;
    const QuadKey keys = __builtin_convertvector(number, QuadKey);
    __builtin_memcpy(key + j, &keys, sizeof keys);
    transpose(z[0], z[1], z[2], z[3]);
    for (std::size_t v = 0; v < quad; ++v) store_quad(job.unsorted + (j + v) * record_numbers, z[v]);
    if (one_box) continue;
    const std::size_t size = count - j < quad ? count - j : quad;
    for (std::size_t v = 0; v < size; ++v) ++next[key[j + v]];
  }
  if (one_box) {
    if (!(any[0] | any[1] | any[2] | any[3])) return keep_order(job);
    for (std::size_t j = 0; j < count; ++j) ++next[key[j]];
  }
  std::uint32_t total = 0;
  for (std::size_t box = 0; box < job.boxes + 1; ++box) {
    const std::uint32_t held = next[box];
    next[box] = total;
    total += held;
  }
  // From here on keys are places. The arrays have names of their own, because for the compiler stores could change the
  // job's pointers.
  const double* unsorted = job.unsorted;
  double* local = job.local;
  for (std::size_t j = 0; j < count; ++j) {
    const std::uint32_t to = next[key[j]]++;
    key[j] = to;
    store_quad(local + to * record_numbers, load_quad(unsorted + j * record_numbers));
  }
  std::uint32_t* order = job.order;
  if (order != nullptr)
    for (std::size_t j = 0; j < count; ++j) order[key[j]] = static_cast<std::uint32_t>(j);
  for (std::size_t k = with_weight ? 1 : 0; k < job.columns; ++k) {
    double* weight = job.weight + k * job.weight_stride;
    const double* given = job.given_weights + k * job.given_stride;
    for (std::size_t j = 0; j < count; ++j) weight[key[j]] = given[j];
  }
}

}  // namespace

void sort_block(const SortBlockJob& job) {
  switch (job.dimension) {
    case 1:
      return sort_block_in<1>(job);
    case 2:
      return sort_block_in<2>(job);
    case 3:
      return sort_block_in<3>(job);
    default:
      return sort_block_in<4>(job);
  }
}

// ---------------------------------------------------------------------------------------------------------------
// chain

namespace {

template <int rows, int vectors>
CORE_INLINE void chain_block(const ChainJob& job, std::size_t row, std::size_t x, std::size_t valid) {
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

/// Cuts rows into blocks of nearly the same height. They are so tall that no addition waits for the one before, and
/// small enough for the registers.
template <int vectors>
CORE_INLINE void chain_columns(const ChainJob& job, std::size_t x, std::size_t valid) {
  constexpr std::size_t tall = vectors == 1 ? 8 : 4;
  std::size_t blocks = (job.rows + tall - 1) / tall;
  for (std::size_t row = 0; row < job.rows; --blocks) {
    const std::size_t height = (job.rows - row + blocks - 1) / blocks;
    if constexpr (tall == 8) {
      if (height == 8) chain_block<8, vectors>(job, row, x, valid);
      if (height == 7) chain_block<7, vectors>(job, row, x, valid);
      if (height == 6) chain_block<6, vectors>(job, row, x, valid);
      if (height == 5) chain_block<5, vectors>(job, row, x, valid);
    }
    if (height == 4) chain_block<4, vectors>(job, row, x, valid);
    if (height == 3) chain_block<3, vectors>(job, row, x, valid);
    if (height == 2) chain_block<2, vectors>(job, row, x, valid);
    if (height == 1) chain_block<1, vectors>(job, row, x, valid);
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
  const std::size_t vectors = (rest + lanes - 1) / lanes;
  const std::size_t valid = rest - (vectors - 1) * lanes;
  if (vectors == 1) chain_columns<1>(job, x, valid);
  if (vectors == 2) chain_columns<2>(job, x, valid);
  if (vectors == 3) chain_columns<3>(job, x, valid);
}

namespace {

// ---------------------------------------------------------------------------------------------------------------
// moments and interpolate

/// to[i stride] = T_i(z).
CORE_INLINE void polynomials(int count, Vector z, double* to, std::size_t stride) {
  Vector before = broadcast(1.0), now = z;
  const Vector twice = z + z;
  store(to, before);
  for (int i = 1; i < count; ++i) {
    store(to + static_cast<std::size_t>(i) * stride, now);
    const Vector next = twice * now - before;
    before = now;
    now = next;
  }
}

/// to[i stride] = l_i(z): products of the factors before i and of those after it; or T_i(z).
CORE_INLINE void evaluate_basis(const AxisBasis& basis, Vector z, double* to, std::size_t stride) {
  if (basis.node == nullptr) {
    polynomials(basis.nodes, z, to, stride);
    return;
  }
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

/// Coordinates of the points first .. first + count as rows to[l][j], l < d, and behind them the weight that records
/// carry. The last point is repeated up to a whole vector of 8.
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

/// The moments of a box are a product of two matrices: the leading one or two axes at each point on the right, the
/// other axes times the weights on the left.
template <int d>
void moments_in(const MomentsJob& job) {
  const std::size_t p = static_cast<std::size_t>(job.basis.nodes), padded = (p + 3) / 4 * 4;
  constexpr std::size_t right_axes = d <= 2 ? 1 : 2;
  const std::size_t right_width = right_axes == 1 ? p : p * p;
  const std::size_t right_stride = right_width + padded + chain_padding;
  double* point = job.scratch;                             // [record_numbers][moments_chunk]
  double* table = point + record_numbers * moments_chunk;  // [d][padded][moments_chunk]
  double* rows = table + d * padded * moments_chunk;       // [moments_chunk][padded]
  double* left = rows + padded * moments_chunk;            // [columns][p^(d - right_axes)][moments_chunk]
  std::size_t left_rows = 1;
  for (std::size_t l = right_axes; l < d; ++l) left_rows *= p;
  double* right = left + job.columns * left_rows * moments_chunk;  // [count][right_stride]

  bring_apart<d>(job.local, job.local_stride, job.count, point, moments_chunk);
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t j = 0; j < job.count; j += lanes)
      evaluate_basis(job.basis, load(point + l * moments_chunk + j), table + l * padded * moments_chunk + j,
                     moments_chunk);

  // the first axis by point; beyond p the rows hold anything finite
  for (std::size_t n = p; n < padded; ++n)
    for (std::size_t j = 0; j < job.count + quad && j < moments_chunk; ++j) table[n * moments_chunk + j] = 0;
  double* first_axis = right_axes == 1 ? right : rows;
  const std::size_t first_stride = right_axes == 1 ? right_stride : padded;
  for (std::size_t j = 0; j < job.count; j += quad)
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
  if constexpr (right_axes == 2) {
    // times the second axis; whole quads run over into the next row, which is written after
    const double* second = table + padded * moments_chunk;
    for (std::size_t j = 0; j < job.count; ++j) {
      double* row = right + j * right_stride;
      const double* x = rows + j * padded;
      for (std::size_t i = 0; i < p; ++i) {
        const Quad factor = every(second[i * moments_chunk + j]);
        for (std::size_t n = 0; n < padded; n += quad) store_quad(row + i * p + n, load_quad(x + n) * factor);
      }
    }
  }

  for (std::size_t k = 0; k < job.columns; ++k) {
    const bool in_record = k == 0 && record_has_weight(d) && job.local_stride == record_numbers;
    const double* weight = in_record ? point + 3 * moments_chunk : job.weights + k * job.weight_stride;
    double* to = left + k * left_rows * moments_chunk;
    if constexpr (d == 1) {
      for (std::size_t j = 0; j < job.count; ++j) to[j] = weight[j];
    } else {
      const double* last = table + (d - 1) * padded * moments_chunk;
      for (std::size_t i = 0; i < p; ++i) {
        if constexpr (d == 4) {
          const double* third = table + 2 * padded * moments_chunk;
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
CORE_INLINE void interpolate_at(const InterpolateJob& job, std::size_t first, std::size_t size) {
  const std::size_t p = static_cast<std::size_t>(job.basis.nodes);
  const double* g[d];
  double* point = job.scratch + d * p * vectors * lanes;
  bring_apart<d>(job.local + first * job.local_stride, job.local_stride, size, point, 2 * 8);
  for (std::size_t l = 0; l < d; ++l) {
    double* table = job.scratch + l * p * vectors * lanes;
    g[l] = table;
    for (std::size_t v = 0; v < vectors; ++v)
      evaluate_basis(job.basis, load(point + l * 2 * 8 + v * lanes), table + v * lanes, vectors * lanes);
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

}  // namespace fgtd::detail::CORE_ISA
