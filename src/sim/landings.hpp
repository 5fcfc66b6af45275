// The times on which the steps of a case land.
#pragma once

#include <cstddef>
#include <vector>

#include "gaussdrift/case.hpp"

namespace gaussdrift {

/// The elapsed times on which steps land exactly: outputs, time.end, those at which sources release something, and the
/// frames of an animation.
std::vector<double> landings(const Case& spec);

/// The same without the frames.
std::vector<double> landings_without_moments(const Case& spec);

/// Releases this near to a landing happen then.
double rounding_of_times(const Case& spec);

/// Steps from t = 0 to time.end with landings on all output times; 0 if they are chosen by their error.
std::size_t total_steps(const Case& spec);

}  // namespace gaussdrift
