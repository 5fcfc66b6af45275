// The kernel `product` of `hermite` and `spread`.
#include "fgtd/kernels/product.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {

void product(const ProductJob& job) {
  multiply_add(job.rows, job.depth, job.width, job.b, job.b_stride, job.d, job.d_stride, job.c, job.c_stride);
}

}  // namespace fgtd::detail::CORE_ISA
