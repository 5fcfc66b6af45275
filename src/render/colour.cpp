#include "render/colour.hpp"

#include <algorithm>
#include <cmath>

namespace gaussdrift::render {

namespace {

/// Equidistant colours of a map, linear in between.
template <std::size_t count>
Colour between(const std::array<Colour, count>& points, double s) {
  const double place = std::clamp(s, 0., 1.) * (count - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), count - 2);
  const double t = place - static_cast<double>(i);
  Colour mixed;
  for (std::size_t k = 0; k < 3; ++k)
    mixed[k] = static_cast<std::uint8_t>(std::lround((1 - t) * points[i][k] + t * points[i + 1][k]));
  return mixed;
}

}  // namespace

Colour viridis(double s) {
  if (std::isnan(s)) return not_a_number;
  // Ten colours of the map; linear in between is off by less than two steps of 255.
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
  return between(points, s);
}

Colour blue_white_red(double s) {
  if (std::isnan(s)) return {70, 70, 70};
  // The diverging map RdBu of ColorBrewer, turned round.
  constexpr std::array<Colour, 11> points{{{5, 48, 97},
                                           {33, 102, 172},
                                           {67, 147, 195},
                                           {146, 197, 222},
                                           {209, 229, 240},
                                           {247, 247, 247},
                                           {253, 219, 199},
                                           {244, 165, 130},
                                           {214, 96, 77},
                                           {178, 24, 43},
                                           {103, 0, 31}}};
  return between(points, s);
}

}  // namespace gaussdrift::render
