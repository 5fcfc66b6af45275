// Checks the grammar of an expression before muParser sees it: muParser names neither the place nor the remedy
// reliably, and accepts assignments, lists, strings and chained comparisons that nobody means. Knows nothing about
// values and precedence.
#pragma once

#include <string>
#include <vector>

#include "expression/expression.hpp"

namespace gaussdrift::expression {

/// Throws ExpressionError at the first token that does not fit; returns the names used, in the order of their first
/// mention.
std::vector<std::string> check_syntax(const std::string& text, const std::vector<std::string>& variables,
                                      const std::vector<std::string>& constants);

}  // namespace gaussdrift::expression
