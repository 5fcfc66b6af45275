// Four points at a time, whatever the instruction set: numbers of one point side by side. For the sources that may include
// core/simd/pack.hpp.
#pragma once

#include "core/simd/pack.hpp"

namespace fgtd::detail::CORE_ISA {

using namespace gaussdrift::core::CORE_ISA;

namespace {

constexpr std::size_t quad = 4;
using Quad = double __attribute__((vector_size(32)));
using QuadIndex = long long __attribute__((vector_size(32)));
using QuadKey = int __attribute__((vector_size(16)));
typedef double UnalignedQuad __attribute__((vector_size(32), aligned(8), may_alias));
static_assert(alignof(UnalignedQuad) == 8);  // as in core/simd/pack.hpp

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
}  // namespace fgtd::detail::CORE_ISA
