// What the name of a column says about it. A table of points is read by position. A column that only numbers the lines
// would be taken for a coordinate, and the sum would be wrong without a warning.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::input {

/// x, y, z, w, also with a number, and the words for places on the globe.
bool names_an_axis(std::string_view name);

/// id, index, time, ...: what tables have beside coordinates.
bool names_no_coordinate(std::string_view name);

/// Looks at the columns that would be coordinates, with their numbers [row][column]. One sentence for each that may be
/// none although its name does not say so: it counts the lines, or stands beside axes with a name of another kind.
std::vector<std::string> doubtful_coordinates(const std::vector<std::string>& names,
                                              const std::vector<double>& numbers);

/// "x, y, weight": printable, each name cut, and no more than some of them.
std::string listed(const std::vector<std::string>& names, std::string_view separator = ", ");

}  // namespace gaussdrift::input
