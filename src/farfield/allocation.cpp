// The library's own way of allocating Eigen's matrices, for the linker to compare with the program's.
#include "farfield/farfield.hpp"

namespace farfield::detail {

template <int alignment, int by_malloc>
void compile_with_the_same_march_and_sanitizer_flags_as_farfield() {}

template void
compile_with_the_same_march_and_sanitizer_flags_as_farfield<EIGEN_DEFAULT_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>();

}  // namespace farfield::detail
