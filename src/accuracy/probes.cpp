#include "accuracy/probes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/sphere.hpp"
#include "particle/images.hpp"
#include "sim/borders/edges.hpp"
#include "sim/transform.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double rounded_away = 6;  // widths of a Gaussian: beyond them it is below the rounding of its height

double distance_squared(const Vector& a, const Vector& b, int dimension) {
  double square = 0;
  for (int k = 0; k < dimension; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return square;
}

PointsView view_of(const std::array<std::vector<double>, max_dimension>& axis, int dimension) {
  PointsView view{dimension, axis[0].size(), {}};
  for (int k = 0; k < dimension; ++k) view.axis[k] = axis[k].data();
  return view;
}

std::array<std::vector<double>, max_dimension> places_of(const std::vector<Probe>& probes, int dimension) {
  std::array<std::vector<double>, max_dimension> axis;
  for (const Probe& probe : probes)
    for (int k = 0; k < dimension; ++k) axis[k].push_back(probe.x[k]);
  return axis;
}

}  // namespace

Vector grid_point(const Lattice& lattice, std::size_t index) {
  Vector x{};
  for (int k = 0; k < lattice.dimension; ++k) {
    x[k] = lattice.coordinate(k, index % lattice.points[k]);
    index /= lattice.points[k];
  }
  return x;
}

std::vector<Probe> choose_probes(const Lattice& lattice, const std::vector<std::size_t>& points,
                                 const std::vector<double>& rho, const std::vector<double>& exact, double apart,
                                 std::size_t most) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(exact[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(rho[a] - exact[a]) > std::abs(rho[b] - exact[b]);
  });
  if (order.empty()) return {};
  // The largest density comes second: smoothing is often worst there, and nothing cancels there.
  const auto top = std::max_element(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(exact[a]) < std::abs(exact[b]);
  });
  std::rotate(order.begin() + (order.size() > 1 ? 1 : 0), top, top + 1);
  std::vector<Probe> probes;
  for (const std::size_t i : order) {
    if (probes.size() == most) break;
    const Probe probe{points[i], grid_point(lattice, points[i]), exact[i]};
    if (std::all_of(probes.begin(), probes.end(), [&](const Probe& other) {
          return distance_squared(probe.x, other.x, lattice.dimension) > apart * apart;
        }))
      probes.push_back(probe);
  }
  return probes;
}

std::vector<double> exact_of(const std::vector<Probe>& probes) {
  std::vector<double> exact;
  for (const Probe& probe : probes) exact.push_back(probe.exact);
  return exact;
}

std::vector<double> sums_at(const std::vector<Probe>& probes, const Particles& particles, const Cutoff& cutoff,
                            const Domain& domain, int threads) {
  const auto axis = places_of(probes, particles.dimension);
  Particles images;
  const Particles& all = summed_particles(domain, particles, reach_of(cutoff, rounded_away), images);
  return sum_blobs(all, cutoff, view_of(axis, particles.dimension), threads);
}

double reach_of(const Cutoff& cutoff, double widths) {
  double widest = 0;
  for (const CutoffTerm& term : cutoff) widest = std::max(widest, term.width);
  return widths * widest;
}

std::vector<std::size_t> near(const std::vector<Probe>& probes, const Particles& particles, double reach,
                              const Domain& domain) {
  const Folding folding = folding_of_blobs(domain);
  std::vector<std::size_t> of;
  Particles images;
  if (folding.folds()) images = with_images(particles, folding, reach, &of);
  const Particles& all = folding.folds() ? images : particles;
  std::vector<std::size_t> found;
  for (std::size_t j = 0; j < all.size(); ++j) {
    const Vector x = all.view().at(j);
    if (std::any_of(probes.begin(), probes.end(), [&](const Probe& probe) {
          if (domain.on_sphere()) return domain.sphere * angle_between(x, probe.x) <= reach;
          return distance_squared(x, probe.x, particles.dimension) <= reach * reach;
        }))
      found.push_back(of.empty() ? j : of[j]);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    if (!(difference <= largest)) largest = difference;
    if (std::isnan(largest)) break;
  }
  return largest;
}

}  // namespace gaussdrift::accuracy
