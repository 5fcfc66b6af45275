// The velocity over the density: arrows, or lines along the flow.
#include <string_view>

#include "render/flow.hpp"
#include "render/plane.hpp"

namespace gaussdrift::render {
namespace {

constexpr std::string_view shown = "velocity";  // a field on the grid
constexpr int along_longer_side = 24;           // arrows, or lines of a uniform flow

/// Dark on light, so that lines are seen on all colours.
void draw_lines(Canvas& canvas, const Rectangle& panel, const FlowPlane& flow,
                const std::vector<std::vector<Point>>& list) {
  std::vector<Polyline> light, dark;
  for (const std::vector<Point>& line : list) {
    Polyline on_canvas;
    for (const Point& p : line)
      on_canvas.points.push_back(
          {panel.x + panel.width * p.x / flow.width(), panel.y + panel.height * p.y / flow.height()});
    on_canvas.colour = white;
    light.push_back(on_canvas);
    on_canvas.colour = ink;
    dark.push_back(std::move(on_canvas));
  }
  const Scale scale(canvas);
  canvas.lines(light, scale(2.8));
  canvas.lines(dark, scale(1.3));
}

template <class Lines>
Painting over_the_map(const DensityGrid& density, const ColourRange& range, const PictureOptions& options,
                      const Lines& lines_of) {
  return [map = make_height_field(density, range, most_plane_points), flow = FlowPlane(density, shown), range, options,
          lines_of](Canvas& canvas) {
    const Rectangle panel = draw_map(canvas, map, range, options);
    draw_lines(canvas, panel, flow, lines_of(flow));
  };
}

Painting painted_arrows(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  return over_the_map(density, range, options, [](const FlowPlane& flow) { return arrows(flow, along_longer_side); });
}

Painting painted_streamlines(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  return over_the_map(density, range, options, [](const FlowPlane& flow) {
    return streamlines(flow, std::max(flow.width(), flow.height()) / along_longer_side);
  });
}

}  // namespace

Style arrows_style() {
  return {.about = {.name = "arrows",
                    .meaning = "the density in colours from above, and the velocity as arrows",
                    .most_dimension = 2,
                    .needs_field = shown},
          .cost = {.seconds = 0.15, .a_point = 0.7e-8},
          .painting = painted_arrows};
}

Style streamlines_style() {
  return {.about = {.name = "streamlines",
                    .meaning = "the density in colours from above, and lines along the velocity at that time",
                    .most_dimension = 2,
                    .needs_field = shown},
          .cost = {.seconds = 0.2, .a_point = 1.5e-8},
          .painting = painted_streamlines};
}

}  // namespace gaussdrift::render
