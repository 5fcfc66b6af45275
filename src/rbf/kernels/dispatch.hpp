// The kernels of all instruction sets; apart from kernels.hpp, since sources that are compiled for one of them must not
// see the standard library.
#pragma once

#include <vector>

#include "rbf/kernels/kernels.hpp"

namespace rbf::detail {

/// The sets that this processor runs, slowest first; at least one.
std::vector<const Kernels*> supported_kernels();

}  // namespace rbf::detail
