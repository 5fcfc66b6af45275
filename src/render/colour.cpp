#include "render/colour.hpp"

#include <algorithm>
#include <cmath>

namespace gaussdrift::render {

Colour viridis(double s) {
  if (std::isnan(s)) return not_a_number;
  // Ten equidistant colours of the map; in between linear, which is off by less than two steps of 255.
  constexpr std::array<Colour, 10> points{{{68, 1, 84},
                                           {72, 40, 120},
                                           {62, 74, 137},
                                           {49, 104, 142},
                                           {38, 130, 142},
                                           {31, 158, 137},
                                           {53, 183, 121},
                                           {109, 205, 89},
                                           {180, 222, 44},
                                           {253, 231, 37}}};
  const double place = std::clamp(s, 0., 1.) * (points.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), points.size() - 2);
  const double t = place - static_cast<double>(i);
  Colour mixed;
  for (std::size_t k = 0; k < 3; ++k)
    mixed[k] = static_cast<std::uint8_t>(std::lround((1 - t) * points[i][k] + t * points[i + 1][k]));
  return mixed;
}

}  // namespace gaussdrift::render
