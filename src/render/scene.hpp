// A box in perspective, as surface and isosurface share it: camera, light, lines, and axes along its edges.
#pragma once

#include <array>
#include <cstddef>

#include "render/axes.hpp"
#include "render/canvas.hpp"

namespace gaussdrift::render {

/// Places are in the box [0, width] x [0, depth] x [0, height]. By default the eye is over the corner (x_max, y_min), so that a counter-clockwise turn is seen as one.
class View {
 public:
  /// The box fills `room` of the picture as well as it can. `angles`: azimuth and elevation of the eye, in degrees.
  View(Canvas& canvas, const Place& box, const Rectangle& room, const std::array<double, 2>& angles);
  /// Whether the end of x, or of y, is nearer to the eye than its beginning.
  bool sees_end(int axis) const { return sees_end_[static_cast<std::size_t>(axis)]; }
  Point pixel(const Place& place) const;
  /// Distance from the camera's plane, growing away from it.
  double depth(const Place& place) const;

 private:
  Rectangle extent(const Place& box) const;

  Canvas& canvas_;
  std::array<bool, 2> sees_end_;
};

/// Lines at the ticks of the axes on the walls behind what is in the box (and on its floor), and its outline.
void add_walls(Scene& scene, const View& view, const Place& box, const Axis& x, const Axis& y, const Axis& z,
               bool floor);

/// Ticks, numbers and title along the edge from `from` to `to`, outwards in the direction of `out` (as seen).
void draw_edge(Canvas& canvas, const View& view, const Axis& axis, const Place& from, const Place& to,
               const Place& out);
/// Where the bar of colours is.
Rectangle bar_beside_scene(const Canvas& canvas);

/// All three of the box: x and y below in front, z at its left edge as seen.
void draw_edges(Canvas& canvas, const View& view, const Place& box, const Axis& x, const Axis& y, const Axis& z);

}  // namespace gaussdrift::render
