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
    mixed[k] = static_cast<std::uint8_t>((1 - t) * points[i][k] + t * points[i + 1][k] + 0.5);  // positive: it rounds
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

Colour magma(double s) {
  if (std::isnan(s)) return {60, 170, 90};
  constexpr std::array<Colour, 10> points{{{0, 0, 4},
                                           {24, 15, 61},
                                           {68, 15, 118},
                                           {114, 31, 129},
                                           {158, 47, 127},
                                           {205, 64, 113},
                                           {241, 96, 93},
                                           {253, 150, 104},
                                           {254, 202, 141},
                                           {252, 253, 191}}};
  return between(points, s);
}

Colour cividis(double s) {
  if (std::isnan(s)) return not_a_number;
  constexpr std::array<Colour, 9> points{{{0, 32, 76},
                                          {0, 48, 110},
                                          {58, 73, 107},
                                          {87, 93, 109},
                                          {112, 113, 115},
                                          {140, 134, 120},
                                          {171, 156, 114},
                                          {206, 181, 98},
                                          {255, 233, 69}}};
  return between(points, s);
}

Colour grey_shades(double s) {
  if (std::isnan(s)) return not_a_number;
  constexpr std::array<Colour, 2> points{{{250, 250, 250}, {20, 20, 20}}};
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

std::vector<Colour> colours_of(const std::vector<float>& positions, Colour (*map)(double)) {
  std::vector<Colour> colours(positions.size());
  std::transform(positions.begin(), positions.end(), colours.begin(), map);
  return colours;
}

const std::vector<ColourMap>& colour_maps() { return base::catalogue<ColourMap>(); }

const ColourMap& find_colour_map(std::string_view name) { return base::find_named(colour_maps(), "colour map", name); }

}  // namespace gaussdrift::render

template <>
std::vector<gaussdrift::render::ColourMap>& gaussdrift::base::catalogue<gaussdrift::render::ColourMap>() {
  using namespace gaussdrift::render;
  static std::vector<ColourMap> all{
      {{"viridis", "from violet to yellow"}, viridis},
      {{"magma", "from black through red to pale yellow"}, magma},
      {{"cividis", "from blue to yellow, the same to the colour-blind"}, cividis},
      {{"grey", "from white to black, for print"}, grey_shades},
      {{"blue-white-red", "from blue through white to red, for values of both signs"}, blue_white_red}};
  return all;
}
