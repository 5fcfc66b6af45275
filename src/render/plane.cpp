#include "render/plane.hpp"

#include <algorithm>
#include <cmath>

namespace gaussdrift::render {
namespace {

int intervals_across(double pixels, const Scale& scale) {
  return std::clamp(static_cast<int>(pixels / scale(90)), 1, 8);
}
int intervals_upwards(double pixels, const Scale& scale) {
  return std::clamp(static_cast<int>(pixels / scale(40)), 1, 8);
}

}  // namespace

Axis x_axis(const HeightField& field, const Rectangle& window, double pixels, const Scale& scale,
            const PictureOptions& options) {
  const double from = field.x_min + window.x * field.length;
  return {options.axes[0], from, from + window.width * field.length, intervals_across(pixels, scale)};
}
Axis y_axis(const HeightField& field, const Rectangle& window, double pixels, const Scale& scale,
            const PictureOptions& options) {
  const double from = field.y_min + window.y * field.length;
  return {options.axes[1], from, from + window.height * field.length, intervals_upwards(pixels, scale)};
}

Rectangle panel_in(const Rectangle& room, const HeightField& field) {
  const double pixels = std::min(room.width / field.width, room.height / field.depth);
  const double width = std::round(std::max(pixels * field.width, 24.)),
               height = std::round(std::max(pixels * field.depth, 24.));
  return {std::round(room.x + (room.width - width) / 2), std::round(room.y + (room.height - height) / 2), width,
          height};
}

}  // namespace gaussdrift::render
