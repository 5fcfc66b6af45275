// What formula.cpp hands to its kernels.
#pragma once

#include <cstddef>

namespace gaussdrift::named {

struct FormulaJob {
  const double* parameters = nullptr;
  double* x[3] = {};  // one array an axis; only read for rates
  std::size_t count = 0;
  // of rates:
  const double* of_time = nullptr;  // the formula's numbers at one time
  double* u[3] = {};                // is added to
  // of steps (block_carrier.hpp):
  int stages = 0;
  const double *stage_weights = nullptr, *weights = nullptr, *lengths = nullptr, *of_stages = nullptr;
  std::size_t steps = 0;
};

using FormulaKernel = void (*)(const FormulaJob& job);

struct FormulaKernels {
  struct Entry {
    FormulaKernel rates, carry;
  } entries[14];
};

}  // namespace gaussdrift::named
