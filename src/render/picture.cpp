#include "render/picture.hpp"

#include <fmt/format.h>

#include <cmath>
#include <mutex>

#include "base/error.hpp"
#include "render/osmesa_window.hpp"
#include "render/styles.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::render {
namespace {

/// More points than these a picture of 1280 pixels does not show; a surface costs time for each.
constexpr std::size_t most_surface = 300, most_plane = 1000;

ColourRange colour_range(const DensityGrid& density, const PictureOptions& options) {
  if (std::isfinite(options.range_min) && std::isfinite(options.range_max) && options.range_min < options.range_max)
    return {options.range_min, options.range_max};
  double minimum = 0, maximum = 0;
  for (const double value : density.rho)
    if (std::isfinite(value)) minimum = std::min(minimum, value), maximum = std::max(maximum, value);
  const auto [min, max] = rounded_range(minimum, maximum);
  return {min, max};
}

}  // namespace

std::string unavailable_reason() { return window_unavailable_reason(); }

void draw(Style style, const DensityGrid& density, const PictureOptions& options, const std::filesystem::path& png) {
  if (const std::string reason = unavailable_reason(); !reason.empty()) throw Error(ExitCode::internal, reason);
  if (options.width < 64 || options.height < 48 || options.width > 16384 || options.height > 16384)
    throw Error(ExitCode::internal,
                fmt::format("a picture of {} x {} pixels is not possible", options.width, options.height));
  static std::mutex one_at_a_time;  // VTK and GLEW share their state between all windows
  const std::lock_guard lock(one_at_a_time);

  const ColourRange range = colour_range(density, options);
  const HeightField field = make_height_field(density, range, style == Style::surface ? most_surface : most_plane);
  std::string bytes;
  {
    Canvas canvas(options.width, options.height);
    switch (style) {
      case Style::surface:
        draw_surface(canvas, field, range, options);
        break;
      case Style::contour:
        draw_contour(canvas, field, range, options);
        break;
      case Style::heatmap:
        draw_heatmap(canvas, field, range, options);
        break;
    }
    bytes = canvas.png();
  }
  write::write_text(png, bytes);
}

}  // namespace gaussdrift::render
