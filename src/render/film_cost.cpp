#include "render/film_cost.hpp"

#include <algorithm>

#include "render/animation.hpp"

namespace gaussdrift::render {

FilmCost film_cost(const Case& spec, std::size_t points) {
  FilmCost cost;
  if (!spec.output.animation) return cost;
  const AnimationSpec& animation = *spec.output.animation;
  const FilmKind& kind = find_film_kind(animation.kind);
  const std::array<int, 2> size = animation.size[0] > 0 ? animation.size : kind.size;
  const double pixels = static_cast<double>(size[0]) * size[1], usual_pixels = 1280. * 960;
  const auto frames = static_cast<double>(animation.frames), of_grid = static_cast<double>(points);
  const auto arrays = static_cast<double>(film_arrays(spec).size());
  double picture = 0;
  for (const Style* style : film_styles(spec)) {
    const double a_point = spec.domain.dimension == 3 ? style->cost.a_point_in_space : style->cost.a_point;
    picture += style->cost.seconds * pixels / usual_pixels +
               a_point * std::min(of_grid, static_cast<double>(style->cost.most_points));
    cost.bytes += arrays * frames * pixels * kind.bytes_of_pixel;
  }
  constexpr double bytes_of_value = 2.2;  // of 4, packed
  constexpr double encode = 15e-9;        // seconds of a pixel
  const auto styles = static_cast<double>(film_styles(spec).size());
  cost.seconds = arrays * frames * (picture + styles * encode * pixels);
  cost.kept = frames * of_grid * bytes_of_value * (arrays + (spec.output.pictures.velocity.empty() ? 0 : 2));
  return cost;
}

}  // namespace gaussdrift::render
