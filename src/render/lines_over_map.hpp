// Lines over a density seen from above: tracks of particles.
#pragma once

#include <vector>

#include "render/canvas.hpp"
#include "render/picture.hpp"

namespace gaussdrift::render {

/// Places one after the other, in the coordinates x and y of the density.
using PlaneLine = std::vector<Point>;

/// Colours from above, of a density in space the values largest in size along z, and the lines over them, each with a mark
/// at its end. What lies beyond the picture is cut off. A line that jumps over more than half of the density along an axis
/// goes on at the other end: it has crossed a periodic edge.
void draw_lines_over(Canvas& canvas, const DensityGrid& density, const std::vector<PlaneLine>& lines,
                     const ColourRange& range, const PictureOptions& options);

}  // namespace gaussdrift::render
