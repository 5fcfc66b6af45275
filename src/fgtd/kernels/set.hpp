// The kernels of the instruction set CORE_ISA, each defined in the source of its method; table.cpp lists them.
#pragma once

#include "core/simd/pack.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail::CORE_ISA {

using namespace gaussdrift::core::CORE_ISA;

#define FGTD_KERNEL(kernel, Job) void kernel(const Job& job);
FGTD_KERNELS(FGTD_KERNEL)
#undef FGTD_KERNEL

extern const Kernels kernels;

}  // namespace fgtd::detail::CORE_ISA
