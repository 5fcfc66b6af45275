// All kernels of one instruction set.
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::FGTD_ISA {

#define FGTD_TEXT_OF(x) #x
#define FGTD_TEXT(x) FGTD_TEXT_OF(x)
const Kernels kernels = {
    FGTD_TEXT(FGTD_ISA), FGTD_LANES, direct,      product, expansion, table, spread, cells, outer, locate,
    sort_block,          moments,    interpolate, chain};

}  // namespace fgtd::detail::FGTD_ISA
