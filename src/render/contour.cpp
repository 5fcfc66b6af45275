// Contour lines of a density on a plane: from above, and from the side (x against height), as Figures 5.3 and 5.5 of
// [Sch06].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/axes.hpp"
#include "render/contour_lines.hpp"
#include "render/plane.hpp"

namespace gaussdrift::render {
namespace {

/// The part of the field that is shown: all of it, or a half, a quarter or an eighth in each direction around the
/// contour lines, if they fit into it with some room. Only their size decides, not their place, so a moving object keeps
/// its scale.
Rectangle window_around(const std::vector<ContourLine>& lines, const HeightField& field) {
  const Rectangle whole{0, 0, field.width, field.depth};
  Point low{field.width, field.depth}, high{0, 0};
  for (const ContourLine& line : lines)
    for (const Point& p : line.points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  if (lines.empty()) return whole;
  for (const double part : {0.125, 0.25, 0.5}) {
    const double width = part * field.width, height = part * field.depth;
    if (high.x - low.x > 0.8 * width || high.y - low.y > 0.8 * height) continue;
    return {std::clamp((low.x + high.x - width) / 2, 0., field.width - width),
            std::clamp((low.y + high.y - height) / 2, 0., field.depth - height), width, height};
  }
  return whole;
}

/// Largest and smallest value over y, as lines over x: the outline of the surface seen from the side.
std::vector<Polyline> outline(const HeightField& field, const Rectangle& window, const Rectangle& panel,
                              const Axis& height, const ColourRange& range) {
  std::vector<Polyline> lines(2);
  const auto add = [&](double x, double low, double high) {
    for (const auto& [line, position] : {std::pair{&lines[0], low}, {&lines[1], high}}) {
      const double at = range.value(position);
      line->points.push_back({panel.x + panel.width * (x - window.x) / window.width,
                              panel.y + panel.height * std::clamp(height.position(at), 0., 1.)});
    }
  };
  double x_before = 0, low_before = 0, high_before = 0;
  bool first = true;
  for (std::size_t i = 0; i < field.nx; ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t j = 0; j < field.ny; ++j) {
      const double value = field.at(i, j);  // comparisons with NaN are false
      if (value < low) low = value;
      if (value > high) high = value;
    }
    if (low > high) continue;
    const double x = field.x(i);
    for (const double edge : {window.x, window.x + window.width}) {  // cut at the edges of the window
      if (first || x_before >= edge || x <= edge) continue;
      const double t = (edge - x_before) / (x - x_before);
      add(edge, low_before + t * (low - low_before), high_before + t * (high - high_before));
    }
    if (x >= window.x && x <= window.x + window.width) add(x, low, high);
    x_before = x, low_before = low, high_before = high, first = false;
  }
  for (auto& line : lines) line.colour = grey;
  return lines;
}

/// A small map of the whole field with the window marked; `corner` is its lower right one.
void draw_locator(Canvas& canvas, const Point& corner, double side, const HeightField& field, Rectangle window,
                  bool from_below) {
  if (from_below) window.y = field.depth - window.y - window.height;
  const double width = std::max(side * field.width, 4.), height = std::max(side * field.depth, 4.);
  const Rectangle map{corner.x - width, corner.y, width, height};
  canvas.area({map.x + width * window.x / field.width, map.y + height * window.y / field.depth,
               width * window.width / field.width, height * window.height / field.depth},
              grey);
  canvas.frame(map, grey, 1);
}

/// Each contour line from above, and from the side as the stroke that it spans at its height.
struct Curves {
  std::vector<Polyline> from_above, from_side;
};

Curves curves(const std::vector<ContourLine>& contours, const Rectangle& window, const Rectangle& above,
              const Rectangle& side, const Axis& upwards, const ColourRange& range, bool from_below) {
  Curves drawn;
  const auto seen = [&](double y) { return from_below ? 1 - y : y; };
  for (const auto& [level, points] : contours) {
    const Colour colour = range.map(level);
    Polyline line{{}, colour};
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point& p : points) {
      line.points.push_back({above.x + above.width * (p.x - window.x) / window.width,
                             above.y + above.height * seen((p.y - window.y) / window.height)});
      low = std::min(low, p.x);
      high = std::max(high, p.x);
    }
    drawn.from_above.push_back(std::move(line));
    const double z = side.y + side.height * upwards.position(range.value(level));
    const auto x = [&](double at) { return side.x + side.width * (at - window.x) / window.width; };
    drawn.from_side.push_back({{{x(low), z}, {x(high), z}}, colour});
  }
  return drawn;
}

void draw(Canvas& canvas, const HeightField& field, const ColourRange& range, const PictureOptions& options) {
  const Scale scale(canvas);
  const double left = scale(112), between = scale(130), right = scale(40), bottom = scale(206), top = scale(120);
  const double width = (canvas.width() - left - between - right) / 2, height = canvas.height() - bottom - top;
  const Rectangle above = panel_in({left, bottom, width, height}, field);
  const double side_height = std::round(std::clamp(above.height, 0.5 * height, height));
  const Rectangle side{std::round(left + width + between), std::round(above.y + (above.height - side_height) / 2),
                       std::round(width), side_height};

  const auto levels = contour_levels(range);
  std::vector<double> positions;
  for (const double level : levels) positions.push_back(range.position(level));
  const auto contours = contour_lines(field, positions);
  const Rectangle window = options.whole ? Rectangle{0, 0, field.width, field.depth} : window_around(contours, field);

  ColourRange with_margins = range;
  with_margins.min = range.value(-0.05), with_margins.max = range.value(1.05);
  const Axis upwards = value_axis(options.quantity, with_margins, 6);
  // From below x still runs to the right, so y runs downwards.
  Axis across = x_axis(field, window, above.width, scale, options),
       aside = y_axis(field, window, above.height, scale, options);
  if (options.from_below) std::swap(aside.min, aside.max);
  const auto [from_above, from_side] = curves(contours, window, above, side, upwards, range, options.from_below);
  canvas.lines(from_above, scale(2.4));
  canvas.lines(outline(field, window, side, upwards, range), scale(1.5));
  canvas.lines(from_side, scale(3));

  draw_axes(canvas, above, across, aside);
  draw_axes(canvas, side, x_axis(field, window, side.width, scale, options), upwards);
  const TextStyle caption{.size = scale.font(18), .across = Across::left, .along = Along::bottom};
  canvas.text({side.x, side.top() + scale(10)}, "from the side", caption);
  const int enlarged = static_cast<int>(std::lround(field.width / window.width));
  const std::string whence = options.from_below ? "from below" : "from above";
  canvas.text({above.x, above.top() + scale(10)},
              enlarged == 1 ? whence : fmt::format("{}, enlarged {} times", whence, enlarged), caption);
  if (enlarged > 1)  // its right edge on that of the panel, but beside the caption
    draw_locator(canvas, {std::max(above.right(), above.x + scale(340)), above.top() + scale(8)}, scale(60), field,
                 window, options.from_below);
  if (contours.empty())
    canvas.text({above.x + above.width / 2, above.y + above.height / 2}, "no contour lines",
                {.size = scale.font(18), .colour = grey});
  draw_colour_bar(canvas, {canvas.width() / 2 - scale(310), scale(58), scale(620), scale(22)}, false,
                  value_axis(options.quantity, range, 10), levels, range.map);
  draw_heading(canvas, options, field);
}

Painting contour(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  return [field = make_height_field(density, range, most_plane_points), range, options](Canvas& canvas) {
    draw(canvas, field, range, options);
  };
}

}  // namespace

Style contour_style() {
  return {.about = {.name = "contour",
                    .meaning = "contour lines from above, and the same lines from the side",
                    .most_dimension = 2},
          .cost = {.a_point = 2.5e-8},

          .painting = contour};
}

}  // namespace gaussdrift::render
