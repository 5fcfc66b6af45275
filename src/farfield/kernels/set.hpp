// The kernels of the instruction set CORE_ISA, each defined in the source of its method; table.cpp lists
// them.
#pragma once

#include "core/simd/pack.hpp"
#include "farfield/kernels/kernels.hpp"

namespace farfield::detail::CORE_ISA {

using namespace gaussdrift::core::CORE_ISA;

void pairs(const PairsJob& job);
void product(const ProductJob& job);
void moments(const MomentsJob& job);
void expansion(const ExpansionJob& job);
void inverse_roots(const InverseRootsJob& job);
void general_pairs(const GeneralPairsJob& job);

extern const Kernels kernels;

}  // namespace farfield::detail::CORE_ISA
