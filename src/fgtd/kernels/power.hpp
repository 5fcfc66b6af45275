// Powers of two by polynomials whose degree suits the tolerance: the exponentials of `cells` and `outer_product`. For the sources
// that may include core/simd/pack.hpp.
#pragma once

#include "core/simd/pack.hpp"

namespace fgtd::detail::CORE_ISA {

using namespace gaussdrift::core::CORE_ISA;

namespace {

/// Coefficients of 2^r, |r| <= 1/2; errors in `exponentials`.
template <int degree>
struct PowerOfTwo;
template <>
struct PowerOfTwo<4> {
  static constexpr double c[] = {1.0, 0x1.62e0c2faa2d86p-1, 0x1.ebfa4b174fc27p-3, 0x1.ca1ce22bd89aap-5,
                                 0x1.3cbf6052845e6p-7};
};
template <>
struct PowerOfTwo<6> {
  static constexpr double c[] = {1.0,
                                 0x1.62e430d034702p-1,
                                 0x1.ebfbe045f4d3cp-3,
                                 0x1.c6aecc669b6ddp-5,
                                 0x1.3b2a1b7152befp-7,
                                 0x1.5f48c04f62e50p-10,
                                 0x1.443fffc90db59p-13};
};
template <>
struct PowerOfTwo<8> {
  static constexpr double c[] = {1.0,
                                 0x1.62e42fef84cf0p-1,
                                 0x1.ebfbdff823cedp-3,
                                 0x1.c6b08dd6fd234p-5,
                                 0x1.3b2ab7181b755p-7,
                                 0x1.5d8745a728441p-10,
                                 0x1.4308ac85aa947p-13,
                                 0x1.00dc4a532fb8ep-16,
                                 0x1.63d136366db24p-20};
};
template <>
struct PowerOfTwo<11> {
  static constexpr double c[] = {1.0,
                                 0x1.62e42fefa39efp-1,
                                 0x1.ebfbdff82c5aep-3,
                                 0x1.c6b08d704a0c6p-5,
                                 0x1.3b2ab6fb9f1a5p-7,
                                 0x1.5d87fe78a3f9cp-10,
                                 0x1.430913112c61bp-13,
                                 0x1.ffcbfc6da6ed1p-17,
                                 0x1.62bfc2c86d700p-20,
                                 0x1.b524ebd13a55fp-24,
                                 0x1.e6228acd1c6e5p-28,
                                 0x1.e9ec1fcb69a7fp-32};
};

/// 2^-s, s = scale squared, where squared >= 0, squared <= limit and s <= 1000; exactly 0 for larger squared and NaN.
template <int degree>
CORE_INLINE Pack power_of_half(Pack squared, double scale, double limit) {
  constexpr double shift = 0x1.8p52;  // adding it rounds to an integer that then stands in the low bits
  Pack k = squared * scale + shift;
  const Bits exponent = reinterpret_cast<Bits>(k) << 52;
  k -= shift;
  const Pack r = k - squared * scale;
  Pack power = broadcast(PowerOfTwo<degree>::c[degree]);
  for (int i = degree - 1; i >= 0; --i) power = power * r + PowerOfTwo<degree>::c[i];
  const Pack value = reinterpret_cast<Pack>(reinterpret_cast<Bits>(power) - exponent);
  return select(reinterpret_cast<Bits>(squared <= limit), value);
}

}  // namespace
}  // namespace fgtd::detail::CORE_ISA
