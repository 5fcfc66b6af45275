// The library's own way of allocating Eigen's matrices, for the linker to compare with the program's.
#include "fgtd/fgtd.hpp"

namespace fgtd::detail {

template <int alignment, int by_malloc>
void compile_with_the_same_march_and_sanitizer_flags_as_fgtd() {}

template void
compile_with_the_same_march_and_sanitizer_flags_as_fgtd<EIGEN_DEFAULT_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>();

}  // namespace fgtd::detail
