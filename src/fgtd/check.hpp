// Refuses bad arguments with a sentence that names the argument, its value and the rule.
#pragma once

#include <cstddef>
#include <string>

#include "core/arguments.hpp"
#include "fgtd/fgtd.hpp"

namespace fgtd::detail {

using gaussdrift::core::text;

/// Every entry of `points` (d x m) is finite; `kind` is "source" or "target".
void check_points(const char* kind, const double* points, std::size_t dimension, std::size_t count, std::size_t stride,
                  int threads);

/// Every entry of `weights` (N x c) is finite and there are N of them.
void check_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights, std::size_t sources, int threads);

void check_sigma(double sigma);
void check_options(const Options& options, std::size_t dimension);
void check_grid(const char* name, const TensorGrid& grid, std::size_t dimension);

/// Throws TimeLimitError if more seconds are predicted than may be.
void check_seconds(const Choice& choice, double most);

/// Throws MemoryLimitError if `bytes` for `what` exceed the limit.
void check_memory(const char* what, double bytes, std::size_t limit);

}  // namespace fgtd::detail
