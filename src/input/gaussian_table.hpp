// The table of a velocity made of Gaussians: scattered points, and what is known there.
#pragma once

#include <filesystem>
#include <vector>

#include "field/gaussians/gaussian_velocity.hpp"

namespace gaussdrift::input {

struct GaussianTable {
  std::vector<double> positions;  // [point][dimension]
  std::vector<double> values;     // [point][gaussian_values]
};

/// The columns are gaussian_columns_of(kind, dimension). Throws FileError if the file cannot be read, and InputError,
/// naming file, line and column, for what it contains: two samples at the same place among that.
GaussianTable read_gaussian_table(const std::filesystem::path& file, GaussianKind kind, int dimension);

}  // namespace gaussdrift::input
