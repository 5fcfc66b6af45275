// The difference from the exact density, in colours from blue through white, which is 0, to red.
#include "render/plane.hpp"
#include "render/three_planes.hpp"

namespace gaussdrift::render {
namespace {

Painting error(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  return density.lattice.dimension == 2 ? heatmap(density, range, options) : slices(density, range, options);
}

}  // namespace

Style error_style() {
  return {.about = {.name = "error",
                    .meaning = "the difference from the exact density in colours from blue through white, which is 0, "
                               "to red",
                    .shows_error = true},
          .quantity = "error",
          .colours = blue_white_red,
          .range = symmetric_range,
          .cost = {.a_point = 0.8e-8, .a_point_in_space = 1.4e-8},
          .in_panels = true,
          .takes_velocity = true,
          .painting = error};
}

}  // namespace gaussdrift::render
