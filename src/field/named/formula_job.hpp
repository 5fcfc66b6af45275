// Which formulas there are, and what formula.cpp hands to their kernels.
#pragma once

#include <cstddef>

namespace gaussdrift::named {

enum class Formula {
#define FORMULA(name, type) name,
#include "field/named/formula_list.inc"
#undef FORMULA
  count
};

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
  } entries[static_cast<std::size_t>(Formula::count)];
};

}  // namespace gaussdrift::named
