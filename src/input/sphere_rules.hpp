// What a case on a sphere may have, and what a case in the plane may not.
#pragma once

#include "gaussdrift/case.hpp"
#include "input/reader.hpp"

namespace gaussdrift::input {

/// Refuses what knows lengths alone where places are longitudes and latitudes, and the reverse.
void check_sphere(Reader& in, const Case& spec);

}  // namespace gaussdrift::input
