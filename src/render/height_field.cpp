#include "render/height_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaussdrift/error.hpp"

namespace gaussdrift::render {
namespace {

/// Where the points of a thinner axis lie between those of the given one.
struct Between {
  std::size_t low, high;
  float weight;  // of high
};

std::vector<Between> places(std::size_t from, std::size_t to) {
  std::vector<Between> list(to);
  for (std::size_t i = 0; i < to; ++i) {
    const double place = static_cast<double>(i) * static_cast<double>(from - 1) / static_cast<double>(to - 1);
    const auto low = std::min(static_cast<std::size_t>(place), from - 1);
    list[i] = {low, std::min(low + 1, from - 1), static_cast<float>(place - static_cast<double>(low))};
  }
  return list;
}

}  // namespace

float drawn_position(const ColourRange& range, double value) {
  constexpr double far = 1e6;  // outside the range so far that it does not matter how far
  return std::isfinite(value) ? static_cast<float>(std::clamp(range.position(value), -far, far))
                              : std::numeric_limits<float>::quiet_NaN();
}

HeightField resample(const HeightField& field, std::size_t nx, std::size_t ny) {
  if (nx == field.nx && ny == field.ny) return field;
  HeightField thin = field;
  thin.nx = nx;
  thin.ny = ny;
  thin.value.resize(nx * ny);
  const auto across = places(field.nx, nx), along = places(field.ny, ny);
  const auto mix = [](float a, float b, float weight) { return weight == 0 ? a : a + weight * (b - a); };
  for (std::size_t j = 0; j < ny; ++j) {
    const auto& y = along[j];
    for (std::size_t i = 0; i < nx; ++i) {
      const auto& x = across[i];
      const float lower = mix(field.at(x.low, y.low), field.at(x.high, y.low), x.weight);
      const float upper = mix(field.at(x.low, y.high), field.at(x.high, y.high), x.weight);
      thin.value[j * nx + i] = mix(lower, upper, y.weight);
    }
  }
  return thin;
}

ValueFacts facts_of(const std::vector<double>& values) {
  ValueFacts facts{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0};
  for (const double value : values) {
    if (!std::isfinite(value)) {
      ++facts.not_finite;
      continue;
    }
    facts.minimum = std::min(facts.minimum, value);
    facts.maximum = std::max(facts.maximum, value);
  }
  if (facts.not_finite == values.size()) facts.minimum = facts.maximum = 0;
  return facts;
}

HeightField make_height_field(const Plane& plane, const ColourRange& range) {
  const std::size_t nx = plane.nx, ny = plane.ny;
  if (nx * ny == 0 || plane.value.size() != nx * ny)
    throw Error(ExitCode::internal, fmt::format("density has {} values on {} x {} points", plane.value.size(), nx, ny));

  HeightField field;
  static_cast<ValueFacts&>(field) = facts_of(plane.value);
  field.nx = std::max<std::size_t>(nx, 2);  // an axis with one point is drawn one spacing wide
  field.ny = std::max<std::size_t>(ny, 2);
  const double steps_x = static_cast<double>(field.nx - 1), steps_y = static_cast<double>(field.ny - 1);
  field.width = steps_x / std::max(steps_x, steps_y);
  field.depth = steps_y / std::max(steps_x, steps_y);
  field.length = std::max(steps_x, steps_y) * plane.spacing;
  field.x_min = plane.x_min - (nx == 1 ? 0.5 * plane.spacing : 0);
  field.y_min = plane.y_min - (ny == 1 ? 0.5 * plane.spacing : 0);

  field.value.resize(field.nx * field.ny);
  for (std::size_t j = 0; j < field.ny; ++j)
    for (std::size_t i = 0; i < field.nx; ++i)
      field.value[j * field.nx + i] =
          drawn_position(range, plane.value[std::min(j, ny - 1) * nx + std::min(i, nx - 1)]);
  return field;
}

HeightField make_height_field(const DensityGrid& density, const ColourRange& range, std::size_t most) {
  const Lattice& lattice = density.lattice;
  if (lattice.dimension != 2)
    throw Error(ExitCode::internal,
                fmt::format("this style shows densities in 2 dimensions, not {}", lattice.dimension));
  const HeightField field = make_height_field(
      Plane{lattice.points[0], lattice.points[1], lattice.origin[0], lattice.origin[1], lattice.spacing, density.rho},
      range);
  return resample(field, std::min(field.nx, most), std::min(field.ny, most));
}

}  // namespace gaussdrift::render
