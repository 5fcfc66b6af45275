// Settings that a budget suggests: what could be saved, what would help.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "accuracy/budget.hpp"
#include "gaussdrift/case.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

/// Cutoffs of higher order than the case's that need no parameters, by name.
std::vector<std::string> higher_cutoffs(const Case& spec);

/// The smoothing of cutoffs of higher order at the same width.
using Better = std::vector<std::pair<std::string, double>>;

/// Adds advice that follows from the numbers, and that `run` does not refuse.
void give_advice(const Case& spec, const Scene& scene, const Better& better, int threads, Budget& budget);

}  // namespace gaussdrift::accuracy
