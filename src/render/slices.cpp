// A density in space cut by three planes through its largest value.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/solid.hpp"
#include "render/three_planes.hpp"

namespace gaussdrift::render {
namespace {

void draw(Canvas& canvas, const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  const Scale scale(canvas);
  const Lattice& lattice = density.lattice;
  const auto views = arrange(canvas, lattice);
  const auto at = options.planes.value_or(largest_point(density));
  const auto place = [&](int axis) { return lattice.coordinate(axis, at[static_cast<std::size_t>(axis)]); };
  const auto text = [&](int axis) {
    const double value = place(axis);  // what rounding leaves of 0 is 0
    const bool is_zero = std::abs(value) < 1e-9 * length_along(lattice, axis);
    return fmt::format("{} = {}", axis_names[static_cast<std::size_t>(axis)], number(is_zero ? 0 : value, 4));
  };
  for (const PlaneView& view : views) {
    const auto normal = static_cast<std::size_t>(view.normal());
    draw_view(canvas, view, slice(density, view.across, view.up, at[normal]), range, text(view.normal()));
    // Where the other two planes cut this one: short lines inside its frame.
    const auto share = [&](int axis) {
      const std::size_t points = lattice.points[axis];
      return points > 1 ? static_cast<double>(at[static_cast<std::size_t>(axis)]) / static_cast<double>(points - 1)
                        : 0.5;
    };
    const Rectangle& room = view.room;
    const double x = room.x + share(view.across) * room.width, y = room.y + share(view.up) * room.height;
    const double mark = std::min({scale(16), room.width / 4, room.height / 4});
    canvas.lines({{{{x, room.y}, {x, room.y + mark}}, grey},
                  {{{x, room.top() - mark}, {x, room.top()}}, grey},
                  {{{room.x, y}, {room.x + mark, y}}, grey},
                  {{{room.right() - mark, y}, {room.right(), y}}, grey}},
                 scale(2));
  }
  draw_around(canvas, views, density, range, options,
              {"three slices through the",
               fmt::format("largest {}, at", options.planes ? std::string("final value") : options.quantity), text(0),
               text(1), text(2)});
}

}  // namespace

Painting slices(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  check_solid(density);
  return [&density, range, options](Canvas& canvas) { draw(canvas, density, range, options); };
}

Style slices_style() {
  return {.about = {.name = "slices",
                    .meaning = "colours on three planes through the value largest in size",
                    .least_dimension = 3,
                    .by_default = true},
          .cost = {.a_point_in_space = 0.7e-8},

          .in_panels = true,
          .white_at_zero = true,
          .painting = slices};
}

}  // namespace gaussdrift::render
