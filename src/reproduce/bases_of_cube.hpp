// Five ways to approximate a potential in a cube by few functions, and how many each takes.
#pragma once

#include <vector>

#include "reproduce/kernels.hpp"

namespace gaussdrift::reproduce {

/// For 1/r between points of two cubes of side 1 whose centres are 2 apart.
std::vector<KernelsBases> compare_bases(const std::vector<double>& errors);

}  // namespace gaussdrift::reproduce
