// Picks the instruction set once, at the first use.
#include "farfield/kernels/kernels.hpp"

namespace farfield::detail {

namespace baseline {
extern const Kernels kernels;
}
#ifdef FARFIELD_X86_VARIANTS
namespace avx2 {
extern const Kernels kernels;
}
namespace avx512 {
extern const Kernels kernels;
}
#endif

KernelSets supported_kernels() {
  KernelSets sets{{&baseline::kernels, nullptr, nullptr}, 1};
#ifdef FARFIELD_X86_VARIANTS
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) sets.set[sets.count++] = &avx2::kernels;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    sets.set[sets.count++] = &avx512::kernels;
  }
#endif
  return sets;
}

const Kernels& fastest_kernels() {
  static const KernelSets sets = supported_kernels();
  return *sets.set[sets.count - 1];
}

}  // namespace farfield::detail
