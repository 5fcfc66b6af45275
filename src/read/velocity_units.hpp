// "m s-1", "cm/s", "km h**-1", "degrees_east day-1": lengths per time.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace gaussdrift::read {

struct VelocityUnits {
  std::string length;  // "m", "km", "cm", "degree"
  double seconds = 1;  // of the unit of time
};

/// Nothing if it is not understood.
std::optional<VelocityUnits> read_velocity_units(std::string_view text);
/// "m", "metres", "km", "degrees_east" as "m", "m", "km", "degree"; empty for others.
std::string length_unit(std::string_view text);

}  // namespace gaussdrift::read
