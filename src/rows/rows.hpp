// Functions of rows of numbers, one call for a row, by the widest vectors that the machine has. Results are the same bits
// for all of them: nothing is contracted, and SLEEF's deterministic functions do not depend on the length of a vector.
// [SP20] They differ from the C library's by one unit in the last place at most, and so do the results of a build without SLEEF.
#pragma once

#include <vector>

#include "rows/kernels.hpp"

namespace gaussdrift::rows {

/// The fastest that this machine runs.
const Kernels& kernels();

/// Those for each instruction set that this machine runs, slowest first.
std::vector<const Kernels*> all_kernels();

/// Are sines, exponentials and powers those of SLEEF? Else they are the C library's, one number at a time.
bool has_sleef();

}  // namespace gaussdrift::rows
