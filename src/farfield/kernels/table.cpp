// All kernels of one instruction set.
#include "farfield/kernels/set.hpp"

namespace farfield::detail::CORE_ISA {

#define CORE_TEXT_OF(x) #x
#define CORE_TEXT(x) CORE_TEXT_OF(x)
const Kernels kernels = {CORE_TEXT(CORE_ISA), CORE_LANES,    pairs,        product, moments,
                         expansion,           inverse_roots, general_pairs};

}  // namespace farfield::detail::CORE_ISA
