// Colours of values: viridis, which is perceptually uniform, monotone in lightness, and safe for the colour-blind.
#pragma once

#include <array>
#include <cstdint>

namespace gaussdrift::render {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour white{255, 255, 255}, ink{34, 34, 34}, grey{150, 150, 150}, pale_grey{222, 222, 222},
    not_a_number{204, 80, 62};

/// s in [0, 1] from dark violet to yellow; beyond the ends their colours, NaN red.
Colour viridis(double s);

/// s in [0, 1] from blue (0) through white (1/2) to red (1): for differences, whose middle is 0; NaN dark grey.
Colour blue_white_red(double s);

/// Position of a value in the range of the colours, between 0 and 1 if it lies in it.
struct ColourRange {
  double min = 0, max = 1;
  Colour (*map)(double) = viridis;  // of positions
  double position(double value) const { return (value - min) / (max - min); }
  Colour colour(double value) const { return map(position(value)); }
};

}  // namespace gaussdrift::render
