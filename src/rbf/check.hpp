// Refuses bad arguments with a sentence that names the argument, its value and the rule.
#pragma once

#include <cstddef>
#include <string>

#include "core/arguments.hpp"
#include "rbf/rbf.hpp"

namespace rbf::detail {

using gaussdrift::core::text;

/// The kernel exists, and the shape is what it takes.
void check_function(const Function& function);

/// The options suit the kernel.
void check_options(const Function& function, const Options& options);

/// Every entry of `points` (dimension x count) is finite; `kind` is "centre" or "target".
void check_points(const char* kind, const double* points, std::size_t dimension, std::size_t count, std::size_t stride,
                  int threads);

/// Every entry of `weights` (N x c) is finite and there are N of them.
void check_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights, std::size_t centres, int threads);

/// As many axes as dimensions, of finite ascending nodes.
void check_grid(const char* name, const TensorGrid& grid, std::size_t dimension);

/// Throws TimeLimitError if more seconds are predicted than may be.
void check_seconds(Method method, double seconds, double most);

/// Throws MemoryLimitError if `bytes` for `what` exceed the limit.
void check_memory(const char* what, double bytes, std::size_t limit);

}  // namespace rbf::detail
