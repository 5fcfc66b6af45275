// Lines of equal density.
#pragma once

#include <vector>

#include "render/canvas.hpp"
#include "render/height_field.hpp"

namespace gaussdrift::render {

/// About ten round values inside the range, the same for every picture with that range. Never 0: where a density
/// vanishes its line would be noise.
std::vector<double> contour_levels(const ColourRange& range);

/// A connected piece of the line on which the field has `level`, in the scene's coordinates [0, width] x [0, depth].
struct ContourLine {
  double level;
  std::vector<Point> points;
};

/// levels: positions in the colour range. Lines end where the field is NaN.
std::vector<ContourLine> contour_lines(const HeightField& field, const std::vector<double>& levels);

}  // namespace gaussdrift::render
