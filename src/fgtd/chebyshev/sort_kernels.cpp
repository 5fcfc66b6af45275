// The kernels of `chebyshev` that bring points to boxes: locate and sort_block (fgtd/chebyshev/jobs.hpp); see core/simd/pack.hpp for
// what may stand here.
#include "core/simd/pack.hpp"
#include "fgtd/chebyshev/jobs.hpp"
#include "fgtd/chebyshev/quad.hpp"
#include "fgtd/kernels/dimensions.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

// ---------------------------------------------------------------------------------------------------------------
// locate

/// The largest whole number <= x, for |x| < 2^50: adding `shift` rounds to a whole number.
CORE_INLINE Pack floor_of(Pack x) {
  constexpr double shift = 0x1.8p52;
  const Pack whole = (x + shift) - shift;
  return whole - select(reinterpret_cast<Bits>(whole > x), broadcast(1.0));
}

CORE_INLINE void locate_pack(const LocateJob& job, Pack x, double* index, double* local) {
  Pack i = clamp((x - job.origin) * job.inverse_side, 0x1p45);
  i = floor_of(i);
  i = i < job.first ? broadcast(job.first) : i;
  i = i > job.last ? broadcast(job.last) : i;
  // The rounding of the quotient may miss the box by one; the remainder shows it.
  Pack rest = x - (i * job.side + job.origin);
  const Pack below = select(reinterpret_cast<Bits>(rest < 0.0) & reinterpret_cast<Bits>(i > job.first), broadcast(1.0));
  const Pack above =
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
    Pack x{};
    if (job.stride == 1) {
      x = load(job.coordinate + j);
    } else {
      for (std::size_t v = 0; v < lanes; ++v) x[v] = job.coordinate[(j + v) * job.stride];
    }
    locate_pack(job, x, job.index + j, job.local == nullptr ? nullptr : job.local + j);
  }
  if (j == job.count) return;
  double x[lanes] = {}, index[lanes], local[lanes];
  for (std::size_t v = 0; v < lanes; ++v)
    x[v] = job.coordinate[(j + v < job.count ? j + v : job.count - 1) * job.stride];
  locate_pack(job, load(x), index, local);
  for (std::size_t v = 0; j + v < job.count; ++v) {
    job.index[j + v] = index[v];
    if (job.local != nullptr) job.local[j + v] = local[v];
  }
}

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

/// What one axis of boxes is, four times side by side.
struct QuadAxis {
  Quad origin, side, inverse, twice_inverse, low, high, least, most, below, above, step;
};

CORE_INLINE QuadAxis quad_axis(const SortBlockJob& job, std::size_t l) {
  return {every(job.origin[l]),    every(job.side[l]),     every(1 / job.side[l]), every(2 / job.side[l]),
          every(job.low[l]),       every(job.high[l]),     every(job.least[l]),    every(job.most[l]),
          every(job.least[l] - 1), every(job.most[l] + 1), every(job.step[l])};
}

/// Adds to `number` what an axis contributes to the number of the box of four points; sets the coordinate in that box, in
/// [-1, 1], and marks in `none` those that are beyond all boxes.
CORE_INLINE void find_box(const QuadAxis& a, Quad x, Quad& number, Quad& local, QuadIndex& none) {
  constexpr double shift = 0x1.8p52;  // adding it rounds to a whole number
  Quad i = (x - a.origin) * a.inverse - 0.5;
  i = i < a.below ? a.below : i;
  i = i > a.above ? a.above : i;
  i = (i + shift) - shift;
  none |= (i < a.least) | (i > a.most);
  i = i < a.low ? a.low : i;
  i = i > a.high ? a.high : i;
  number += (i - a.low) * a.step;
  local = (x - (i * a.side + a.origin)) * a.twice_inverse - 1.0;
}

/// Brings every point to its place. next[box] is where the next point of a box goes; keys are boxes, then places.
CORE_INLINE void place(const SortBlockJob& job, std::uint32_t* next, std::uint32_t* key, bool with_weight) {
  const std::size_t count = job.count;
  // The arrays have names of their own, because for the compiler stores could change the job's pointers.
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

template <int d>
void sort_block_in(const SortBlockJob& job) {
  QuadAxis axis[d];
  for (std::size_t l = 0; l < d; ++l) axis[l] = quad_axis(job, l);
  const std::size_t count = job.count;
  std::uint32_t *next = job.first + 1, *key = job.key;
  const Quad no_box = every(static_cast<double>(job.boxes));
  const bool with_weight = record_has_weight(d) && job.columns > 0;
  for (std::size_t box = 0; box < job.boxes + 2; ++box) job.first[box] = 0;

  const bool one_box = job.boxes == 1;
  QuadIndex any_without{};  // points without a box
  for (std::size_t j = 0; j < count; j += quad) {
    Quad number{}, z[4];
    for (std::size_t l = d; l < 4; ++l) z[l] = every(0);
    QuadIndex none{};
    for (std::size_t l = 0; l < d; ++l) find_box(axis[l], coordinates(job, l, j), number, z[l], none);
    if constexpr (record_has_weight(d))
      if (with_weight) {
        if (j + quad <= count) {
          z[3] = load_quad(job.given_weights + j);
        } else {
          for (std::size_t v = 0; j + v < count; ++v) z[3][v] = job.given_weights[j + v];
        }
      }
    any_without |= none;
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
    if (!(any_without[0] | any_without[1] | any_without[2] | any_without[3])) return keep_order(job);
    for (std::size_t j = 0; j < count; ++j) ++next[key[j]];
  }
  std::uint32_t total = 0;
  for (std::size_t box = 0; box < job.boxes + 1; ++box) {
    const std::uint32_t held = next[box];
    next[box] = total;
    total += held;
  }
  place(job, next, key, with_weight);
}

}  // namespace

void sort_block(const SortBlockJob& job) {
  in_dimension(job.dimension, [&](auto dimension) { sort_block_in<dimension.d>(job); });
}

}  // namespace fgtd::detail::CORE_ISA
