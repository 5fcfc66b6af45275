// All pairs of a range of targets and some ranges of sources; see core/simd/pack.hpp for what may stand here.
#include "core/simd/functions.hpp"
#include "farfield/kernels/set.hpp"

namespace farfield::detail::CORE_ISA {
namespace {

constexpr std::size_t source_chunk = 256;  // partial sums of so many terms, then added: rounding grows with N/256 + 256
constexpr std::size_t packs = 2;           // of targets in registers
constexpr std::size_t tile = packs * lanes;

/// Pairs with r^2 <= tiny are not seen by the packs, being at distance 0 or beyond the range of the estimate of 1/r.
template <Interaction interaction>
constexpr double tiny = interaction == Interaction::inverse ? 1e-36 : 1e-290;

template <Interaction interaction>
constexpr int dimension_of = interaction == Interaction::inverse ? 3 : 2;

/// (1 - exp(-s)) / s = sum_n (-s)^n / (n+1)! for 0 <= s <= 1/2; s^13/14! < 2e-15
CORE_INLINE Pack blob_series(Pack s) {
  Pack sum = broadcast(1.0 / 6227020800.0);
  constexpr double factorials[] = {479001600., 39916800., 3628800., 362880., 40320., 5040.,
                                   720.,       120.,      24.,      6.,      2.,     1.};
  for (const double factorial : factorials) sum = 1 / factorial - sum * s;
  return sum;
}

template <class Work>
CORE_INLINE void for_each_pack(const Work& work) {
  static_assert(packs == 2);
  work.template operator()<0>();
  work.template operator()<1>();
}

struct Sums {
  Pack potential, field[3];
};

/// One source at one pack of targets. `divide` is set for every second pack: square roots with divisions keep other
/// parts of the processor busy than estimates with series.
template <Interaction interaction, bool full, bool potential, bool field, bool divide>
CORE_INLINE void add_pair(const PairsJob& job, const Pack* distance, double charge, Bits& seen, Sums& sums) {
  constexpr int d = dimension_of<interaction>;
  Pack squared = distance[0] * distance[0];
  for (int l = 1; l < d; ++l) squared += distance[l] * distance[l];
  Pack factor;
  if constexpr (interaction == Interaction::inverse) {
    const Bits valid = reinterpret_cast<Bits>(squared > tiny<interaction>);
    seen &= valid;
    const Pack inverse = select(valid, divide ? divided_rsqrt(squared) : rsqrt<full>(squared)),
               scaled = inverse * charge;
    if constexpr (potential) sums.potential += scaled;
    factor = scaled * (inverse * inverse);
  } else if constexpr (interaction == Interaction::logarithm) {
    const Bits valid = reinterpret_cast<Bits>(squared > tiny<interaction>);
    seen &= valid;
    if constexpr (potential) sums.potential += select(valid, log_positive(squared) * 0.5 + job.log_shift) * charge;
    factor = select(valid, charge / squared);
  } else {
    const Pack s = squared * job.inverse_squared_core;
    if (!any_true(s < job.point_beyond)) {
      factor = charge / squared;
    } else {
      factor = (1.0 - exp_taylor(-s)) / squared * charge;
      const Signed near = s < 0.5;
      if (any_true(near)) factor = near ? blob_series(s) * job.inverse_squared_core * charge : factor;
    }
  }
  if constexpr (field)
    for (int l = 0; l < d; ++l) sums.field[l] += factor * distance[l];
}

/// Adds the first `valid` lanes.
CORE_INLINE void add_to(double* out, Pack value, std::size_t valid) {
  if (valid >= lanes) {
    store(out, load(out) + value);
  } else {
    for (std::size_t i = 0; i < valid; ++i) out[i] += value[i];
  }
}

/// Sums one by one, without squares of distances, the pairs that the packs have left out and that are not at distance
/// 0.
template <Interaction interaction>
void add_unseen(const PairsJob& job, std::size_t first, std::size_t last, Range sources) {
  constexpr int d = dimension_of<interaction>;
  for (std::size_t i = first; i < last; ++i)
    for (std::size_t j = sources.begin; j < sources.end; ++j) {
      double distance[d], squared = 0, largest = 0;
      for (int l = 0; l < d; ++l) {
        distance[l] = job.target[l][i] - job.source[l][j];
        squared += distance[l] * distance[l];
        const double size = __builtin_fabs(distance[l]);
        largest = size > largest ? size : largest;
      }
      if (squared > tiny<interaction> || largest == 0) continue;
      double ratio = 0;  // (r / largest)^2
      for (int l = 0; l < d; ++l) {
        distance[l] /= largest;
        ratio += distance[l] * distance[l];
      }
      const double r = largest * __builtin_sqrt(ratio);
      if (job.potential)
        job.potential[i] += interaction == Interaction::inverse ? job.charge[j] / r
                                                                : job.charge[j] * (__builtin_log(r) + job.log_shift);
      const double strength = interaction == Interaction::inverse ? job.charge[j] / r / r : job.charge[j] / r;
      if (job.field[0])
        for (int l = 0; l < d; ++l) job.field[l][i] += strength * (distance[l] / __builtin_sqrt(ratio));
    }
}

/// Is there a pair that the packs have left out and that is not at distance 0?
template <Interaction interaction>
bool some_unseen(const PairsJob& job, std::size_t first, Range sources) {
  constexpr int d = dimension_of<interaction>;
  Bits unseen{};
  for (std::size_t v = 0; v < packs; ++v)
    for (std::size_t j = sources.begin; j < sources.end; ++j) {
      Pack squared{};
      Bits apart{};
      for (int l = 0; l < d; ++l) {
        const Pack distance = load(job.target[l] + first + v * lanes) - job.source[l][j];
        squared += distance * distance;
        apart |= reinterpret_cast<Bits>(distance != 0.0);
      }
      unseen |= apart & reinterpret_cast<Bits>(squared <= tiny<interaction>);
    }
  return any(unseen);
}

/// Targets first .. first + tile, of which `valid` count, and one chunk of sources.
template <Interaction interaction, bool full, bool potential, bool field>
CORE_INLINE void pairs_of_tile(const PairsJob& job, std::size_t first, std::size_t valid, Range sources) {
  constexpr int d = dimension_of<interaction>;
  Pack x[packs][d];
  for (std::size_t v = 0; v < packs; ++v)
    for (int l = 0; l < d; ++l) x[v][l] = load(job.target[l] + first + v * lanes);
  Sums sums[packs] = {};
  Bits seen[packs];
  for (std::size_t v = 0; v < packs; ++v) seen[v] = ~Bits{};
  for (std::size_t j = sources.begin; j < sources.end; ++j)
    for_each_pack([&]<std::size_t v>() {
      Pack distance[d];
      for (int l = 0; l < d; ++l) distance[l] = x[v][l] - job.source[l][j];
      add_pair<interaction, full, potential, field, v % 2 == 1>(job, distance, job.charge[j], seen[v], sums[v]);
    });
  Bits all = seen[0];
  for (std::size_t v = 0; v < packs; ++v) {
    all &= seen[v];
    const std::size_t from = v * lanes, rest = valid > from ? valid - from : 0;
    if constexpr (potential) add_to(job.potential + first + from, sums[v].potential, rest);
    if constexpr (field)
      for (int l = 0; l < d; ++l) add_to(job.field[l] + first + from, sums[v].field[l], rest);
  }
  if constexpr (interaction != Interaction::blob)
    if (any(~all) && some_unseen<interaction>(job, first, sources))
      add_unseen<interaction>(job, first, first + valid, sources);
}

template <Interaction interaction, bool full, bool potential, bool field>
void pairs_in_double(const PairsJob& job) {
  for (std::size_t run = 0; run < job.run_count; ++run)
    for (std::size_t begin = job.runs[run].begin; begin < job.runs[run].end; begin += source_chunk) {
      const std::size_t rest = job.runs[run].end - begin, size = rest < source_chunk ? rest : source_chunk;
      for (std::size_t i = job.targets.begin; i < job.targets.end; i += tile) {
        const std::size_t left = job.targets.end - i;
        pairs_of_tile<interaction, full, potential, field>(job, i, left < tile ? left : tile, {begin, begin + size});
      }
    }
}

template <Interaction interaction, bool full>
void pairs_by_output(const PairsJob& job) {
  if (job.potential && job.field[0]) {
    pairs_in_double<interaction, full, true, true>(job);
  } else if (job.potential) {
    pairs_in_double<interaction, full, true, false>(job);
  } else {
    pairs_in_double<interaction, full, false, true>(job);
  }
}

// ---------------------------------------------------------------------------------------------------------------
// Six digits: twice as many floats in a pack. Coordinates are whole multiples of a quantum, so that differences are
// exact and a distance has the relative accuracy of float however small it is beside the coordinates.

constexpr std::size_t wide_lanes = 2 * lanes;
constexpr std::size_t wide_tile = packs * wide_lanes;
constexpr std::size_t wide_chunk = 64;     // float sums of so many terms, then added in double
constexpr std::size_t target_block = 256;  // targets whose coordinates are turned into integers at a time

using Floats = float __attribute__((vector_size(8 * CORE_LANES)));
using Integers = int __attribute__((vector_size(8 * CORE_LANES)));
using HalfFloats = float __attribute__((vector_size(4 * CORE_LANES)));
typedef float HalfUnaligned __attribute__((vector_size(4 * CORE_LANES), aligned(4), may_alias));
typedef int UnalignedIntegers __attribute__((vector_size(8 * CORE_LANES), aligned(4), may_alias));
static_assert(alignof(HalfUnaligned) == 4 && alignof(UnalignedIntegers) == 4);  // as in core/simd/pack.hpp

/// 1/sqrt(x) to 3e-7: an estimate and one step of Newton's method.
CORE_INLINE Floats wide_rsqrt(Floats x) {
#if CORE_LANES == 8 && defined(__AVX512F__)
  const Floats y = reinterpret_cast<Floats>(_mm512_maskz_rsqrt14_ps(0xffff, reinterpret_cast<__m512>(x)));
#elif CORE_LANES == 4 && defined(__AVX2__)
  const Floats y = reinterpret_cast<Floats>(_mm256_rsqrt_ps(reinterpret_cast<__m256>(x)));
#elif CORE_LANES == 2 && defined(__SSE2__)
  const Floats y = reinterpret_cast<Floats>(_mm_rsqrt_ps(reinterpret_cast<__m128>(x)));
#else
  Floats y;
  for (std::size_t i = 0; i < wide_lanes; ++i) y[i] = 1 / __builtin_sqrtf(x[i]);
#endif
  const Floats h = 1.0f - (x * y) * y;
  return (y * 0.5f) * h + y;
}

CORE_INLINE void add_wide(double* out, Floats value, double scale, std::size_t valid) {
  float numbers[wide_lanes];
  for (std::size_t i = 0; i < wide_lanes; ++i) numbers[i] = value[i];
  if (valid >= wide_lanes) {
    for (std::size_t part = 0; part < 2; ++part) {
      const HalfFloats half = *reinterpret_cast<const HalfUnaligned*>(numbers + part * lanes);
      double* const at = out + part * lanes;
      store(at, load(at) + __builtin_convertvector(half, Pack) * scale);
    }
  } else {
    for (std::size_t i = 0; i < valid; ++i) out[i] += numbers[i] * scale;
  }
}

CORE_INLINE Floats wide_select(Integers mask, Floats x) {
  return reinterpret_cast<Floats>(mask & reinterpret_cast<Integers>(x));
}

CORE_INLINE std::size_t equal_pairs(Integers counted) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < wide_lanes; ++i) sum += static_cast<std::size_t>(counted[i]);
  return sum;
}

/// Pairs of a point with itself among a tile's targets, lanes past its end being copies of its last, and the sources.
CORE_INLINE std::size_t pairs_of_one_point(const PairsJob& job, std::size_t first, std::size_t valid, Range sources) {
  if (!job.same_points) return 0;
  const std::size_t last = first + valid - 1, low = first > sources.begin ? first : sources.begin,
                    high = last + 1 < sources.end ? last + 1 : sources.end;
  const std::size_t own = low < high ? high - low : 0;
  return own + (sources.begin <= last && last < sources.end ? wide_tile - valid : 0);
}

/// Pairs closer than `closest` are left to double; a point's pair with itself is not taken for one of them.
template <bool potential>
void pairs_in_float(const PairsJob& job) {
  // Charges are multiplied by 2^60, as distances are up to 2^31 quanta and their third powers have to stay in range.
  constexpr double charge_scale = 0x1p60;
  const double per_quantum = 1 / job.quantum;
  const double potential_scale = per_quantum / charge_scale, field_scale = potential_scale * per_quantum;
  const float closest = static_cast<float>((job.closest * per_quantum) * (job.closest * per_quantum));
  int target[3][target_block + wide_tile], source[3][wide_chunk];
  float charge[wide_chunk];
  for (std::size_t block = job.targets.begin; block < job.targets.end; block += target_block) {
    const std::size_t left = job.targets.end - block, count = left < target_block ? left : target_block;
    for (int l = 0; l < 3; ++l) {
      for (std::size_t i = 0; i < count; ++i)
        target[l][i] = static_cast<int>((job.target[l][block + i] - job.centre[l]) * per_quantum);
      for (std::size_t i = count; i < count + wide_tile; ++i) target[l][i] = target[l][count - 1];
    }
    for (std::size_t run = 0; run < job.run_count; ++run)
      for (std::size_t begin = job.runs[run].begin; begin < job.runs[run].end; begin += wide_chunk) {
        const std::size_t rest = job.runs[run].end - begin, size = rest < wide_chunk ? rest : wide_chunk;
        for (std::size_t j = 0; j < size; ++j) {
          for (int l = 0; l < 3; ++l)
            source[l][j] = static_cast<int>((job.source[l][begin + j] - job.centre[l]) * per_quantum);
          charge[j] = static_cast<float>(job.charge[begin + j] * charge_scale);
        }
        for (std::size_t i = 0; i < count; i += wide_tile) {
          Integers x[packs][3];
          for (std::size_t v = 0; v < packs; ++v)
            for (int l = 0; l < 3; ++l)
              x[v][l] = *reinterpret_cast<const UnalignedIntegers*>(target[l] + i + v * wide_lanes);
          Floats phi[packs] = {}, field[packs][3] = {};
          Integers close{}, equal{};
          for (std::size_t j = 0; j < size; ++j)
            for (std::size_t v = 0; v < packs; ++v) {
              Floats distance[3];
              for (int l = 0; l < 3; ++l) distance[l] = __builtin_convertvector(x[v][l] - source[l][j], Floats);
              const Floats squared = distance[0] * distance[0] + distance[1] * distance[1] + distance[2] * distance[2];
              const Integers apart = squared > 0.0f;
              close |= apart & (squared < closest);
              equal += apart + 1;  // where true, `apart` is -1
              const Floats inverse = wide_select(apart, wide_rsqrt(squared)), scaled = inverse * charge[j];
              if constexpr (potential) phi[v] += scaled;
              const Floats factor = scaled * (inverse * inverse);
              for (int l = 0; l < 3; ++l) field[v][l] += factor * distance[l];
            }
          const std::size_t valid = count - i < wide_tile ? count - i : wide_tile, first = block + i;
          if (any(close) || equal_pairs(equal) != pairs_of_one_point(job, first, valid, {begin, begin + size})) {
            for (std::size_t k = 0; k < valid; k += tile)
              pairs_of_tile<Interaction::inverse, false, potential, true>(
                  job, first + k, valid - k < tile ? valid - k : tile, {begin, begin + size});
            continue;
          }
          for (std::size_t v = 0; v < packs; ++v) {
            const std::size_t from = v * wide_lanes, some = valid > from ? valid - from : 0;
            if constexpr (potential) add_wide(job.potential + first + from, phi[v], potential_scale, some);
            for (int l = 0; l < 3; ++l) add_wide(job.field[l] + first + from, field[v][l], field_scale, some);
          }
        }
      }
  }
}

}  // namespace

void inverse_roots(const InverseRootsJob& job) {
  std::size_t i = 0;
  for (; i + tile <= job.count; i += tile) {
    store(job.values + i, rsqrt<true>(load(job.values + i)));
    store(job.values + i + lanes, divided_rsqrt(load(job.values + i + lanes)));
  }
  for (; i < job.count; ++i) job.values[i] = 1 / __builtin_sqrt(job.values[i]);
}

void pairs(const PairsJob& job) {
  if (job.interaction == Interaction::logarithm) return pairs_by_output<Interaction::logarithm, true>(job);
  if (job.interaction == Interaction::blob) return pairs_in_double<Interaction::blob, true, false, true>(job);
  if (job.precision == Precision::six_digits && job.field[0])
    return job.potential ? pairs_in_float<true>(job) : pairs_in_float<false>(job);
  if (job.precision == Precision::full) return pairs_by_output<Interaction::inverse, true>(job);
  pairs_by_output<Interaction::inverse, false>(job);
}

}  // namespace farfield::detail::CORE_ISA
