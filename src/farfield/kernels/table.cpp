// All kernels of one instruction set.
#include "farfield/kernels/set.hpp"

namespace farfield::detail::FARFIELD_ISA {

#define FARFIELD_TEXT_OF(x) #x
#define FARFIELD_TEXT(x) FARFIELD_TEXT_OF(x)
const Kernels kernels = {
    FARFIELD_TEXT(FARFIELD_ISA), FARFIELD_LANES, pairs, product, moments, expansion, inverse_roots};

}  // namespace farfield::detail::FARFIELD_ISA
