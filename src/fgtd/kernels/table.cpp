// All kernels of one instruction set.
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {

#define CORE_TEXT_OF(x) #x
#define CORE_TEXT(x) CORE_TEXT_OF(x)
const Kernels kernels = {CORE_TEXT(CORE_ISA), CORE_LANES, direct,     product, expansion,   table, spread, cells,
                         outer_product,       locate,     sort_block, moments, interpolate, chain};

}  // namespace fgtd::detail::CORE_ISA
