// The kernels of the instruction set FARFIELD_ISA, each defined in the source of its method; farfield/kernels/table.cpp lists
// them.
#pragma once

#include "farfield/kernels/kernels.hpp"

namespace farfield::detail::FARFIELD_ISA {

void pairs(const PairsJob& job);
void product(const ProductJob& job);
void moments(const MomentsJob& job);
void expansion(const ExpansionJob& job);
void inverse_roots(const InverseRootsJob& job);

extern const Kernels kernels;

}  // namespace farfield::detail::FARFIELD_ISA
