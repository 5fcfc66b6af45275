// A density on a plane in colours, from above.
#include <algorithm>
#include <cmath>

#include "render/axes.hpp"
#include "render/plane.hpp"

namespace gaussdrift::render {

Rectangle draw_map(Canvas& canvas, const HeightField& field, const ColourRange& range, const PictureOptions& options) {
  const Scale scale(canvas);
  const Rectangle room{scale(130), scale(100), canvas.width() - scale(130 + 190), canvas.height() - scale(100 + 116)};
  const Rectangle panel = panel_in(room, field);
  const int columns = static_cast<int>(panel.width), rows = static_cast<int>(panel.height);

  const HeightField pixels = resample(field, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows));
  canvas.image(static_cast<int>(panel.x), static_cast<int>(panel.y), columns, rows,
               colours_of(pixels.value, range.map));

  const Rectangle whole{0, 0, field.width, field.depth};
  draw_axes(canvas, panel, x_axis(field, whole, panel.width, scale, options),
            y_axis(field, whole, panel.height, scale, options));
  const double bar_height = std::clamp(panel.height, room.height / 2, room.height) - scale(50);
  const Rectangle bar{panel.right() + scale(44), panel.y + (panel.height - bar_height - scale(50)) / 2, scale(26),
                      bar_height};
  draw_colour_bar(canvas, bar, true, value_axis(options.quantity, range, 6), {}, range.map);
  draw_heading(canvas, options, field);
  return panel;
}

Painting heatmap(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  return [field = make_height_field(density, range, most_plane_points),
          velocity = velocity_over(density, options.looks.velocity), range,
          options](Canvas& canvas) { velocity(canvas, draw_map(canvas, field, range, options)); };
}

Style heatmap_style() {
  return {.about = {.name = "heatmap", .meaning = "colours from above", .most_dimension = 2},
          .cost = {.a_point = 0.7e-8},
          .in_panels = true,
          .white_at_zero = true,
          .takes_velocity = true,
          .painting = heatmap};
}

}  // namespace gaussdrift::render
