// A density in space on three planes at once, arranged like a technical drawing: x-y below, x-z above it, z-y beside
// it, all to one scale. Cut through the largest value (slices), or seen through (projection).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/axes.hpp"
#include "render/solid.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {
namespace {

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

struct Panel {
  int across, up;
  Rectangle room;

  int normal() const { return 3 - across - up; }
};

double length_along(const Lattice& lattice, int axis) {
  return lattice.spacing * static_cast<double>(std::max<std::size_t>(lattice.points[axis], 2) - 1);
}

/// The three panels in the middle of the picture, as large as they can be.
std::array<Panel, 3> arrange(const Canvas& canvas, const Lattice& lattice) {
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

void draw_panel(Canvas& canvas, const Panel& panel, const Plane& plane, const ColourRange& range,
                const std::string& caption) {
  const Scale scale(canvas);
  const Rectangle& room = panel.room;
  const int columns = static_cast<int>(room.width), rows = static_cast<int>(room.height);
  const HeightField field = make_height_field(plane, range);
  const HeightField pixels = resample(field, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows));
  std::vector<Colour> colours(pixels.value.size());
  std::transform(pixels.value.begin(), pixels.value.end(), colours.begin(), range.map);
  canvas.image(static_cast<int>(room.x), static_cast<int>(room.y), columns, rows, colours);

  const auto intervals = [&](double length) { return std::clamp(static_cast<int>(length / scale(75)), 1, 6); };
  draw_axes(canvas, room,
            spaced(short_axis(axis_names[static_cast<std::size_t>(panel.across)], field.x_min,
                              field.x_min + field.width * field.length, intervals(room.width)),
                   room.width, scale),
            short_axis(axis_names[static_cast<std::size_t>(panel.up)], field.y_min,
                       field.y_min + field.depth * field.length, intervals(room.height)));
  canvas.text({room.x, room.top() + scale(9)}, caption,
              {.size = scale.font(18), .across = Across::left, .along = Along::bottom});
}

/// Colour bar at the right, and what the picture shows in the free corner above it.
void draw_around(Canvas& canvas, const std::array<Panel, 3>& panels, const DensityGrid& density,
                 const ColourRange& range, const PictureOptions& options, const std::vector<std::string>& notes) {
  const Scale scale(canvas);
  const Rectangle &first = panels[0].room, &above = panels[1].room, &beside = panels[2].room;
  const double height = std::max(above.top() - first.y - scale(60), scale(300));
  const double middle = (first.y + above.top()) / 2 - scale(20);
  draw_colour_bar(canvas, {beside.right() + scale(46), middle - height / 2, scale(26), height}, true,
                  {options.quantity, range.min, range.max, 6}, {}, range.map);
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

}  // namespace

void draw_slices(Canvas& canvas, const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  check_solid(density);
  const Scale scale(canvas);
  const Lattice& lattice = density.lattice;
  const auto panels = arrange(canvas, lattice);
  const auto at = largest_point(density);
  const auto place = [&](int axis) { return lattice.coordinate(axis, at[static_cast<std::size_t>(axis)]); };
  const auto text = [&](int axis) {
    const double value = place(axis);  // what rounding leaves of 0 is 0
    const bool is_zero = std::abs(value) < 1e-9 * length_along(lattice, axis);
    return fmt::format("{} = {}", axis_names[static_cast<std::size_t>(axis)], number(is_zero ? 0 : value, 4));
  };
  for (const Panel& panel : panels) {
    const auto normal = static_cast<std::size_t>(panel.normal());
    draw_panel(canvas, panel, slice(density, panel.across, panel.up, at[normal]), range, text(panel.normal()));
    // Where the other two planes cut this one: short lines inside its frame.
    const auto share = [&](int axis) {
      const std::size_t points = lattice.points[axis];
      return points > 1 ? static_cast<double>(at[static_cast<std::size_t>(axis)]) / static_cast<double>(points - 1)
                        : 0.5;
    };
    const Rectangle& room = panel.room;
    const double x = room.x + share(panel.across) * room.width, y = room.y + share(panel.up) * room.height;
    const double mark = std::min({scale(16), room.width / 4, room.height / 4});
    canvas.lines({{{{x, room.y}, {x, room.y + mark}}, grey},
                  {{{x, room.top() - mark}, {x, room.top()}}, grey},
                  {{{room.x, y}, {room.x + mark, y}}, grey},
                  {{{room.right() - mark, y}, {room.right(), y}}, grey}},
                 scale(2));
  }
  draw_around(canvas, panels, density, range, options,
              {"three slices through the", fmt::format("largest {}, at", options.quantity), text(0), text(1), text(2)});
}

void draw_projection(Canvas& canvas, const DensityGrid& density, const ColourRange& range,
                     const PictureOptions& options) {
  check_solid(density);
  const auto panels = arrange(canvas, density.lattice);
  for (const Panel& panel : panels)
    draw_panel(canvas, panel, projection(density, panel.across, panel.up), range,
               fmt::format("largest along {}", axis_names[static_cast<std::size_t>(panel.normal())]));
  draw_around(canvas, panels, density, range, options,
              {"three projections:", "of every line of sight", "the value of largest size"});
}

}  // namespace gaussdrift::render
