// The layout of pictures that look straight at a density on a plane.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

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

/// The velocity over a map on a canvas: "arrows", "streamlines", or nothing for an empty name. The density must have it among
/// its fields. Throws Error(ExitCode::internal) where it has not.
using VelocityPainter = std::function<void(Canvas&, const Rectangle& map)>;
VelocityPainter velocity_over(const DensityGrid& density, std::string_view how);

/// Colours from above, with the velocity over them where options.looks says so.
Painting heatmap(const DensityGrid& density, const ColourRange& range, const PictureOptions& options);

}  // namespace gaussdrift::render
