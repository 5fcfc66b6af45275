// Picks the instruction set once, at the first use.
#include "rbf/kernels/dispatch.hpp"

#include "core/dispatch.hpp"

namespace rbf::detail {

CORE_DECLARE_TABLES(Kernels, kernels)

std::vector<const Kernels*> supported_kernels() { return gaussdrift::core::supported<Kernels>(CORE_TABLES(kernels)); }

const Kernels& fastest_kernels() {
  static const Kernels& fastest = *supported_kernels().back();
  return fastest;
}

}  // namespace rbf::detail
