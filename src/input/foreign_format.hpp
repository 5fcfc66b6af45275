// Recognises files that are given as tables but are not, and says how to make a table of them.
#pragma once

#include <string>
#include <string_view>

namespace gaussdrift::input {

/// What the data are if they are no text: "a NetCDF file; with Python ...". Empty for text.
std::string foreign_format(std::string_view data);

}  // namespace gaussdrift::input
