// The velocity over the density: arrows, or lines along the flow.
#include <algorithm>
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

Painting with_velocity(const DensityGrid& density, const ColourRange& range, PictureOptions options,
                       std::string_view how) {
  options.looks.velocity = how;
  return heatmap(density, range, options);
}

}  // namespace

VelocityPainter velocity_over(const DensityGrid& density, std::string_view how) {
  if (how.empty()) return [](Canvas&, const Rectangle&) {};
  return [flow = FlowPlane(density, shown), as_arrows = how == "arrows"](Canvas& canvas, const Rectangle& map) {
    draw_lines(canvas, map, flow,
               as_arrows ? arrows(flow, along_longer_side)
                         : streamlines(flow, std::max(flow.width(), flow.height()) / along_longer_side));
  };
}

const std::vector<VelocityStyle>& velocity_styles() {
  static const std::vector<VelocityStyle> all{{{"arrows", "as arrows"}}, {{"streamlines", "as lines along it"}}};
  return all;
}

Style arrows_style() {
  return {.about = {.name = "arrows",
                    .meaning = "the density in colours from above, and the velocity as arrows",
                    .most_dimension = 2,
                    .needs_field = shown},
          .cost = {.seconds = 0.045, .a_point = 0.7e-8},
          .painting = [](const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
            return with_velocity(density, range, options, "arrows");
          }};
}

Style streamlines_style() {
  return {.about = {.name = "streamlines",
                    .meaning = "the density in colours from above, and lines along the velocity at that time",
                    .most_dimension = 2,
                    .needs_field = shown},
          .cost = {.seconds = 0.055, .a_point = 1.5e-8},
          .painting = [](const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
            return with_velocity(density, range, options, "streamlines");
          }};
}

}  // namespace gaussdrift::render
