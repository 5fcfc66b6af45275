// Refuses bad arguments with a sentence that names the argument, its value and the rule.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/arguments.hpp"
#include "farfield/farfield.hpp"

namespace farfield::detail {

using gaussdrift::core::text;

/// The kernel exists in that dimension, and the options suit it.
void check_options(Kernel kernel, const Options& options, int dimension);

/// Every entry of `points` (dimension x count) is finite; `kind` is "source" or "target".
void check_points(const char* kind, const double* points, std::size_t dimension, std::size_t count, std::size_t stride,
                  int threads);

/// Finite, and one for every source.
void check_charges(const Eigen::Ref<const Eigen::VectorXd>& charges, std::size_t sources);

/// Throws TimeLimitError if more seconds are predicted than may be.
void check_seconds(Method method, double seconds, double most);

/// Throws MemoryLimitError if `bytes` for `what` exceed the limit.
void check_memory(const char* what, double bytes, std::size_t limit);

/// Throws RangeError naming the first target whose value is not finite, by its number if they have any.
void check_values(const char* what, const double* values, std::size_t count, std::size_t numbers_a_target,
                  const std::int64_t* numbers);

}  // namespace farfield::detail
