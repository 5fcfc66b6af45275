// n! as a number.
#pragma once

#include <cmath>

namespace gaussdrift {

inline double factorial(int n) { return std::tgamma(n + 1.0); }

}  // namespace gaussdrift
