// Words and symbols that other languages have in formulas, and what is written here instead.
#pragma once

#include <string_view>

namespace gaussdrift::expression {

/// "write sign(a)" for sgn; empty for words that are not known from elsewhere.
std::string_view instead_of_function(std::string_view name);

/// The same for names that are not called: true, time, and, ...
std::string_view instead_of_name(std::string_view name);

/// The same for symbols: **, &, ², ...
std::string_view instead_of_symbol(std::string_view symbol);

}  // namespace gaussdrift::expression
