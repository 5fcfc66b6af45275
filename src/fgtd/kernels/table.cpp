// All kernels of one instruction set.
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {

#define CORE_TEXT_OF(x) #x
#define CORE_TEXT(x) CORE_TEXT_OF(x)
#define FGTD_KERNEL(kernel, Job) kernel,
const Kernels kernels = {CORE_TEXT(CORE_ISA), CORE_LANES, FGTD_KERNELS(FGTD_KERNEL)};
#undef FGTD_KERNEL

}  // namespace fgtd::detail::CORE_ISA
