// The density as a surface in perspective, with contour lines on it.
#include <algorithm>
#include <array>
#include <cmath>

#include "render/axes.hpp"
#include "render/contour_lines.hpp"
#include "render/scene.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {
namespace {

/// Overshoots stick out of the box a little; what is far outside the range is cut off there.
constexpr double stick_out = 0.04;

double height_of(double position, double height) {
  return std::isnan(position) ? 0 : height * std::clamp(position, -stick_out, 1 + stick_out);
}

Mesh mesh_of(const HeightField& field, double height, const ColourRange& range) {
  Mesh mesh;
  mesh.shade = field.value;
  for (int i = 0; i < 256; ++i) mesh.shades.push_back(range.map(i / 255.));
  mesh.points.reserve(field.nx * field.ny), mesh.normals.reserve(field.nx * field.ny);
  const auto z = [&](std::size_t i, std::size_t j) { return height_of(field.at(i, j), height); };
  for (std::size_t j = 0; j < field.ny; ++j)
    for (std::size_t i = 0; i < field.nx; ++i) {
      const std::size_t west = i > 0 ? i - 1 : i, east = std::min(i + 1, field.nx - 1);
      const std::size_t south = j > 0 ? j - 1 : j, north = std::min(j + 1, field.ny - 1);
      const double slope_x = (z(east, j) - z(west, j)) / (field.x(east) - field.x(west));
      const double slope_y = (z(i, north) - z(i, south)) / (field.y(north) - field.y(south));
      const double length = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
      mesh.points.push_back(
          {static_cast<float>(field.x(i)), static_cast<float>(field.y(j)), static_cast<float>(z(i, j))});
      mesh.normals.push_back({static_cast<float>(-slope_x / length), static_cast<float>(-slope_y / length),
                              static_cast<float>(1 / length)});
    }
  const auto nx = static_cast<std::int64_t>(field.nx);
  for (std::size_t j = 0; j + 1 < field.ny; ++j)
    for (std::size_t i = 0; i + 1 < field.nx; ++i) {
      const float sum = field.at(i, j) + field.at(i + 1, j) + field.at(i, j + 1) + field.at(i + 1, j + 1);
      if (std::isnan(sum)) continue;  // a hole
      const auto a = static_cast<std::int64_t>(j * field.nx + i), b = a + 1, c = a + nx, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

void add_contours(Scene& scene, const HeightField& field, double height, const ColourRange& range) {
  std::vector<double> levels;
  for (const double level : contour_levels(range)) levels.push_back(range.position(level));
  std::vector<std::vector<Place>> lines;
  for (const auto& [level, points] : contour_lines(field, levels)) {
    auto& line = lines.emplace_back();
    for (const Point& p : points) line.push_back({p.x, p.y, level * height});
  }
  if (!lines.empty()) scene.tubes(lines, {20, 20, 26}, 0.0011);
}

void draw(Canvas& canvas, const HeightField& field, const ColourRange& range, const PictureOptions& options) {
  const Scale scale(canvas);
  const double height = 0.45 * std::max(0.5, std::sqrt(field.width * field.depth));
  const double w = field.width, d = field.depth;
  const Axis x{options.axes[0], field.x_min, field.x_min + w * field.length, w > 0.4 ? 5 : 2};
  const Axis y{options.axes[1], field.y_min, field.y_min + d * field.length, d > 0.4 ? 5 : 2};
  const Axis z = value_axis(options.quantity, range, 5);

  // Room at the right for the title of y and the colour bar.
  const double right = scale(160) + Canvas::text_width(y.title(), scale.font(21));
  const View view(canvas, {w, d, height},
                  {scale(128), scale(96), canvas.width() - scale(128) - right, canvas.height() - scale(96 + 130)},
                  options.looks.view);

  Scene& scene = canvas.scene();
  add_walls(scene, view, {w, d, height}, x, y, z, false);
  scene.mesh(mesh_of(field, height, range), {.ambient = 0.35, .diffuse = 0.68, .specular = 0.06, .specular_power = 20});
  add_contours(scene, field, height, range);

  canvas.show_scene();

  draw_edges(canvas, view, {w, d, height}, x, y, z);
  draw_colour_bar(canvas, bar_beside_scene(canvas), true, value_axis(options.quantity, range, 6), {}, range.map);
  draw_heading(canvas, options, field);
}

/// A picture of 1280 pixels does not show more points an axis than these, and a surface costs time for each.
constexpr std::size_t most_points = 300;

Painting surface(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  return [field = make_height_field(density, range, most_points), range, options](Canvas& canvas) {
    draw(canvas, field, range, options);
  };
}

}  // namespace

Style surface_style() {
  return {.about = {.name = "surface",
                    .meaning = "a surface in perspective, seen from above at an angle, with contour lines on it",
                    .most_dimension = 2,
                    .by_default = true},
          .cost = {.seconds = 0.065,
                   .a_point = 1e-6,
                   .most_points = most_points * most_points,  // a triangle for every point
                   .memory = 1.36e8,
                   .memory_of_pixel = 130},
          .white_at_zero = true,
          .painting = surface};
}

}  // namespace gaussdrift::render
