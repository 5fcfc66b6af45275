// Arrays as NumPy loads them (.npy, version 1.0): Float64, little-endian, in the order of Fortran: the first axis runs
// fastest.
#pragma once

#include <cstddef>
#include <cstdio>
#include <vector>

namespace gaussdrift::write {

/// The product of `shape` is the number of values. Throws std::system_error.
void write_npy(std::FILE* out, const std::vector<std::size_t>& shape, const double* values);

}  // namespace gaussdrift::write
