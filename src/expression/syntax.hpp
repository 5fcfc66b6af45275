// Checks the grammar of an expression before muParser sees it. muParser does not reliably name the place and the remedy.
// It also accepts assignments, lists, strings and chained comparisons, which nobody means. The check knows nothing about
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
