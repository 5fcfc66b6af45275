// What stands where there is no number.
#pragma once

#include <limits>

namespace gaussdrift::base {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace gaussdrift::base
