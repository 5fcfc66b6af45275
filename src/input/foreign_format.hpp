// Files that are given as tables and are none: what they are, and how a table is made of them.
#pragma once

#include <string>
#include <string_view>

namespace gaussdrift::input {

/// What the data are if they are no text: "a NetCDF file; with Python ...". Empty for text.
std::string foreign_format(std::string_view data);

}  // namespace gaussdrift::input
