#include "render/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tuple>

#include "gaussdrift/error.hpp"
#include "render/drawing_library.hpp"
#include "render/on_canvas.hpp"
#include "render/short_memory.hpp"
#include "render/styles.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::render {
namespace {

ColourRange colour_range(const Style& style, const DensityGrid& density, const PictureOptions& options) {
  ColourRange range;
  range.map = style.colours;
  range.min = options.range_min, range.max = options.range_max;
  if (std::isfinite(range.min) && std::isfinite(range.max) && range.min < range.max) return range;
  double minimum = 0, maximum = 0;
  for (const double value : density.rho)
    if (std::isfinite(value)) minimum = std::min(minimum, value), maximum = std::max(maximum, value);
  std::tie(range.min, range.max) = style.range(minimum, maximum);
  return range;
}

}  // namespace

std::string unavailable_reason() { return missing_drawing(); }

std::string drawing_library() { return drawing().library(); }

void check_available() {
  if (const std::string reason = unavailable_reason(); !reason.empty()) throw CommandLineError(reason);
}

void on_canvas(int width, int height, const std::filesystem::path& png, const std::function<void(Canvas&)>& paint) {
  check_available();
  if (width < 64 || height < 48 || width > 16384 || height > 16384)
    throw Error(ExitCode::internal, fmt::format("a picture of {} x {} pixels is not possible", width, height));
  static std::mutex one_at_a_time;  // VTK and GLEW share their state between all windows
  const std::lock_guard lock(one_at_a_time);
  std::string bytes;
  {
    const WhileDrawing guard;
    Canvas canvas(width, height);
    paint(canvas);
    bytes = canvas.png();
  }
  write::write_text(png, bytes);
}

void draw(const Style& style, const DensityGrid& density, const PictureOptions& options,
          const std::filesystem::path& png) {
  const ColourRange range = colour_range(style, density, options);
  PictureOptions on_map = options;
  if (density.lattice.sphere > 0) on_map.axes = {"longitude (degrees)", "latitude (degrees)"};
  on_canvas(options.width, options.height, png, style.painting(density, range, on_map));
}

}  // namespace gaussdrift::render
