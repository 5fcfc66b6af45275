// A kernel of general.hpp as the sums see it.
#pragma once

#include <cstddef>

#include "farfield/general.hpp"
#include "farfield/kernels/kernels.hpp"

namespace farfield::detail {

struct KernelData {
  GeneralShape shape;
  double parameter = 0;  // lambda, power or sigma
  KernelFunction::OfDistance of_distance{};
  KernelFunction::OfDifference of_difference{};
  double nanoseconds = 1;

  /// Depends on the distance alone.
  bool radial() const { return shape != GeneralShape::of_difference; }
};

/// Numbers that are passed to a kernel at a time.
constexpr std::size_t kernel_block = 256;

/// values[i] = k(difference[.][i]) for i < count <= kernel_block. At distance 0, a value that is not finite is 0.
void kernel_values(const KernelData& kernel, int dimension, const double* const* difference, std::size_t count,
                   double* values);

/// out_i += sum_j q_j k(x_i - y_j) for a range of targets and some ranges of sources.
void add_pairs(const KernelData& kernel, int dimension, const double* const* target, Range targets,
               const double* const* source, const double* charge, const Range* runs, std::size_t run_count,
               double* out);

}  // namespace farfield::detail
