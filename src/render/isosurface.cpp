// Surfaces of equal density in perspective: a solid one inside others that can be seen through.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <vector>

#include "render/axes.hpp"
#include "render/drawing_library.hpp"
#include "render/scene.hpp"
#include "render/solid.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {
namespace {

/// A picture of 1280 pixels does not show more points an axis than these, and a surface costs time for each.
constexpr std::size_t most_points = 160;

struct Level {
  double value;    // density
  double opacity;  // 1: solid
};

/// The density, and where its points are in the scene's box, whose longest side is 1.
struct Solid {
  std::vector<float> values;
  Field field;
};

/// Places that are not finite count as 0. An axis with one point is drawn one spacing wide.
Solid solid_of(const DensityGrid& density, double longest) {
  const auto& points = density.lattice.points;
  Solid solid;
  auto& drawn = solid.field.points;
  for (std::size_t k = 0; k < 3; ++k) drawn[k] = std::max<std::size_t>(points[k], 2);
  solid.field.spacing.fill(density.lattice.spacing / longest);
  solid.values.reserve(drawn[0] * drawn[1] * drawn[2]);
  for (std::size_t k = 0; k < drawn[2]; ++k)
    for (std::size_t j = 0; j < drawn[1]; ++j)
      for (std::size_t i = 0; i < drawn[0]; ++i) {
        const std::size_t row = std::min(j, points[1] - 1) + points[1] * std::min(k, points[2] - 1);
        const double value = density.rho[std::min(i, points[0] - 1) + points[0] * row];
        solid.values.push_back(std::isfinite(value) ? static_cast<float>(value) : 0);
      }
  solid.field.values = solid.values.data();
  return solid;
}

/// Triangles of all levels in one list. Those behind come first, so that those in front cover them.
class Surfaces {
 public:
  void add(const Field& field, const Level& level, const Colour& colour) {
    const std::lock_guard lock(drawing_mutex());
    const Mesh surface = drawing().level_surface(field, level.value);
    const auto first = static_cast<std::int64_t>(mesh_.points.size());
    mesh_.points.insert(mesh_.points.end(), surface.points.begin(), surface.points.end());
    mesh_.normals.insert(mesh_.normals.end(), surface.normals.begin(), surface.normals.end());
    const auto opacity = static_cast<std::uint8_t>(std::lround(255 * level.opacity));
    mesh_.colours.resize(mesh_.points.size(), {colour[0], colour[1], colour[2], opacity});
    for (const auto& [a, b, c] : surface.triangles) mesh_.triangles.push_back({first + a, first + b, first + c});
  }

  bool empty() const { return mesh_.triangles.empty(); }

  void show(Scene& scene, const View& view, bool translucent) {
    const auto& triangles = mesh_.triangles;
    std::vector<float> depth(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      Place centre{};
      for (const std::int64_t corner : triangles[t])
        for (std::size_t k = 0; k < 3; ++k)
          centre[k] += static_cast<double>(mesh_.points[static_cast<std::size_t>(corner)][k]) / 3;
      depth[t] = static_cast<float>(view.depth(centre));
    }
    std::vector<std::size_t> order(triangles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return depth[a] > depth[b]; });
    std::vector<std::array<std::int64_t, 3>> sorted;
    sorted.reserve(order.size());
    for (const std::size_t t : order) sorted.push_back(triangles[t]);
    mesh_.triangles = std::move(sorted);
    scene.mesh(mesh_, {.ambient = 0.45,
                       .diffuse = translucent ? 0.75 : 0.6,
                       .specular = 0.15,
                       .specular_power = 25,
                       .translucent = translucent});
  }

 private:
  Mesh mesh_;
};

/// The levels on both sides of 0, where the range has both: a solid surface at 3/4 of the end of the range, others
/// outside it. Overshoots below a tenth of the range's larger end get no surface.
std::vector<Level> levels_of(const ColourRange& range) {
  const double least = 0.1 * std::max(std::abs(range.min), std::abs(range.max));
  std::vector<Level> levels;
  for (const double end : {range.min, range.max}) {
    const bool outwards = end == range.max ? end > 0 : end < 0;
    if (!outwards) continue;
    for (const auto& [part, opacity] : {std::pair{0.15, 0.2}, {0.45, 0.35}, {0.75, 1.}})
      if (const double value = part * end; value > range.min && value < range.max && std::abs(value) > least)
        levels.push_back({value, opacity});
  }
  return levels;
}

void draw(Canvas& canvas, const DensityGrid& full, const ColourRange& range, const PictureOptions& options) {
  const Scale scale(canvas);
  const DensityGrid density = thinned(full, most_points);
  const Lattice& lattice = density.lattice;
  Place box{};
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    box[axis] = lattice.spacing * static_cast<double>(std::max<std::size_t>(lattice.points[axis], 2) - 1);
    longest = std::max(longest, box[axis]);
  }
  for (double& side : box) side /= longest;
  const auto axis = [&](int k) {
    const double side = box[static_cast<std::size_t>(k)], from = lattice.origin[k];
    return short_axis(std::string(1, "xyz"[k]), from, from + side * longest, side > 0.4 ? 5 : 2);
  };
  const Axis x = axis(0), y = axis(1), z = axis(2);

  const double right = scale(160) + Canvas::text_width(y.title(), scale.font(21));
  const View view(canvas, box,
                  {scale(128), scale(96), canvas.width() - scale(128) - right, canvas.height() - scale(96 + 130)},
                  options.looks.view);
  Scene& scene = canvas.scene();
  add_walls(scene, view, box, x, y, z, true);
  const Solid values = solid_of(density, longest);
  const ValueFacts facts = facts_of(full.rho);
  Surfaces solid, clear;
  std::vector<double> marks;
  const auto add = [&](const ColourRange& of) {
    marks.clear();
    for (const Level& level : levels_of(of)) {
      (level.opacity < 1 ? clear : solid).add(values.field, level, range.colour(level.value));
      marks.push_back(level.value);
    }
    return !solid.empty() || !clear.empty();
  };
  ColourRange own = range;
  own.min = std::min(0., facts.minimum), own.max = std::max(0., facts.maximum);
  const bool by_range = add(range);
  const bool by_own = !by_range && own.min < own.max && add(own);
  if (!solid.empty()) solid.show(scene, view, false);
  if (!clear.empty()) clear.show(scene, view, true);
  canvas.show_scene();

  draw_edges(canvas, view, box, x, y, z);
  if (by_own)
    canvas.text({(canvas.width() - right + scale(128)) / 2, scale(64)},
                "levels of this picture alone: 15, 45 and 75 % of its largest value",
                {.size = scale.font(17), .colour = {105, 105, 105}});
  if (!by_range && !by_own)
    canvas.text({(canvas.width() - right + scale(128)) / 2, scale(400)},
                "no surface: the density is the same everywhere", {.size = scale.font(18), .colour = grey});
  draw_colour_bar(canvas, bar_beside_scene(canvas), true, value_axis(options.quantity, range, 6), marks, range.map);
  draw_heading(canvas, options, facts);
}

Painting isosurface(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  check_solid(density);
  return [&density, range, options](Canvas& canvas) { draw(canvas, density, range, options); };
}

}  // namespace

Style isosurface_style() {
  return {.about = {.name = "isosurface",
                    .meaning = "surfaces of equal density in perspective, at 15, 45 and 75 % of the range; where none "
                               "would be seen, of "
                               "the largest value of the picture",
                    .least_dimension = 3},
          .cost = {.seconds = 0.09, .a_point_in_space = 3e-8, .memory = 1.36e8, .memory_of_pixel = 290},

          .painting = isosurface};
}

}  // namespace gaussdrift::render
