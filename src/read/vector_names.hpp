// The names that the components of a velocity usually have.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gaussdrift::read {

/// The first usual set of `count` names that are all among these; empty if there is none.
std::vector<std::string> usual_components(const std::vector<std::string>& names, std::size_t count);

/// The first usual set of standard names of the CF conventions: eastward_wind, northward_wind, ...
std::vector<std::string> usual_standard_names(const std::vector<std::string>& names, std::size_t count);

/// ["u", "v"]
std::string in_brackets(const std::vector<std::string>& names);

}  // namespace gaussdrift::read
