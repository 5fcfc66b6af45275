// The clock of a scene whose data have one.
#pragma once

#include <string>

#include "gaussdrift/case.hpp"

namespace gaussdrift {

/// "hours since 2020-01-03 00:00", as CF has it, where a velocity file says so; else empty.
std::string time_units_of(const Case& spec);

}  // namespace gaussdrift
