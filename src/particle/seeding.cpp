#include "particle/seeding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace gaussdrift {

namespace {

// One line of lattice points along the first axis, other indices fixed; what it carries is joined in the order of
// lines.
Particles seed_line(const Lattice& lattice, std::size_t line, const DensityFunction& rho_0) {
  const std::size_t length = lattice.points[0];
  const std::size_t j = line % lattice.points[1], k = line / lattice.points[1];
  std::array<std::vector<double>, max_dimension> x;
  x[0] = lattice.nodes(0);
  x[1].assign(length, lattice.coordinate(1, j));
  x[2].assign(length, lattice.coordinate(2, k));
  std::vector<double> rho(length, 0.0);
  PointsView points{lattice.dimension, length, {}};
  for (int a = 0; a < lattice.dimension; ++a) points.axis[a] = x[a].data();
  rho_0(points, rho.data());

  Particles carried;
  carried.dimension = lattice.dimension;
  const double cell = std::pow(lattice.spacing, lattice.dimension);
  for (std::size_t i = 0; i < length; ++i) {
    if (!std::isfinite(rho[i])) {
      std::string place = fmt::format("({}, {}", x[0][i], x[1][i]);
      place += lattice.dimension == 3 ? fmt::format(", {})", x[2][i]) : ")";
      throw NumericalError(
          fmt::format("the initial density is {} at {}; it must be finite on the whole domain: guard the expression, "
                      "or move the domain",
                      std::isnan(rho[i]) ? "nan" : fmt::format("{}", rho[i]), place));
    }
    const double alpha = cell * rho[i];
    if (alpha == 0) continue;
    for (int a = 0; a < lattice.dimension; ++a) carried.position[a].push_back(x[a][i]);
    carried.alpha.push_back(alpha);
    carried.id.push_back(static_cast<std::int64_t>(line * length + i));
  }
  return carried;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

Particles seed(const Lattice& lattice, const DensityFunction& rho_0, int threads) {
  const std::size_t lines = lattice.points[1] * lattice.points[2];
  std::vector<Particles> parts(lines);
  base::parallel_for(lines, threads, [&](std::size_t line) { parts[line] = seed_line(lattice, line, rho_0); });
  Particles all;
  all.dimension = lattice.dimension;
  for (Particles& part : parts) {
    for (int a = 0; a < lattice.dimension; ++a) append(all.position[a], part.position[a]);
    append(all.alpha, part.alpha);
    append(all.id, part.id);
    part = {};
  }
  return all;
}

double largest_stretch(const Particles& particles, const Lattice& lattice) {
  double heaviest = 0, longest = 0;
  for (const double alpha : particles.alpha) heaviest = std::max(heaviest, std::abs(alpha));
  const double light = 1e-6 * heaviest;
  std::size_t stride = 1;
  for (int k = 0; k < particles.dimension; ++k) {
    std::size_t next = 0;  // ids ascend, so that of the neighbour is found by going along
    for (std::size_t j = 0; j < particles.size(); ++j) {
      const auto id = static_cast<std::size_t>(particles.id[j]);
      if (id / stride % lattice.points[k] + 1 == lattice.points[k]) continue;
      while (next < particles.size() && static_cast<std::size_t>(particles.id[next]) < id + stride) ++next;
      if (next == particles.size() || static_cast<std::size_t>(particles.id[next]) != id + stride) continue;
      if (std::abs(particles.alpha[j]) < light && std::abs(particles.alpha[next]) < light) continue;
      double square = 0;
      for (int a = 0; a < particles.dimension; ++a) {
        const double distance = particles.position[a][j] - particles.position[a][next];
        square += distance * distance;
      }
      longest = std::max(longest, square);
    }
    stride *= lattice.points[k];
  }
  return std::sqrt(longest) / lattice.spacing;
}

}  // namespace gaussdrift
