#include "reference/sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace gaussdrift {

namespace {

/// Points of a sphere stand for areas that differ with the latitude.
void weigh_by_areas(const Lattice& lattice, GridSample& sample) {
  for (std::size_t i = 0; lattice.sphere > 0 && i < sample.points.size(); ++i)
    sample.weight[i] *= part_of_largest_cell(lattice, sample.points[i]);
}

}  // namespace

double part_of_largest_cell(const Lattice& lattice, std::size_t point) {
  return lattice.cell(lattice.coordinate(1, point / lattice.points[0] % lattice.points[1])) / lattice.largest_cell();
}

GridSample sample_of_grid(const Lattice& lattice, const std::vector<double>& rho, std::size_t count) {
  GridSample sample;
  if (rho.size() <= count) {
    sample.points.resize(rho.size());
    std::iota(sample.points.begin(), sample.points.end(), std::size_t{0});
    sample.weight.assign(rho.size(), 1.0);
    weigh_by_areas(lattice, sample);
    return sample;
  }
  std::size_t top = 0;
  for (std::size_t i = 0; i < rho.size(); ++i)
    if (std::abs(rho[i]) > std::abs(rho[top])) top = i;
  std::array<std::vector<std::size_t>, 2> halves;  // where there is density, and where there is none
  for (std::size_t i = 0; i < rho.size(); ++i) halves[!(std::abs(rho[i]) >= 1e-6 * std::abs(rho[top]))].push_back(i);
  for (std::size_t h = 0; h < 2; ++h) {
    const auto& points = halves[h];
    const std::size_t other = halves[1 - h].size();
    // If one half needs fewer points than planned, the other gets them.
    const std::size_t wanted = std::min(points.size(), std::max(count / 2, count - std::min(count, other)));
    for (std::size_t i = 0; i < wanted; ++i) {
      const auto at = static_cast<std::size_t>((static_cast<double>(i) + 0.5) / static_cast<double>(wanted) *
                                               static_cast<double>(points.size()));
      sample.points.push_back(points[std::min(at, points.size() - 1)]);
      sample.weight.push_back(static_cast<double>(points.size()) / static_cast<double>(wanted));
    }
  }
  std::array<std::size_t, max_dimension> centre{};
  for (std::size_t k = 0, rest = top; k < max_dimension; ++k)
    centre[k] = rest % lattice.points[k], rest /= lattice.points[k];
  const auto near = [&](std::size_t k) {
    const std::size_t low = centre[k] > 0 ? centre[k] - 1 : 0;
    return std::pair{low, std::min(centre[k] + 1, lattice.points[k] - 1)};
  };
  const auto [x0, x1] = near(0);
  const auto [y0, y1] = near(1);
  const auto [z0, z1] = near(2);
  for (std::size_t z = z0; z <= z1; ++z)
    for (std::size_t y = y0; y <= y1; ++y)
      for (std::size_t x = x0; x <= x1; ++x) {
        sample.points.push_back((z * lattice.points[1] + y) * lattice.points[0] + x);
        sample.weight.push_back(0);
      }
  weigh_by_areas(lattice, sample);
  return sample;
}

}  // namespace gaussdrift
