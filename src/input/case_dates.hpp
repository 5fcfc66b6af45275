// The dates that times of a case are, by its data.
#pragma once

#include <optional>
#include <string>

#include "gaussdrift/case.hpp"

namespace gaussdrift::input {

/// The time of the clock that a date means; nothing where it is no date, or no data of the case have dates.
std::optional<double> time_of_date(const Case& spec, const std::string& date);

}  // namespace gaussdrift::input
