// The kernels of the instruction set CORE_ISA, each defined in the source of its method; table.cpp lists them.
#pragma once

#include "core/simd/pack.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail::CORE_ISA {

using namespace gaussdrift::core::CORE_ISA;

void direct(const DirectJob& job);
void product(const ProductJob& job);
void expansion(const ExpansionJob& job);
void table(const TableJob& job);
void spread(const SpreadJob& job);
void cells(const CellsJob& job);
void outer_product(const OuterProductJob& job);
void locate(const LocateJob& job);
void sort_block(const SortBlockJob& job);
void moments(const MomentsJob& job);
void interpolate(const InterpolateJob& job);
void chain(const ChainJob& job);

extern const Kernels kernels;

}  // namespace fgtd::detail::CORE_ISA
