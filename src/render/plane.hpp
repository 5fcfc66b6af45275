// The layout of pictures that look straight at a density on a plane.
#pragma once

#include "render/axes.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {

/// A picture of 1280 pixels does not show more points an axis than these.
constexpr std::size_t most_plane_points = 1000;

/// The axes of the part `window` of the scene, on so many pixels.
Axis x_axis(const HeightField& field, const Rectangle& window, double pixels, const Scale& scale,
            const PictureOptions& options);
Axis y_axis(const HeightField& field, const Rectangle& window, double pixels, const Scale& scale,
            const PictureOptions& options);

/// The largest rectangle of the field's shape in the middle of `room`, on whole pixels. Extremely slender fields are
/// widened.
Rectangle panel_in(const Rectangle& room, const HeightField& field);

/// Draws colours from above, with axes, colour bar and heading; returns where the plane lies on the canvas.
Rectangle draw_map(Canvas& canvas, const HeightField& field, const ColourRange& range, const PictureOptions& options);

/// Colours from above.
Painting heatmap(const DensityGrid& density, const ColourRange& range, const PictureOptions& options);

}  // namespace gaussdrift::render
