#include "read/vector_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace gaussdrift::read {

namespace {

using Sets = std::vector<std::vector<std::string>>;

std::vector<std::string> first_of(const Sets& sets, const std::vector<std::string>& names, std::size_t count) {
  for (const auto& set : sets) {
    if (set.size() < count) continue;
    const std::vector<std::string> some(set.begin(), set.begin() + static_cast<std::ptrdiff_t>(count));
    if (std::all_of(some.begin(), some.end(), [&](const std::string& name) {
          return std::find(names.begin(), names.end(), name) != names.end();
        }))
      return some;
  }
  return {};
}

}  // namespace

std::vector<std::string> usual_components(const std::vector<std::string>& names, std::size_t count) {
  static const Sets usual{{"u", "v", "w"},    {"U", "V", "W"},    {"vx", "vy", "vz"}, {"ux", "uy", "uz"},
                          {"Vx", "Vy", "Vz"}, {"uo", "vo", "wo"}, {"u10", "v10"}};
  return first_of(usual, names, count);
}

std::vector<std::string> usual_standard_names(const std::vector<std::string>& names, std::size_t count) {
  static const Sets usual{
      {"eastward_sea_water_velocity", "northward_sea_water_velocity", "upward_sea_water_velocity"},
      {"sea_water_x_velocity", "sea_water_y_velocity", "upward_sea_water_velocity"},
      {"surface_eastward_sea_water_velocity", "surface_northward_sea_water_velocity"},
      {"surface_geostrophic_eastward_sea_water_velocity", "surface_geostrophic_northward_sea_water_velocity"},
      {"eastward_wind", "northward_wind", "upward_air_velocity"},
      {"x_wind", "y_wind", "upward_air_velocity"}};
  return first_of(usual, names, count);
}

std::string in_brackets(const std::vector<std::string>& names) {
  return fmt::format("[\"{}\"]", fmt::join(names, "\", \""));
}

}  // namespace gaussdrift::read
