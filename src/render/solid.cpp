#include "render/solid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaussdrift/error.hpp"

namespace gaussdrift::render {
namespace {

std::array<std::size_t, 3> strides(const Lattice& lattice) {
  return {1, lattice.points[0], lattice.points[0] * lattice.points[1]};
}

Plane empty_plane(const Lattice& lattice, int across, int up) {
  return {lattice.points[across], lattice.points[up], lattice.origin[across], lattice.origin[up], lattice.spacing, {}};
}

}  // namespace

void check_solid(const DensityGrid& density) {
  const Lattice& lattice = density.lattice;
  if (lattice.dimension != 3)
    throw Error(ExitCode::internal,
                fmt::format("this style shows densities in 3 dimensions, not {}", lattice.dimension));
  if (lattice.size() == 0 || density.rho.size() != lattice.size())
    throw Error(ExitCode::internal, fmt::format("density has {} values on {} x {} x {} points", density.rho.size(),
                                                lattice.points[0], lattice.points[1], lattice.points[2]));
}

std::array<std::size_t, 3> largest_point(const DensityGrid& density) {
  const auto& points = density.lattice.points;
  double largest = 0;
  for (const double value : density.rho)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  if (largest == 0) return {points[0] / 2, points[1] / 2, points[2] / 2};

  // On a plateau rounding decides which value is the largest. Nobody sees less than this in a picture.
  constexpr double plateau = 1e-3;
  using Point = std::array<std::size_t, 3>;
  const auto for_each_highest = [&](const auto& use) {
    for (std::size_t i = 0; i < density.rho.size(); ++i)
      if (std::isfinite(density.rho[i]) && std::abs(density.rho[i]) >= (1 - plateau) * largest)
        use(Point{i % points[0], i / points[0] % points[1], i / points[0] / points[1]});
  };
  std::array<double, 3> middle{};
  double count = 0;
  for_each_highest([&](const Point& at) {
    for (std::size_t k = 0; k < 3; ++k) middle[k] += static_cast<double>(at[k]);
    ++count;
  });
  Point nearest{};
  double least = std::numeric_limits<double>::infinity();
  for_each_highest([&](const Point& at) {
    double distance = 0;
    for (std::size_t k = 0; k < 3; ++k) distance += std::pow(static_cast<double>(at[k]) - middle[k] / count, 2);
    if (distance < least) least = distance, nearest = at;
  });
  return nearest;
}

Plane slice(const DensityGrid& density, int across, int up, std::size_t index) {
  const auto step = strides(density.lattice);
  const auto a = static_cast<std::size_t>(across), u = static_cast<std::size_t>(up), n = 3 - a - u;
  Plane plane = empty_plane(density.lattice, across, up);
  plane.value.reserve(plane.nx * plane.ny);
  for (std::size_t j = 0; j < plane.ny; ++j)
    for (std::size_t i = 0; i < plane.nx; ++i)
      plane.value.push_back(density.rho[i * step[a] + j * step[u] + index * step[n]]);
  return plane;
}

Plane projection(const DensityGrid& density, int across, int up) {
  const auto step = strides(density.lattice);
  const auto a = static_cast<std::size_t>(across), u = static_cast<std::size_t>(up), n = 3 - a - u;
  Plane plane = empty_plane(density.lattice, across, up);
  plane.value.reserve(plane.nx * plane.ny);
  for (std::size_t j = 0; j < plane.ny; ++j)
    for (std::size_t i = 0; i < plane.nx; ++i) {
      double largest = density.rho[i * step[a] + j * step[u]];
      for (std::size_t k = 1; k < density.lattice.points[n]; ++k) {
        const double value = density.rho[i * step[a] + j * step[u] + k * step[n]];
        if (std::isnan(largest) || std::abs(value) > std::abs(largest)) largest = value;
      }
      plane.value.push_back(largest);
    }
  return plane;
}

namespace {

std::size_t points_apart(const Lattice& full, std::size_t most) {
  const std::size_t longest = std::max({full.points[0], full.points[1], full.points[2]});
  return std::max<std::size_t>(1, (longest - 1 + most - 1) / std::max<std::size_t>(1, most));
}

}  // namespace

Lattice thinned_lattice(const Lattice& full, std::size_t most) {
  const std::size_t every = points_apart(full, most);
  Lattice thin = full;
  thin.spacing = full.spacing * static_cast<double>(every);
  for (std::size_t k = 0; k < 3; ++k) thin.points[k] = (full.points[k] - 1) / every + 1;
  return thin;
}

DensityGrid thinned(const DensityGrid& density, std::size_t most) {
  const Lattice& full = density.lattice;
  const std::size_t every = points_apart(full, most);
  if (every == 1) return density;
  DensityGrid thin{thinned_lattice(full, most), {}};
  const auto step = strides(full);
  thin.rho.reserve(thin.lattice.size());
  for (std::size_t k = 0; k < thin.lattice.points[2]; ++k)
    for (std::size_t j = 0; j < thin.lattice.points[1]; ++j)
      for (std::size_t i = 0; i < thin.lattice.points[0]; ++i)
        thin.rho.push_back(density.rho[every * (i * step[0] + j * step[1] + k * step[2])]);
  return thin;
}

}  // namespace gaussdrift::render
