#include "render/contour_lines.hpp"

#include <cmath>
#include <mutex>

#include "render/drawing_library.hpp"
#include "render/ticks.hpp"

namespace gaussdrift::render {

std::vector<double> contour_levels(const ColourRange& range) {
  const double length = range.max - range.min;
  std::vector<double> levels;
  if (range.log) {
    for (double power = std::floor(std::log10(range.min)); power <= std::log10(range.max); ++power)
      for (const double factor : {1., 2., 5.})
        if (const double at = factor * std::pow(10., power);
            range.position(at) > 1e-6 && range.position(at) < 1 - 1e-6 && (factor == 1 || range.max < 1e4 * range.min))
          levels.push_back(at);
    return levels;
  }
  for (const Tick& tick : make_ticks(range.min, range.max, 15).list)
    if (range.position(tick.at) > 1e-6 && range.position(tick.at) < 1 - 1e-6 && std::fabs(tick.at) > 1e-9 * length)
      levels.push_back(tick.at);
  return levels;
}

std::vector<ContourLine> contour_lines(const HeightField& field, const std::vector<double>& levels) {
  const Field values{{field.nx, field.ny, 1}, {field.x(1), field.y(1), 1}, field.value.data()};
  std::vector<ContourLine> lines;
  const std::lock_guard lock(drawing_mutex());
  for (const double level : levels)
    for (const std::vector<Point>& joined : drawing().level_lines(values, level)) {
      ContourLine line{level, {}};
      const auto finish = [&] {
        if (line.points.size() > 1) lines.push_back(line);
        line.points.clear();
      };
      for (const Point& p : joined)
        if (std::isfinite(p.x) && std::isfinite(p.y))
          line.points.push_back(p);
        else
          finish();  // beside a NaN
      finish();
    }
  return lines;
}

}  // namespace gaussdrift::render
