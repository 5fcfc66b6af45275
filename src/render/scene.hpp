// A box in perspective, as surface and isosurface share it: camera, light, lines, and axes along its edges.
#pragma once

#include "render/axes.hpp"
#include "render/canvas.hpp"

namespace gaussdrift::render {

/// Places are in the box [0, width] x [0, depth] x [0, height]. Camera over the corner (x_max, y_min), so that a counter-clockwise turn is seen as one.
class View {
 public:
  /// The box fills `room` of the picture as well as it can.
  View(Canvas& canvas, const Place& box, const Rectangle& room);
  Point pixel(const Place& place) const;
  /// Distance from the camera's plane, growing away from it.
  double depth(const Place& place) const;

 private:
  Rectangle extent(const Place& box) const;

  Canvas& canvas_;
};

/// Lines at the ticks of the axes on the walls behind what is in the box (and on its floor), and its outline.
void add_walls(Sheet& scene, const Place& box, const Axis& x, const Axis& y, const Axis& z, bool floor);

/// Ticks, numbers and title along the edge from `from` to `to`, outwards in the direction of `out` (as seen).
void draw_edge(Canvas& canvas, const View& view, const Axis& axis, const Place& from, const Place& to,
               const Place& out);
/// All three of the box: x and y below in front, z at the left.
void draw_edges(Canvas& canvas, const View& view, const Place& box, const Axis& x, const Axis& y, const Axis& z);

}  // namespace gaussdrift::render
