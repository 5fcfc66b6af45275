// An expression as postfix steps, run over rows of numbers: one operation for a whole row at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "expression/functions.hpp"

namespace gaussdrift::expression {

enum class Operation {
  constant,
  variable,
  negate,
  call,
  choose,  // choose: condition, a, b -> a or b
  add,
  subtract,
  multiply,
  divide,
  power,
  square,
  cube,
  fourth,
  less,
  greater,
  less_equal,
  greater_equal,
  equal,
  not_equal,
  both,
  either
};

struct Step {
  Operation operation;
  int operands = 0;  // rows it takes from the top of the stack; it leaves one
  double value = 0;
  std::size_t variable = 0;
  const Function* function = nullptr;
};

using Program = std::vector<Step>;

/// A stack of rows. If all numbers of a row are the same, only the first is kept: constants, and formulas of t alone.
struct Stack {
  double* rows;
  std::vector<char> same;  // by row

  double* row(std::size_t k) const { return rows + k * row_length; }
  void spread(std::size_t k, std::size_t count) {
    if (same[k]) std::fill_n(row(k) + 1, count - 1, *row(k));
    same[k] = false;
  }
};

/// One step on the rows whose first operand is `a`; the result replaces `a`. Variables start at index `first`.
void run_step(const Step& step, const double* const* arguments, std::size_t first, std::size_t count, double* a);

/// The same bits everywhere?
bool all_same(const double* values, std::size_t count);

/// Runs the steps for `count` >= 1 numbers; the result is the first row.
void run(const Step* step, std::size_t steps, const double* const* arguments, std::size_t first, std::size_t count,
         Stack& stack);

/// Runs the steps forward with their derivatives. `stack` holds the values as run() leaves them; values beyond the
/// first row are lost. derivatives[d] has one row a row of the stack; the derivative with respect to variable
/// variables[d] of the result is its first row, which is written in full.
void run_with_derivatives(const Program& program, const double* const* arguments, std::size_t first, std::size_t count,
                          const std::vector<std::size_t>& variables, Stack& stack,
                          const std::vector<double*>& derivatives);

}  // namespace gaussdrift::expression
