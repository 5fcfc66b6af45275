// Whether `run` would take a case that a study, a hint or --accuracy is about to recommend. The run itself is asked.
#pragma once

#include <string>

#include "gaussdrift/case.hpp"

namespace gaussdrift::study {

/// Why reading the case as a file would refuse it, in one line; empty: it would not. Data that it names are not read
/// again.
std::string why_not_read(const Case& scene);

/// Why `run` would refuse the case before its first step: what why_not_read() says, then what Simulation::prepare()
/// does. Empty: it would not.
std::string why_refused(const Case& scene, int threads);

/// Lattice points of particles beyond which nothing is recommended that would have to be seeded to be judged.
constexpr double most_judged = 4e6;

}  // namespace gaussdrift::study
