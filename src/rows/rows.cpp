#include "rows/rows.hpp"

#include "core/dispatch.hpp"

namespace gaussdrift::rows {

CORE_DECLARE_TABLES(Kernels, row_kernels)

const Kernels& kernels() {
  static const Kernels& fastest = *all_kernels().back();
  return fastest;
}

std::vector<const Kernels*> all_kernels() { return core::supported<Kernels>(CORE_TABLES(row_kernels)); }

bool has_sleef() {
#ifdef GAUSSDRIFT_HAS_SLEEF
  return true;
#else
  return false;
#endif
}

}  // namespace gaussdrift::rows
