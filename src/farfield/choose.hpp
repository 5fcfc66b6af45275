// Chooses the method with the smallest predicted time, and the leaf size, and prepares the sum.
#pragma once

#include <memory>

#include "farfield/farfield.hpp"
#include "farfield/site.hpp"

namespace farfield::detail {

/// Completes `choice`. Throws ToleranceError, MemoryLimitError, TimeLimitError.
template <int d>
std::unique_ptr<Summation> choose_summation(const Problem& problem, const Options& options, Site<d>& site,
                                            Choice& choice);

}  // namespace farfield::detail
