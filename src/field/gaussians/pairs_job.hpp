// The arguments of the kernels of sum_gaussian_pairs(): a group of targets, padded by repeating one of them.
#pragma once

#include <cstddef>

namespace gaussdrift::detail {

constexpr std::size_t target_group = 16;

struct PairsJob {
  double sigma;
  std::size_t sources;
  const double* position;      // [dimension][sources]
  const double* coefficients;  // [columns][sources]
  const double* target;        // [dimension][target_group]
  double* values;              // [rows][target_group], overwritten
};

/// By GaussianMatrix and dimension - 2.
struct PairsKernels {
  void (*sum[3][2])(const PairsJob&);
};

}  // namespace gaussdrift::detail
