// All kernels of one instruction set.
#include "rbf/kernels/set.hpp"

namespace rbf::detail::CORE_ISA {

#define CORE_TEXT_OF(x) #x
#define CORE_TEXT(x) CORE_TEXT_OF(x)
const Kernels kernels = {CORE_TEXT(CORE_ISA), CORE_LANES, pairs, near};

}  // namespace rbf::detail::CORE_ISA
