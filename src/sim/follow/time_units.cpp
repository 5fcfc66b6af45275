#include "sim/follow/time_units.hpp"

#include <fmt/format.h>

#include <string_view>
#include <variant>

#include "field/gridded/grid_data.hpp"

namespace gaussdrift {

// Data tell their clock in words: "t = 0 at 2020-01-03 00:00, in hours".
std::string time_units_of(const Case& spec) {
  constexpr std::string_view at = "t = 0 at ", in = ", in ";
  for (const VelocitySpec& part : spec.velocity) {
    const auto* file = std::get_if<FileVelocitySpec>(&part);
    if (!file || !file->data) continue;
    const std::string& clock = file->data->clock;
    const std::size_t unit = clock.find(in);
    if (!clock.starts_with(at) || unit == std::string::npos) continue;
    if (clock.find_first_of("0123456789") != at.size()) continue;  // it has no date
    return fmt::format("{} since {}", clock.substr(unit + in.size()), clock.substr(at.size(), unit - at.size()));
  }
  return "";
}

}  // namespace gaussdrift
