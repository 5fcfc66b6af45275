// All pairs of the kernels of general.hpp that have names; see core/simd/pack.hpp for what may stand here.
#include "core/simd/functions.hpp"
#include "farfield/kernels/set.hpp"

namespace farfield::detail::CORE_ISA {
namespace {

constexpr std::size_t source_chunk = 256;  // partial sums of so many terms, then added
constexpr std::size_t packs = 2;           // of targets in registers
constexpr std::size_t tile = packs * lanes;

// Where the estimate of 1/r is good. Other pairs are summed one by one.
constexpr double tiny = 1e-36, huge = 1e36;

template <GeneralShape shape>
constexpr bool takes_root = shape != GeneralShape::gaussian;

CORE_INLINE Pack power_of(Pack x, int exponent) {
  Pack result = broadcast(1);
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result *= x;
    x *= x;
  }
  return result;
}

template <GeneralShape shape, bool divide>
CORE_INLINE Pack value(Pack squared, double parameter) {
  if constexpr (shape == GeneralShape::gaussian) return exp_interpolated(-(squared * parameter));
  const Pack inverse = divide ? divided_rsqrt(squared) : rsqrt<true>(squared);
  if constexpr (shape == GeneralShape::yukawa) return exp_interpolated(-((squared * inverse) * parameter)) * inverse;
  return power_of(inverse, static_cast<int>(parameter));
}

double value_of_one(GeneralShape shape, double r, double parameter) {
  if (shape == GeneralShape::yukawa) return __builtin_exp(-parameter * r) / r;
  return __builtin_pow(r, -parameter);
}

CORE_INLINE void add_to(double* out, Pack value, std::size_t valid) {
  if (valid >= lanes) {
    store(out, load(out) + value);
  } else {
    for (std::size_t i = 0; i < valid; ++i) out[i] += value[i];
  }
}

/// The pairs that the packs have left out and that are not at distance 0.
template <GeneralShape shape, int d>
void add_unseen(const GeneralPairsJob& job, std::size_t first, std::size_t last, Range sources) {
  for (std::size_t i = first; i < last; ++i)
    for (std::size_t j = sources.begin; j < sources.end; ++j) {
      double distance[d], squared = 0, largest = 0;
      for (int l = 0; l < d; ++l) {
        distance[l] = job.target[l][i] - job.source[l][j];
        squared += distance[l] * distance[l];
        const double size = __builtin_fabs(distance[l]);
        largest = size > largest ? size : largest;
      }
      if ((squared > tiny && squared < huge) || largest == 0) continue;
      double ratio = 0;  // (r / largest)^2
      for (int l = 0; l < d; ++l) ratio += (distance[l] / largest) * (distance[l] / largest);
      job.out[i] += job.charge[j] * value_of_one(shape, largest * __builtin_sqrt(ratio), job.parameter);
    }
}

template <GeneralShape shape, int d>
CORE_INLINE void pairs_of_tile(const GeneralPairsJob& job, std::size_t first, std::size_t valid, Range sources) {
  Pack x[packs][d], sum[packs] = {};
  Bits seen = ~Bits{};
  for (std::size_t v = 0; v < packs; ++v)
    for (int l = 0; l < d; ++l) x[v][l] = load(job.target[l] + first + v * lanes);
  for (std::size_t j = sources.begin; j < sources.end; ++j) {
    Pack squared[packs];
    for (std::size_t v = 0; v < packs; ++v) {
      squared[v] = Pack{};
      for (int l = 0; l < d; ++l) {
        const Pack distance = x[v][l] - job.source[l][j];
        squared[v] += distance * distance;
      }
    }
    const double charge = job.charge[j];
    if constexpr (takes_root<shape>) {
      const Bits valid0 = reinterpret_cast<Bits>((squared[0] > tiny) & (squared[0] < huge)),
                 valid1 = reinterpret_cast<Bits>((squared[1] > tiny) & (squared[1] < huge));
      seen &= valid0 & valid1;
      sum[0] += select(valid0, value<shape, false>(squared[0], job.parameter)) * charge;
      sum[1] += select(valid1, value<shape, true>(squared[1], job.parameter)) * charge;
    } else {
      sum[0] += value<shape, false>(squared[0], job.parameter) * charge;
      sum[1] += value<shape, false>(squared[1], job.parameter) * charge;
    }
  }
  static_assert(packs == 2);
  for (std::size_t v = 0; v < packs; ++v)
    add_to(job.out + first + v * lanes, sum[v], valid > v * lanes ? valid - v * lanes : 0);
  if constexpr (takes_root<shape>)
    if (any(~seen)) add_unseen<shape, d>(job, first, first + valid, sources);
}

template <GeneralShape shape, int d>
void all_pairs(const GeneralPairsJob& job) {
  for (std::size_t run = 0; run < job.run_count; ++run)
    for (std::size_t begin = job.runs[run].begin; begin < job.runs[run].end; begin += source_chunk) {
      const std::size_t rest = job.runs[run].end - begin, size = rest < source_chunk ? rest : source_chunk;
      for (std::size_t i = job.targets.begin; i < job.targets.end; i += tile) {
        const std::size_t left = job.targets.end - i;
        pairs_of_tile<shape, d>(job, i, left < tile ? left : tile, {begin, begin + size});
      }
    }
}

template <GeneralShape shape>
void by_dimension(const GeneralPairsJob& job) {
  if (job.dimension == 2) {
    all_pairs<shape, 2>(job);
  } else {
    all_pairs<shape, 3>(job);
  }
}

}  // namespace

void general_pairs(const GeneralPairsJob& job) {
  switch (job.shape) {
    case GeneralShape::yukawa:
      return by_dimension<GeneralShape::yukawa>(job);
    case GeneralShape::inverse_power:
      return by_dimension<GeneralShape::inverse_power>(job);
    default:
      return by_dimension<GeneralShape::gaussian>(job);
  }
}

}  // namespace farfield::detail::CORE_ISA
