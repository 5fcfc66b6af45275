// The functions that expressions may call, each applied to rows of numbers.
#pragma once

#include <cstddef>
#include <vector>

#include "expression/expression.hpp"

namespace gaussdrift::expression {

constexpr std::size_t row_length =
    256;  // numbers computed at a time: 2 KiB a row, so that a stack of rows stays in the first cache

/// first[i] = f(first[i], first[row_length + i], ...) for i < count, with `arguments` rows one after the other.
using RowFunction = void (*)(double* first, int arguments, std::size_t count);

struct Function {
  FunctionInfo info;
  RowFunction apply;
};

const std::vector<Function>& functions();

}  // namespace gaussdrift::expression
