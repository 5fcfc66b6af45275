// What chance does to the density of a random walk. docs/method.md, section 10.
#pragma once

#include "accuracy/budget.hpp"

namespace gaussdrift::accuracy {

/// The budget of such a case: what chance does, the error of the transform, and what remains of the total
/// where the exact density is known. The other causes are not told apart.
Budget budget_of_walk(const Case& spec, const Scene& scene, const LastFrame::Kept& last, int threads);

}  // namespace gaussdrift::accuracy
