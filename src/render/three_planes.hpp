// A density in space on three planes at once, arranged like a technical drawing: x-y below, x-z above it, z-y beside
// it, all to one scale.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/axes.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

/// One of the three: the axes of its plane, and its place in the picture.
struct PlaneView {
  int across, up;
  Rectangle room;

  int normal() const { return 3 - across - up; }
};

/// Length of a side; that of a single point is one spacing.
double length_along(const Lattice& lattice, int axis);

/// In the middle of the picture, as large as they can be.
std::array<PlaneView, 3> arrange(const Canvas& canvas, const Lattice& lattice);

void draw_view(Canvas& canvas, const PlaneView& view, const Plane& plane, const ColourRange& range,
               const std::string& caption);

/// Colour bar at the right, and what the picture shows in the free corner above it.
void draw_around(Canvas& canvas, const std::array<PlaneView, 3>& views, const DensityGrid& density,
                 const ColourRange& range, const PictureOptions& options, const std::vector<std::string>& notes);

/// Colours on three planes through the value largest in size.
Painting slices(const DensityGrid& density, const ColourRange& range, const PictureOptions& options);

}  // namespace gaussdrift::render
