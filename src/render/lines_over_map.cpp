#include "render/lines_over_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "render/plane.hpp"
#include "render/solid.hpp"

namespace gaussdrift::render {

namespace {

/// The part of a straight way that lies in a box.
std::optional<std::pair<Point, Point>> inside(const Point& a, const Point& b, const Rectangle& box) {
  double from = 0, to = 1;
  for (const auto& [start, step, low, high] :
       {std::array{a.x, b.x - a.x, box.x, box.right()}, std::array{a.y, b.y - a.y, box.y, box.top()}}) {
    if (step == 0) {
      if (start < low || start > high) return std::nullopt;
      continue;
    }
    const double one = (low - start) / step, two = (high - start) / step;
    from = std::max(from, std::min(one, two)), to = std::min(to, std::max(one, two));
  }
  if (!(from <= to)) return std::nullopt;
  const auto at = [&](double s) { return Point{a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)}; };
  return std::pair{at(from), at(to)};
}

}  // namespace

void draw_lines_over(Canvas& canvas, const DensityGrid& density, const std::vector<PlaneLine>& lines,
                     const ColourRange& range, const PictureOptions& options) {
  const HeightField field = density.lattice.dimension == 2 ? make_height_field(density, range, most_plane_points)
                                                           : make_height_field(projection(density, 0, 1), range);
  const Rectangle panel = draw_map(canvas, field, range, options);
  const double to_pixels = panel.width / (field.width * field.length);
  const auto pixel = [&](const Point& place) {
    return Point{panel.x + (place.x - field.x_min) * to_pixels, panel.y + (place.y - field.y_min) * to_pixels};
  };
  const auto jumps = [&](const Point& a, const Point& b) {
    return std::abs(b.x - a.x) > panel.width / 2 || std::abs(b.y - a.y) > panel.height / 2;
  };
  std::vector<Polyline> drawn;
  for (const PlaneLine& line : lines) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Point a = pixel(line[i - 1]), b = pixel(line[i]);
      if (!std::isfinite(a.x + a.y + b.x + b.y) || jumps(a, b)) continue;
      if (const auto part = inside(a, b, panel)) drawn.push_back({{part->first, part->second}, white});
    }
    if (line.empty()) continue;
    constexpr double size = 3;  // pixels
    const Point end = pixel(line.back());
    const Rectangle within{panel.x + size, panel.y + size, panel.width - 2 * size, panel.height - 2 * size};
    if (inside(end, end, within))
      drawn.push_back({{{end.x - size, end.y},
                        {end.x, end.y + size},
                        {end.x + size, end.y},
                        {end.x, end.y - size},
                        {end.x - size, end.y}},
                       white});
  }
  if (!drawn.empty()) canvas.lines(drawn, 1);
}

}  // namespace gaussdrift::render
