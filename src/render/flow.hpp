// The velocity over a picture of a density on a plane: as arrows, or as lines along it.
#pragma once

#include <string_view>
#include <vector>

#include "gaussdrift/density_grid.hpp"
#include "render/canvas.hpp"

namespace gaussdrift::render {

/// Velocities on a plane lattice, in coordinates of its points: the first is at (0, 0), the next along x at (1, 0).
class FlowPlane {
 public:
  /// Takes the field of that name, a vector, of the density. Throws Error(ExitCode::internal) where it is not there.
  FlowPlane(const DensityGrid& density, std::string_view name);

  double width() const { return static_cast<double>(nx_ - 1); }
  double height() const { return static_cast<double>(ny_ - 1); }
  /// Interpolated bilinearly; NaN outside, and where it is not known.
  Point at(const Point& place) const;
  double largest_speed() const { return largest_; }

 private:
  std::size_t nx_, ny_;
  std::vector<double> values_;  // u and v of each point, x fastest
  double largest_ = 0;
};

/// Arrows at the middles of a mesh of cells, so many along the longer side. The longest, of the largest speed, is nine
/// tenths of a cell long. A plane of one row of points has none. Each is a polyline with its head, in the coordinates of the plane.
std::vector<std::vector<Point>> arrows(const FlowPlane& flow, int along);

/// Lines along the flow, about `apart` from each other everywhere and none shorter than three times that. Each second
/// entry is the head of an arrow in the middle of the line before it.
std::vector<std::vector<Point>> streamlines(const FlowPlane& flow, double apart);

}  // namespace gaussdrift::render
