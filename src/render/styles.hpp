// One function a style; each draws everything between and including heading and colour bar.
#pragma once

#include <vector>

#include "render/canvas.hpp"
#include "render/height_field.hpp"
#include "render/picture.hpp"

namespace gaussdrift::render {

void draw_surface(Canvas& canvas, const HeightField& field, const ColourRange& range, const PictureOptions& options);
void draw_contour(Canvas& canvas, const HeightField& field, const ColourRange& range, const PictureOptions& options);
void draw_heatmap(Canvas& canvas, const HeightField& field, const ColourRange& range, const PictureOptions& options);

void draw_slices(Canvas& canvas, const DensityGrid& density, const ColourRange& range, const PictureOptions& options);
void draw_projection(Canvas& canvas, const DensityGrid& density, const ColourRange& range,
                     const PictureOptions& options);
void draw_isosurface(Canvas& canvas, const DensityGrid& density, const ColourRange& range,
                     const PictureOptions& options);

/// About ten round values inside the range, the same for every picture with that range. Never 0: where a density
/// vanishes its line would be noise.
std::vector<double> contour_levels(const ColourRange& range);

}  // namespace gaussdrift::render
