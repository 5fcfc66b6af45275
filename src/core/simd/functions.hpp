// Functions of packs: roots, exponential, logarithm. For the sources that may include pack.hpp.
#pragma once

#include "core/simd/pack.hpp"

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace gaussdrift::core::CORE_ISA {
namespace {

/// Is any lane of a comparison's result set?
CORE_INLINE bool any_true(Signed mask) {
#if CORE_LANES == 8 && defined(__AVX512F__)
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)) != 0;
#elif CORE_LANES == 4 && defined(__AVX2__)
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask)) != 0;
#elif CORE_LANES == 2 && defined(__SSE2__)
  return _mm_movemask_pd(reinterpret_cast<__m128d>(mask)) != 0;
#else
  return any(mask);
#endif
}

/// 1/sqrt(x) to at least 11 bits for 1e-37 < x < 1e37.
CORE_INLINE Pack rsqrt_estimate(Pack x) {
#if CORE_LANES == 8 && defined(__AVX512F__)
  return reinterpret_cast<Pack>(_mm512_maskz_rsqrt14_pd(0xff, reinterpret_cast<__m512d>(x)));
#elif CORE_LANES == 4 && defined(__AVX2__)
  return reinterpret_cast<Pack>(_mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(reinterpret_cast<__m256d>(x)))));
#elif CORE_LANES == 2 && defined(__SSE2__)
  return reinterpret_cast<Pack>(_mm_cvtps_pd(_mm_rsqrt_ps(_mm_cvtpd_ps(reinterpret_cast<__m128d>(x)))));
#else
  Pack y;
  for (std::size_t i = 0; i < lanes; ++i) y[i] = 1 / __builtin_sqrt(x[i]);
  return y;
#endif
}

/// 1/sqrt(x) from an estimate y with h = 1 - x y^2: y (1 - h)^(-1/2), the series to h^4 (full) or h^2 (ten digits).
template <bool full>
CORE_INLINE Pack rsqrt(Pack x) {
  const Pack y = rsqrt_estimate(x);
  const Pack h = 1.0 - (x * y) * y;
  Pack p;
  if constexpr (full) {
    p = h * (35.0 / 128) + 5.0 / 16;
    p = h * p + 3.0 / 8;
    p = h * p + 0.5;
  } else {
    p = h * (3.0 / 8) + 0.5;
  }
  return y * (h * p) + y;
}

CORE_INLINE Pack root(Pack x) {
#if CORE_LANES == 8 && defined(__AVX512F__)
  return reinterpret_cast<Pack>(_mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(x)));
#elif CORE_LANES == 4 && defined(__AVX2__)
  return reinterpret_cast<Pack>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(x)));
#elif CORE_LANES == 2 && defined(__SSE2__)
  return reinterpret_cast<Pack>(_mm_sqrt_pd(reinterpret_cast<__m128d>(x)));
#else
  Pack y;
  for (std::size_t i = 0; i < lanes; ++i) y[i] = __builtin_sqrt(x[i]);
  return y;
#endif
}

/// The same as rsqrt by square root and division, which occupy other parts of the processor.
CORE_INLINE Pack divided_rsqrt(Pack x) { return 1.0 / root(x); }

// Two exponentials, right to about one unit in the last place. They round differently: fgtd takes the first, farfield the
// second, and their results stay the same to the last bit from version to version.

/// exp(x) for x <= 0 to about one unit in the last place; exactly 0 for x < -708, so that no result is denormal.
///   x = k ln 2 + r, |r| <= ln 2 / 2 (Cody and Waite: ln 2 in two parts),  exp(x) = 2^k (1 + r + r^2 q(r))
/// q is of degree 9, interpolated at the Chebyshev points: relative error 1.6e-17.
CORE_INLINE Pack exp_interpolated(Pack x) {
  constexpr double shift = 0x1.8p52;  // adding it rounds to an integer that then stands in the low bits
  Pack k = x * 0x1.71547652b82fep+0 + shift;
  const Bits exponent = reinterpret_cast<Bits>(k) << 52;
  k -= shift;
  const Pack r = (x - k * 0x1.62e42fefa0000p-1) - k * 0x1.cf79abc9e3b3ap-40;
  const Pack r2 = r * r;
  const Pack r4 = r2 * r2;
  const Pack q01 = r * 0x1.5555555555556p-3 + 0x1.0000000000001p-1;
  const Pack q23 = r * 0x1.11111111109b3p-7 + 0x1.5555555553d63p-5;
  const Pack q45 = r * 0x1.a01a01a7c41d5p-13 + 0x1.6c16c1788bd90p-10;
  const Pack q67 = r * 0x1.71de0dae63bb3p-19 + 0x1.a019b90d2ae7ap-16;
  const Pack q89 = r * 0x1.af38a9b0ec855p-26 + 0x1.289185613a3d6p-22;
  const Pack q = (q89 * r4 + (q67 * r2 + q45)) * r4 + (q23 * r2 + q01);
  const Pack mantissa = (q * r2 + r) + 1.0;
  const Pack value = reinterpret_cast<Pack>(reinterpret_cast<Bits>(mantissa) + exponent);
  return select(reinterpret_cast<Bits>(x >= -708.0), value);
}

/// exp(x) for x <= 0 to about one unit in the last place; 0 for x < -708.
///   x = k ln 2 + r, |r| <= ln 2 / 2 (Cody and Waite: ln 2 in two parts),  exp(x) = 2^k sum_n r^n / n!
CORE_INLINE Pack exp_taylor(Pack x) {
  constexpr double shift = 0x1.8p52;  // adding it rounds to an integer that then stands in the low bits
  Pack k = x * 0x1.71547652b82fep+0 + shift;
  const Bits exponent = reinterpret_cast<Bits>(k) << 52;
  k -= shift;
  const Pack r = (x - k * 0x1.62e42fefa0000p-1) - k * 0x1.cf79abc9e3b3ap-40;
  Pack sum = broadcast(1.0 / 6227020800.0);  // 1/13!; r^14/14! < 5e-18
  constexpr double factorials[] = {479001600., 39916800., 3628800., 362880., 40320., 5040.,
                                   720.,       120.,      24.,      6.,      2.,     1.};
  for (const double factorial : factorials) sum = sum * r + 1 / factorial;
  sum = sum * r + 1.0;
  const Pack value = reinterpret_cast<Pack>(reinterpret_cast<Bits>(sum) + exponent);
  return select(reinterpret_cast<Bits>(x >= -708.0), value);
}

/// ln(x) for normal x > 0 to about 2e-16 (1 + |ln x|).
///   x = 2^k m, sqrt(1/2) <= m < sqrt(2)
///   ln m = 2 atanh(f) = 2 f (1 + f^2/3 + f^4/5 + ...),  f = (m-1)/(m+1), |f| < 0.172
CORE_INLINE Pack log_positive(Pack x) {
  constexpr unsigned long long root_half = 0x3fe6a09e667f3bcdULL, one = 0x3ff0000000000000ULL;
  const Bits bits = reinterpret_cast<Bits>(x);
  const Bits above = bits - root_half + one;  // exponent field: that of x / sqrt(1/2)
  const Bits exponent = above >> 52;          // k + 1023
  const Pack m = reinterpret_cast<Pack>(bits - ((exponent - 1023) << 52));
  constexpr double shift = 0x1.8p52;
  const Pack k = reinterpret_cast<Pack>((exponent - 1023) + 0x4338000000000000ULL) - shift;
  const Pack f = (m - 1.0) / (m + 1.0), f2 = f * f;
  Pack sum = broadcast(1.0 / 19);  // f^20/21 < 3e-17
  constexpr double odd[] = {17, 15, 13, 11, 9, 7, 5, 3};
  for (const double n : odd) sum = sum * f2 + 1 / n;
  const Pack twice = f + f;
  return k * 0x1.62e42fefa39efp-1 + (twice + twice * (f2 * sum));
}

}  // namespace
}  // namespace gaussdrift::core::CORE_ISA
