// Vectors of FGTD_LANES doubles in namespace FGTD_ISA, for the kernels of all methods. Only *_kernels.cpp include it,
// which are compiled once for every instruction set. An inline function that other sources include too would exist in
// several versions, and the linker might keep one with instructions that the processor lacks. So kernels use nothing of
// the standard library, and their helpers have internal linkage.
#pragma once

#include <cstddef>

namespace fgtd::detail::FGTD_ISA {
namespace {

constexpr std::size_t lanes = FGTD_LANES;

using Vector = double __attribute__((vector_size(8 * FGTD_LANES)));
using Bits = unsigned long long __attribute__((vector_size(8 * FGTD_LANES)));
typedef double Unaligned __attribute__((vector_size(8 * FGTD_LANES), aligned(8), may_alias));
static_assert(alignof(Unaligned) == 8);  // clang ignores `aligned` where the name is given by `using`

#define FGTD_INLINE inline __attribute__((always_inline))

FGTD_INLINE Vector load(const double* from) { return *reinterpret_cast<const Unaligned*>(from); }
FGTD_INLINE void store(double* to, Vector x) { *reinterpret_cast<Unaligned*>(to) = x; }
FGTD_INLINE Vector broadcast(double x) { return Vector{} + x; }
FGTD_INLINE Vector select(Bits mask, Vector x) { return reinterpret_cast<Vector>(mask & reinterpret_cast<Bits>(x)); }
FGTD_INLINE Vector clamp(Vector x, double bound) {
  x = x > bound ? broadcast(bound) : x;
  return x < -bound ? broadcast(-bound) : x;
}

/// exp(x) for x <= 0 to about one unit in the last place; exactly 0 for x < -708, so that no result is denormal.
///   x = k ln 2 + r, |r| <= ln 2 / 2 (Cody and Waite: ln 2 in two parts),  exp(x) = 2^k (1 + r + r^2 q(r))
/// q is of degree 9, interpolated at the Chebyshev points: relative error 1.6e-17.
FGTD_INLINE Vector exp_nonpositive(Vector x) {
  constexpr double shift = 0x1.8p52;  // adding it rounds to an integer that then stands in the low bits
  Vector k = x * 0x1.71547652b82fep+0 + shift;
  const Bits exponent = reinterpret_cast<Bits>(k) << 52;
  k -= shift;
  const Vector r = (x - k * 0x1.62e42fefa0000p-1) - k * 0x1.cf79abc9e3b3ap-40;
  const Vector r2 = r * r;
  const Vector r4 = r2 * r2;
  const Vector q01 = r * 0x1.5555555555556p-3 + 0x1.0000000000001p-1;
  const Vector q23 = r * 0x1.11111111109b3p-7 + 0x1.5555555553d63p-5;
  const Vector q45 = r * 0x1.a01a01a7c41d5p-13 + 0x1.6c16c1788bd90p-10;
  const Vector q67 = r * 0x1.71de0dae63bb3p-19 + 0x1.a019b90d2ae7ap-16;
  const Vector q89 = r * 0x1.af38a9b0ec855p-26 + 0x1.289185613a3d6p-22;
  const Vector q = (q89 * r4 + (q67 * r2 + q45)) * r4 + (q23 * r2 + q01);
  const Vector mantissa = (q * r2 + r) + 1.0;
  const Vector value = reinterpret_cast<Vector>(reinterpret_cast<Bits>(mantissa) + exponent);
  return select(reinterpret_cast<Bits>(x >= -708.0), value);
}

}  // namespace
}  // namespace fgtd::detail::FGTD_ISA
