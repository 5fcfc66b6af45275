// A density in space seen through along three directions.
#include <fmt/format.h>

#include "render/solid.hpp"
#include "render/three_planes.hpp"

namespace gaussdrift::render {
namespace {

void draw(Canvas& canvas, const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  const auto views = arrange(canvas, density.lattice);
  for (const PlaneView& view : views)
    draw_view(canvas, view, projection(density, view.across, view.up), range,
              fmt::format("largest along {}", axis_names[static_cast<std::size_t>(view.normal())]));
  draw_around(canvas, views, density, range, options,
              {"three projections:", "of every line of sight", "the value of largest size"});
}

Painting projections(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  check_solid(density);
  return [&density, range, options](Canvas& canvas) { draw(canvas, density, range, options); };
}

}  // namespace

Style projection_style() {
  return {.about = {.name = "projection",
                    .meaning = "maximum-intensity projections: on three planes, the value largest in size on every "
                               "line of sight",
                    .least_dimension = 3},
          .cost = {.a_point_in_space = 1.6e-8},

          .painting = projections};
}

}  // namespace gaussdrift::render
