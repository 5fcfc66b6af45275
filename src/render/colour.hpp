// Colours of values: viridis, which is perceptually uniform, monotone in lightness, and safe for the colour-blind.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"

namespace gaussdrift::render {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour white{255, 255, 255}, ink{34, 34, 34}, grey{150, 150, 150}, pale_grey{222, 222, 222},
    not_a_number{204, 80, 62};

/// s in [0, 1] from dark violet to yellow; beyond the ends their colours, NaN red.
Colour viridis(double s);

/// From black through violet and orange to pale yellow.
Colour magma(double s);

/// From dark blue through grey to yellow: the same to people who see no red or no green.
Colour cividis(double s);

/// From white to black, for print; NaN red.
Colour grey_shades(double s);

/// s in [0, 1] from blue (0) through white (1/2) to red (1): for differences, whose middle is 0; NaN dark grey.
Colour blue_white_red(double s);

/// The colours of many positions.
std::vector<Colour> colours_of(const std::vector<float>& positions, Colour (*map)(double));

/// Position of a value in the range of the colours, between 0 and 1 if it lies in it. By the logarithm values that are not
/// positive lie far below.
struct ColourRange {
  double min = 0, max = 1;
  Colour (*map)(double) = viridis;  // of positions
  bool log = false;                 // then 0 < min
  double position(double value) const {
    if (!log) return (value - min) / (max - min);
    return std::isnan(value) ? value : std::log(std::max(value, least_positive) / min) / std::log(max / min);
  }
  double value(double position) const {
    return log ? min * std::pow(max / min, position) : min + position * (max - min);
  }
  Colour colour(double value) const { return map(position(value)); }

 private:
  static constexpr double least_positive = 1e-300;
};

struct ColourMap {
  struct About {
    std::string_view name, meaning;
  } about;
  Colour (*map)(double);
};

/// In the order of docs/cases.md.
const std::vector<ColourMap>& colour_maps();

/// Throws std::out_of_range if no map is called so.
const ColourMap& find_colour_map(std::string_view name);

}  // namespace gaussdrift::render

template <>
std::vector<gaussdrift::render::ColourMap>& gaussdrift::base::catalogue<gaussdrift::render::ColourMap>();
