// A case to fill in. What stands there runs as it is; what is switched off by # shows what else there is. Comments are the
// meanings of the registry.
#pragma once

#include <string>

namespace gaussdrift::input {

/// In the plane (2) or in space (3).
std::string blank_case(int dimensions);

}  // namespace gaussdrift::input
