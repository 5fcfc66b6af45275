// What the descriptions of densities have in common.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// "(0.5, 0)".
inline std::string point_text(const Vector& point, int dimension) {
  std::string text = fmt::format("({:g}, {:g}", point[0], point[1]);
  return text + (dimension == 3 ? fmt::format(", {:g})", point[2]) : ")");
}

/// With the mass, where it is known.
inline std::string with_mass(const std::string& text, const std::optional<double>& mass) {
  return mass ? fmt::format("{}, mass {:.9g}", text, *mass) : text;
}

}  // namespace gaussdrift
