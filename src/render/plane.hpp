// A density on a plane as the pictures lay it out that look straight at it.
#pragma once

#include "render/axes.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {

/// More points an axis than these a picture of 1280 pixels does not show.
constexpr std::size_t most_plane_points = 1000;

/// The axes of the part `window` of the scene, on so many pixels.
Axis x_axis(const HeightField& field, const Rectangle& window, double pixels, const Scale& scale,
            const PictureOptions& options);
Axis y_axis(const HeightField& field, const Rectangle& window, double pixels, const Scale& scale,
            const PictureOptions& options);

/// The largest rectangle of the field's shape in the middle of `room`, on whole pixels. Extremely slender fields are
/// widened.
Rectangle panel_in(const Rectangle& room, const HeightField& field);

/// Colours from above.
Painting heatmap(const DensityGrid& density, const ColourRange& range, const PictureOptions& options);

}  // namespace gaussdrift::render
