#include "render/height_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"

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

HeightField make_height_field(const DensityGrid& density, const ColourRange& range, std::size_t most) {
  const Lattice& lattice = density.lattice;
  if (lattice.dimension != 2)
    throw Error(ExitCode::internal, fmt::format("pictures show densities in 2 dimensions, not {}", lattice.dimension));
  const std::size_t nx = lattice.points[0], ny = lattice.points[1];
  if (nx * ny == 0 || density.rho.size() != nx * ny)
    throw Error(ExitCode::internal, fmt::format("density has {} values on {} x {} points", density.rho.size(), nx, ny));

  HeightField field;
  field.nx = std::max<std::size_t>(nx, 2);  // an axis with one point is drawn one spacing wide
  field.ny = std::max<std::size_t>(ny, 2);
  const double steps_x = static_cast<double>(field.nx - 1), steps_y = static_cast<double>(field.ny - 1);
  field.width = steps_x / std::max(steps_x, steps_y);
  field.depth = steps_y / std::max(steps_x, steps_y);
  field.length = std::max(steps_x, steps_y) * lattice.spacing;
  field.x_min = lattice.origin[0] - (nx == 1 ? 0.5 * lattice.spacing : 0);
  field.y_min = lattice.origin[1] - (ny == 1 ? 0.5 * lattice.spacing : 0);

  field.minimum = std::numeric_limits<double>::infinity();
  field.maximum = -field.minimum;
  for (const double value : density.rho) {
    if (!std::isfinite(value)) {
      ++field.not_finite;
      continue;
    }
    field.minimum = std::min(field.minimum, value);
    field.maximum = std::max(field.maximum, value);
  }
  if (field.not_finite == density.rho.size()) field.minimum = field.maximum = 0;

  field.value.resize(field.nx * field.ny);
  constexpr double far = 1e6;  // outside the range so far that it does not matter how far
  for (std::size_t j = 0; j < field.ny; ++j)
    for (std::size_t i = 0; i < field.nx; ++i) {
      const double value = density.rho[std::min(j, ny - 1) * nx + std::min(i, nx - 1)];
      field.value[j * field.nx + i] = std::isfinite(value)
                                          ? static_cast<float>(std::clamp(range.position(value), -far, far))
                                          : std::numeric_limits<float>::quiet_NaN();
    }
  return resample(field, std::min(field.nx, most), std::min(field.ny, most));
}

}  // namespace gaussdrift::render
