// The functions that expressions may call, each applied to rows of numbers.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "expression/expression.hpp"

namespace gaussdrift::expression {

/// Numbers computed at a time: 2 KiB a row, so that a stack of rows stays in the first cache.
constexpr std::size_t row_length = 256;

/// first[i] = f(first[i], first[row_length + i], ...) for i < count, with `arguments` rows one after the other.
using RowFunction = void (*)(double* first, int arguments, std::size_t count);

/// slopes[k * row_length + i] = d f / d argument k at the arguments that `operands` holds in rows.
using RowSlopes = void (*)(const double* operands, int arguments, std::size_t count, double* slopes);

struct Function {
  FunctionInfo info;
  RowFunction apply;
  RowSlopes slopes;
  std::string_view rough = {};  // where it has no derivative and what is taken there; empty if it is smooth
};

/// Those of a ^ b. Where a is 0, d/db is taken as 0.
void power_slopes(const double* operands, int arguments, std::size_t count, double* slopes);

const std::vector<Function>& functions();

}  // namespace gaussdrift::expression
