// Looks at numbers that a caller gives, and says in a sentence what is wrong with them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace gaussdrift::core {

/// Shortest decimal text that names the number: "2", "0.1", "nan", "1e-15".
std::string text(double value);

/// Whether columns of `rows` numbers, `stride` numbers apart, are finite.
bool all_finite(const double* data, std::size_t rows, std::size_t columns, std::size_t stride, int threads);

/// The first coordinate that is not finite, as "source 3, coordinate 1 is nan; sources must be finite". `points` are
/// columns of `dimension` numbers, `stride` numbers apart; `kind` is "source" or "target".
std::optional<std::string> point_that_is_not_finite(const char* kind, const double* points, std::size_t dimension,
                                                    std::size_t count, std::size_t stride, int threads);

}  // namespace gaussdrift::core
