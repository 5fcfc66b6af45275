// Pictures of a density on a plane or in space, drawn off screen by VTK through OSMesa: no display, no GPU.
// The interface knows no VTK; where OSMesa was absent at build time unavailable_reason() says so and draw() throws.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "gaussdrift/frame.hpp"

namespace gaussdrift::render {

struct Style;  // render/styles.hpp

struct PictureOptions {
  std::string title{};  // of the case
  std::string quantity = "density";
  std::array<std::string, 2> axes{"x", "y"};  // names of those of a plane
  std::optional<double> time = 0;             // empty: the picture has none
  std::string date{};                         // of that time; empty: it has none
  bool from_below = false;                    // contour: the plane's lines as seen from below instead of from above
  double range_min = 0;  // of the colours, height axis and contour levels; the same for all pictures of a run
  double range_max = 1;
  int width = 1280;
  int height = 960;
};

/// Empty if pictures can be drawn, else the reason and the remedy.
std::string unavailable_reason();

/// "VTK 9.1.0". Throws Error(ExitCode::internal) where pictures cannot be drawn.
std::string drawing_library();

/// For commands that are asked for pictures: throws CommandLineError with the reason if they cannot be drawn.
void check_available();

/// Draws a density into a PNG (written beside its name and renamed). Values outside the range get the colours of its
/// ends; heights stick out of the box by at most 4 % of the range. Values that are not finite are left out (red, or grey
/// in pictures of errors) and counted in the heading, which also tells the true extremes. Without a range (range_min <
/// range_max, both finite) the rounded one of the density itself is used.
/// At most 300 x 300 points of a surface are drawn, and 160 an axis of surfaces in space. Where contour lines fill a
/// small part of the domain, half, a quarter or an eighth of it around them is shown, and said.
/// One call draws at a time, whatever the thread. Throws FileError; CommandLineError as check_available();
/// Error(ExitCode::internal) when the style cannot show the density.
void draw(const Style& style, const DensityGrid& density, const PictureOptions& options,
          const std::filesystem::path& png);

/// A range with round ends that contains [minimum, maximum], except for up to 1 % at either end: the small overshoots
/// of a smoothed step do not spoil [0, 1]. 0 is an end if the values begin within a quarter of their size of it. [0, 1]
/// for nothing but zeros or values that are not finite.
std::pair<double, double> rounded_range(double minimum, double maximum);

/// A range for differences: round, and as far below 0 as above.
std::pair<double, double> symmetric_range(double minimum, double maximum);

}  // namespace gaussdrift::render
