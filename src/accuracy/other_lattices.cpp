#include "accuracy/other_lattices.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "accuracy/probes.hpp"
#include "particle/subset.hpp"

namespace gaussdrift::accuracy {

namespace {

/// Whether there is a cell beyond the first point of an axis, and beyond the last, part of which lies in the domain.
struct Rim {
  bool low = false, high = false, periodic = false;
};

Rim rim_of(const Domain& domain, int axis) {
  const auto [lower, upper] = domain.edges[static_cast<std::size_t>(axis)];
  return {.low = lower == Edge::closed || lower == Edge::periodic,
          .high = upper == Edge::closed,  // on a periodic axis the last cell is the first
          .periodic = lower == Edge::periodic};
}

/// The cells of the lattice that have one of these particles at a corner. Cell i of an axis is left of lattice point i;
/// there is one more than points.
std::vector<std::size_t> cells_around(const Particles& start, const Lattice& lattice, const Domain& domain) {
  std::vector<std::size_t> cells;
  for (const auto id : start.id)
    for (int corner = 0; corner < (1 << start.dimension); ++corner) {
      std::size_t rest = static_cast<std::size_t>(id), cell = 0, stride = 1;
      bool inside = true;
      for (int k = 0; k < start.dimension; ++k) {
        const Rim rim = rim_of(domain, k);
        const std::size_t points = lattice.points[k];
        std::size_t i = rest % points + static_cast<std::size_t>(corner >> k & 1);
        if (rim.periodic) i %= points;
        inside = inside && (0 < i || rim.low) && (i < points || rim.high);
        cell += stride * i;
        rest /= points;
        stride *= points + 1;
      }
      if (inside) cells.push_back(cell);
    }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// Gives all particles the weights of the initial density, each in a cell of the lattice.
void weigh(Particles& particles, const Scene& scene) {
  particles.alpha.assign(particles.position[0].size(), 0.0);
  scene.density->add(particles.view(), particles.alpha.data());
  for (std::size_t j = 0; j < particles.alpha.size(); ++j)
    particles.alpha[j] *= scene.seeding.cell(particles.position[1][j]);
}

/// The middle of cell i of an axis, and which part of the cell lies in the domain.
std::pair<double, double> middle_and_part(const Domain& domain, const Lattice& lattice, int axis, std::size_t i) {
  const bool first = i == 0, last = i == lattice.points[axis];
  const auto a = static_cast<std::size_t>(axis);
  if (first && rim_of(domain, axis).periodic) return {domain.max[a] - lattice.spacing / 2, 1};
  if (first) return {domain.min[a], 0.5};
  if (last) return {domain.max[a], 0.5};
  return {lattice.coordinate(axis, i) - lattice.spacing / 2, 1};
}

}  // namespace

Particles at_start(const Particles& particles, const std::vector<std::size_t>& chosen, const Scene& scene) {
  Particles start;
  start.dimension = particles.dimension;
  for (const std::size_t j : chosen) {
    const Vector x = grid_point(scene.seeding, static_cast<std::size_t>(particles.id[j]));
    for (int k = 0; k < start.dimension; ++k) start.position[k].push_back(x[k]);
    start.id.push_back(particles.id[j]);
  }
  weigh(start, scene);
  return start;
}

Particles between(const Particles& start, const Scene& scene, const Domain& domain) {
  const Lattice& lattice = scene.seeding;
  Particles moved;
  moved.dimension = start.dimension;
  std::vector<double> parts;
  for (std::size_t cell : cells_around(start, lattice, domain)) {
    parts.push_back(1);
    for (int k = 0; k < start.dimension; ++k) {
      const auto [middle, part] = middle_and_part(domain, lattice, k, cell % (lattice.points[k] + 1));
      moved.position[k].push_back(middle);
      parts.back() *= part;
      cell /= lattice.points[k] + 1;
    }
    moved.id.push_back(0);
  }
  weigh(moved, scene);
  for (std::size_t j = 0; j < parts.size(); ++j) moved.alpha[j] *= parts[j];
  return moved;
}

Particles thinned(const Particles& particles, const Lattice& lattice, std::size_t stride) {
  std::vector<std::size_t> chosen;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    auto rest = static_cast<std::size_t>(particles.id[j]);
    bool kept = true;
    for (int k = 0; k < particles.dimension; ++k) {
      kept = kept && rest % lattice.points[k] % stride == 0;
      rest /= lattice.points[k];
    }
    if (kept) chosen.push_back(j);
  }
  Particles thin = subset(particles, chosen);
  for (double& alpha : thin.alpha) alpha *= std::pow(static_cast<double>(stride), particles.dimension);
  return thin;
}

}  // namespace gaussdrift::accuracy
