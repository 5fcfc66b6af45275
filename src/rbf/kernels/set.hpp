// The kernels of the instruction set CORE_ISA; table.cpp lists them.
#pragma once

#include "core/simd/pack.hpp"
#include "rbf/kernels/kernels.hpp"

namespace rbf::detail::CORE_ISA {

using namespace gaussdrift::core::CORE_ISA;

void pairs(const PairsJob& job);
void near(const NearJob& job);

extern const Kernels kernels;

}  // namespace rbf::detail::CORE_ISA
