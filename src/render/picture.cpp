#include "render/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tuple>

#include "base/error.hpp"
#include "render/on_canvas.hpp"
#include "render/osmesa_window.hpp"
#include "render/styles.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::render {
namespace {

/// More points than these a picture of 1280 pixels does not show; a surface costs time for each.
constexpr std::size_t most_surface = 300, most_plane = 1000;

ColourRange colour_range(Style style, const DensityGrid& density, const PictureOptions& options) {
  ColourRange range;
  if (style == Style::error) range.map = blue_white_red;
  range.min = options.range_min, range.max = options.range_max;
  if (std::isfinite(range.min) && std::isfinite(range.max) && range.min < range.max) return range;
  double minimum = 0, maximum = 0;
  for (const double value : density.rho)
    if (std::isfinite(value)) minimum = std::min(minimum, value), maximum = std::max(maximum, value);
  std::tie(range.min, range.max) =
      style == Style::error ? symmetric_range(minimum, maximum) : rounded_range(minimum, maximum);
  return range;
}

/// The density of a style that shows planes; empty for others.
HeightField field_for(Style style, const DensityGrid& density, const ColourRange& range) {
  const bool plane = shows(style, 2) && (style != Style::error || density.lattice.dimension == 2);
  return plane ? make_height_field(density, range, style == Style::surface ? most_surface : most_plane) : HeightField{};
}

void draw_on(Canvas& canvas, Style style, const DensityGrid& density, const HeightField& field,
             const ColourRange& range, const PictureOptions& options) {
  switch (style) {
    case Style::surface:
      return draw_surface(canvas, field, range, options);
    case Style::contour:
      return draw_contour(canvas, field, range, options);
    case Style::heatmap:
      return draw_heatmap(canvas, field, range, options);
    case Style::slices:
      return draw_slices(canvas, density, range, options);
    case Style::projection:
      return draw_projection(canvas, density, range, options);
    case Style::isosurface:
      return draw_isosurface(canvas, density, range, options);
    case Style::error:
      return density.lattice.dimension == 2 ? draw_heatmap(canvas, field, range, options)
                                            : draw_slices(canvas, density, range, options);
  }
}

}  // namespace

std::string unavailable_reason() { return window_unavailable_reason(); }

void on_canvas(int width, int height, const std::filesystem::path& png, const std::function<void(Canvas&)>& paint) {
  if (const std::string reason = unavailable_reason(); !reason.empty()) throw Error(ExitCode::internal, reason);
  if (width < 64 || height < 48 || width > 16384 || height > 16384)
    throw Error(ExitCode::internal, fmt::format("a picture of {} x {} pixels is not possible", width, height));
  static std::mutex one_at_a_time;  // VTK and GLEW share their state between all windows
  const std::lock_guard lock(one_at_a_time);
  std::string bytes;
  {
    Canvas canvas(width, height);
    paint(canvas);
    bytes = canvas.png();
  }
  write::write_text(png, bytes);
}

void draw(Style style, const DensityGrid& density, const PictureOptions& options, const std::filesystem::path& png) {
  const ColourRange range = colour_range(style, density, options);
  const HeightField field = field_for(style, density, range);  // VTK looks into it until the picture is finished
  on_canvas(options.width, options.height, png,
            [&](Canvas& canvas) { draw_on(canvas, style, density, field, range, options); });
}

}  // namespace gaussdrift::render
