// Packs of CORE_LANES doubles (SIMD vectors), in namespace CORE_ISA. Only sources that are compiled once for every instruction set may
// include this (cmake/InstructionSets.cmake). An inline function that other sources include too would exist in several
// versions, and the linker might keep one with instructions that the processor lacks. So those sources use nothing of
// the standard library, and their helpers have internal linkage.
#pragma once

#include <cstddef>

namespace gaussdrift::core::CORE_ISA {
namespace {

constexpr std::size_t lanes = CORE_LANES;

using Pack = double __attribute__((vector_size(8 * CORE_LANES)));
using Bits = unsigned long long __attribute__((vector_size(8 * CORE_LANES)));
using Signed = long long __attribute__((vector_size(8 * CORE_LANES)));  // of a comparison
typedef double Unaligned __attribute__((vector_size(8 * CORE_LANES), aligned(8), may_alias));
static_assert(alignof(Unaligned) == 8);  // clang ignores `aligned` where the name is given by `using`

#define CORE_INLINE inline __attribute__((always_inline))

CORE_INLINE Pack load(const double* from) { return *reinterpret_cast<const Unaligned*>(from); }
CORE_INLINE void store(double* to, Pack x) { *reinterpret_cast<Unaligned*>(to) = x; }
CORE_INLINE Pack broadcast(double x) { return Pack{} + x; }
CORE_INLINE Pack select(Bits mask, Pack x) { return reinterpret_cast<Pack>(mask & reinterpret_cast<Bits>(x)); }
template <class Mask>
CORE_INLINE bool any(Mask mask) {
  unsigned long long words[sizeof(Mask) / 8], all = 0;
  __builtin_memcpy(words, &mask, sizeof mask);
  for (const unsigned long long word : words) all |= word;
  return all != 0;
}
CORE_INLINE Pack clamp(Pack x, double bound) {
  x = x > bound ? broadcast(bound) : x;
  return x < -bound ? broadcast(-bound) : x;
}

}  // namespace
}  // namespace gaussdrift::core::CORE_ISA
