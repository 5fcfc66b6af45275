// Pictures of a density on a plane, drawn off screen by VTK through OSMesa: no display, no GPU.
// The interface knows no VTK; where OSMesa was absent at build time available() says so and draw() throws.
#pragma once

#include <filesystem>
#include <string>

#include "sim/frame.hpp"

namespace gaussdrift::render {

enum class Style { surface, contour, heatmap };

struct PictureOptions {
  std::string title;      // of the case
  std::string quantity = "density";
  double time = 0;
  double range_min = 0;   // of the colours, height axis and contour levels; the same for all pictures of a run
  double range_max = 1;
  int width = 1280;
  int height = 960;
};

/// Empty if pictures can be drawn, else the reason and the remedy.
std::string unavailable_reason();

/// Draws a two-dimensional density into a PNG (written beside its name and renamed).
///   surface  height field with contour lines in perspective, seen from above at an angle
///   contour  contour lines: from above, and from the side (x against height), as Figures 5.3 and 5.5 of [Sch06]
///   heatmap  colours from above
/// Throws FileError; Error(ExitCode::internal) when drawing is not available.
void draw(Style style, const DensityGrid& density, const PictureOptions& options, const std::filesystem::path& png);

/// A range with round ends that contains [minimum, maximum]; keeps 0 as an end where it already is close to one.
std::pair<double, double> rounded_range(double minimum, double maximum);

}  // namespace gaussdrift::render
