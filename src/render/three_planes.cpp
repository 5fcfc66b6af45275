#include "render/three_planes.hpp"

#include <algorithm>
#include <cmath>

#include "render/solid.hpp"

namespace gaussdrift::render {

double length_along(const Lattice& lattice, int axis) {
  return lattice.spacing * static_cast<double>(std::max<std::size_t>(lattice.points[axis], 2) - 1);
}

std::array<PlaneView, 3> arrange(const Canvas& canvas, const Lattice& lattice) {
  const Scale scale(canvas);
  const double left = scale(110), between_x = scale(112), right = scale(190);
  const double bottom = scale(92), between_y = scale(112), top = scale(132);
  const double room_x = canvas.width() - left - between_x - right, room_y = canvas.height() - bottom - between_y - top;
  const double longest = std::max({length_along(lattice, 0), length_along(lattice, 1), length_along(lattice, 2)});
  const auto part = [&](int axis) { return length_along(lattice, axis) / longest; };
  const double pixels = std::min(room_x / (part(0) + part(2)), room_y / (part(1) + part(2)));
  // Extremely slender boxes are widened.
  const auto side = [&](int axis) { return std::round(std::max(pixels * part(axis), scale(24))); };
  const double x = std::round(left + std::max(0., room_x - side(0) - side(2)) / 2);
  const double y = std::round(bottom + std::max(0., room_y - side(1) - side(2)) / 2);
  const double beside = x + side(0) + std::round(between_x), above = y + side(1) + std::round(between_y);
  return {
      {{0, 1, {x, y, side(0), side(1)}}, {0, 2, {x, above, side(0), side(2)}}, {2, 1, {beside, y, side(2), side(1)}}}};
}

namespace {

/// Leaves every second tick where the numbers would run into each other.
Axis spaced(Axis axis, double pixels, const Scale& scale) {
  std::vector<Tick>& ticks = axis.ticks.list;
  double widest = 0;
  for (const Tick& tick : ticks) widest = std::max(widest, Canvas::text_width(tick.label, scale.font(18)));
  const double apart = pixels * axis.ticks.step / (axis.max - axis.min);
  if (ticks.size() > 2 && apart < widest + scale(8))
    std::erase_if(
        ticks, [&](const Tick& tick) { return std::lround((tick.at - axis.ticks.offset) / axis.ticks.step) % 2 != 0; });
  return axis;
}

}  // namespace

void draw_view(Canvas& canvas, const PlaneView& view, const Plane& plane, const ColourRange& range,
               const std::string& caption) {
  const Scale scale(canvas);
  const Rectangle& room = view.room;
  const int columns = static_cast<int>(room.width), rows = static_cast<int>(room.height);
  const HeightField field = make_height_field(plane, range);
  const HeightField pixels = resample(field, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows));
  canvas.image(static_cast<int>(room.x), static_cast<int>(room.y), columns, rows, colours_of(pixels.value, range.map));

  const auto intervals = [&](double length) { return std::clamp(static_cast<int>(length / scale(75)), 1, 6); };
  draw_axes(canvas, room,
            spaced(short_axis(axis_names[static_cast<std::size_t>(view.across)], field.x_min,
                              field.x_min + field.width * field.length, intervals(room.width)),
                   room.width, scale),
            short_axis(axis_names[static_cast<std::size_t>(view.up)], field.y_min,
                       field.y_min + field.depth * field.length, intervals(room.height)));
  canvas.text({room.x, room.top() + scale(9)}, caption,
              {.size = scale.font(18), .across = Across::left, .along = Along::bottom});
}

void draw_around(Canvas& canvas, const std::array<PlaneView, 3>& views, const DensityGrid& density,
                 const ColourRange& range, const PictureOptions& options, const std::vector<std::string>& notes) {
  const Scale scale(canvas);
  const Rectangle &first = views[0].room, &above = views[1].room, &beside = views[2].room;
  const double height = std::max(above.top() - first.y - scale(60), scale(300));
  const double middle = (first.y + above.top()) / 2 - scale(20);
  draw_colour_bar(canvas, {beside.right() + scale(46), middle - height / 2, scale(26), height}, true,
                  value_axis(options.quantity, range, 6), {}, range.map);
  double widest = 0;
  for (const std::string& note : notes) widest = std::max(widest, Canvas::text_width(note, scale.font(18)));
  const double line = scale(28), tall = line * static_cast<double>(notes.size());
  if (widest <= beside.width + scale(20) && tall <= above.height) {
    double y = above.top();
    for (const std::string& note : notes) {
      canvas.text({beside.x, y}, note,
                  {.size = scale.font(18), .across = Across::left, .along = Along::top, .colour = {105, 105, 105}});
      y -= line;
    }
  }
  draw_heading(canvas, options, facts_of(density.rho));
}

}  // namespace gaussdrift::render
