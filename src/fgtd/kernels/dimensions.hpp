// A kernel is compiled for every dimension of points; the number in its job picks one. For the sources that may include
// core/simd/pack.hpp.
#pragma once

#include "core/simd/pack.hpp"

namespace fgtd::detail::CORE_ISA {

using namespace gaussdrift::core::CORE_ISA;

namespace {

template <int value>
struct Dimension {
  static constexpr int d = value;
};

/// Calls use(Dimension<dimension>{}), dimension = 1 .. 4.
template <class Use>
CORE_INLINE void in_dimension(int dimension, const Use& use) {
  switch (dimension) {
    case 1:
      return use(Dimension<1>{});
    case 2:
      return use(Dimension<2>{});
    case 3:
      return use(Dimension<3>{});
    default:
      return use(Dimension<4>{});
  }
}

}  // namespace
}  // namespace fgtd::detail::CORE_ISA
