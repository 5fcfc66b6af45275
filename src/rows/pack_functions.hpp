// Sine, exponential and their like of a Pack: SLEEF's deterministic functions of one unit in the last place [SP20], the same
// bits whatever the length of the Pack. Without SLEEF the C library's, number by number. See core/simd/pack.hpp for who
// may include this.
#pragma once

#include "core/simd/functions.hpp"

#ifdef GAUSSDRIFT_HAS_SLEEF
#include <sleef.h>
#endif

namespace gaussdrift::rows::CORE_ISA {
namespace {

using namespace core::CORE_ISA;

#ifdef GAUSSDRIFT_HAS_SLEEF
#if CORE_LANES == 8
#define ROWS_SLEEF(name, ulp) Sleef_cinz_##name##d8_##ulp##avx512fnofma
using Register = __m512d;
using SinCosPair = Sleef___m512d_2;
#elif CORE_LANES == 4
#define ROWS_SLEEF(name, ulp) Sleef_cinz_##name##d4_##ulp##avx
using Register = __m256d;
using SinCosPair = Sleef___m256d_2;
#else
#define ROWS_SLEEF(name, ulp) Sleef_cinz_##name##d2_##ulp##sse2
using Register = __m128d;
using SinCosPair = Sleef___m128d_2;
#endif
#define ROWS_ONE(name, ulp) \
  CORE_INLINE Pack name(Pack x) { return reinterpret_cast<Pack>(ROWS_SLEEF(name, ulp)(reinterpret_cast<Register>(x))); }
#define ROWS_TWO(name, ulp)                                                                   \
  CORE_INLINE Pack name(Pack x, Pack y) {                                                     \
    return reinterpret_cast<Pack>(                                                            \
        ROWS_SLEEF(name, ulp)(reinterpret_cast<Register>(x), reinterpret_cast<Register>(y))); \
  }
/// Both at once.
CORE_INLINE void sine_and_cosine(Pack x, Pack& sine, Pack& cosine) {
  const SinCosPair both = ROWS_SLEEF(sincos, u10)(reinterpret_cast<Register>(x));
  sine = reinterpret_cast<Pack>(both.x), cosine = reinterpret_cast<Pack>(both.y);
}
#else
#define ROWS_ONE(name, ulp)                                                \
  CORE_INLINE Pack name(Pack x) {                                          \
    for (std::size_t i = 0; i < lanes; ++i) x[i] = __builtin_##name(x[i]); \
    return x;                                                              \
  }
#define ROWS_TWO(name, ulp)                                                      \
  CORE_INLINE Pack name(Pack x, Pack y) {                                        \
    for (std::size_t i = 0; i < lanes; ++i) x[i] = __builtin_##name(x[i], y[i]); \
    return x;                                                                    \
  }
#endif

ROWS_ONE(sin, u10)
ROWS_ONE(cos, u10)
ROWS_ONE(tan, u10)
ROWS_ONE(asin, u10)
ROWS_ONE(acos, u10)
ROWS_ONE(atan, u10)
ROWS_ONE(cosh, u10)
ROWS_ONE(tanh, u10)
ROWS_ONE(atanh, u10)
ROWS_ONE(exp, u10)
ROWS_ONE(expm1, u10)
ROWS_ONE(log, u10)
ROWS_ONE(log2, u10)
ROWS_ONE(log10, u10)
ROWS_ONE(cbrt, u10)
ROWS_ONE(erf, u10)
ROWS_TWO(pow, u10)
ROWS_TWO(atan2, u10)
ROWS_TWO(hypot, u05)

#ifndef GAUSSDRIFT_HAS_SLEEF
/// Both at once.
CORE_INLINE void sine_and_cosine(Pack x, Pack& sine, Pack& cosine) { sine = sin(x), cosine = cos(x); }
#endif

#undef ROWS_ONE
#undef ROWS_TWO

}  // namespace
}  // namespace gaussdrift::rows::CORE_ISA
