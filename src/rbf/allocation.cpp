// The library's own way of allocating Eigen's matrices, for the linker to compare with the program's.
#include "rbf/rbf.hpp"

namespace rbf::detail {

template <int alignment, int by_malloc>
void compile_with_the_same_march_and_sanitizer_flags_as_rbf() {}

template void
compile_with_the_same_march_and_sanitizer_flags_as_rbf<EIGEN_DEFAULT_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>();

}  // namespace rbf::detail
