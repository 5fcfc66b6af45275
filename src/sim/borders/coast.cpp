#include "sim/borders/coast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include "base/parallel.hpp"
#include "sim/borders/edges.hpp"
#include "sim/make_fields.hpp"

namespace gaussdrift {

Coast::Coast(const Case& spec)
    : rule_(spec.domain.coast),
      clock_(clock_of(spec.time)),
      folding_(folding_of(spec.domain)),
      dimension_(spec.domain.dimension) {
  spacing_.fill(std::numeric_limits<double>::infinity());
  for (const VelocitySpec& part : spec.velocity) {
    const auto* file = std::get_if<FileVelocitySpec>(&part);
    if (!file || !file->data->land) continue;
    const Land& land = lands_.emplace_back(file->data, outside_of(*file));
    for (int k = 0; k < dimension_; ++k) spacing_[k] = std::min(spacing_[k], land.spacing(k));
  }
}

Land::Shore Coast::shore(double t, const Vector& x) const {
  Vector folded = x;
  std::array<double, max_dimension> sign{1, 1, 1};
  for (int k = 0; k < dimension_; ++k)
    if (folding_.axis(k).folds()) {
      const Folded place = folding_.fold(k, x[k]);
      folded[k] = place.x, sign[k] = place.sign;
    }
  Land::Shore most;
  for (const Land& land : lands_)
    if (const Land::Shore one = land.shore(clock_.at(t), folded, 0); one.water < most.water) most = one;
  for (int k = 0; k < dimension_; ++k) most.slope[k] *= sign[k];
  return most;
}

std::optional<Coast::Crossing> Coast::crossing(double from, const Vector& a, double to, const Vector& b) const {
  if (is_land(from, a)) return Crossing{a, a};
  constexpr double most_looks = 1000;
  double halves = 1;  // of cells
  for (int k = 0; k < dimension_; ++k) halves = std::max(halves, 2 * std::abs(b[k] - a[k]) / spacing_[k]);
  if (!std::isfinite(halves)) return std::nullopt;
  const int looks = static_cast<int>(std::ceil(std::min(halves, most_looks)));
  const auto place = [&](double s) {
    Vector x = b;
    for (int k = 0; k < dimension_ && s < 1; ++k) x[k] = a[k] + s * (b[k] - a[k]);
    return x;
  };
  const auto lands_at = [&](double s) { return is_land(s < 1 ? from + s * (to - from) : to, place(s)); };
  for (int i = 1; i <= looks; ++i) {
    double land = static_cast<double>(i) / looks, water = static_cast<double>(i - 1) / looks;
    if (!lands_at(land)) continue;
    constexpr int halvings = 40;
    for (int h = 0; h < halvings; ++h) {
      const double middle = water + (land - water) / 2;
      (lands_at(middle) ? land : water) = middle;
    }
    return Crossing{place(water), place(land)};
  }
  return std::nullopt;
}

// Along the slope of the part of water, to where it is just enough.
std::optional<Vector> Coast::out_of_land(double t, Vector x) const {
  constexpr int most_steps = 30;
  constexpr double enough = Land::least_water + 1e-6;
  for (int i = 0; i < most_steps; ++i) {
    const Land::Shore here = shore(t, x);
    if (here.water >= Land::least_water) return x;
    double square = 0;
    for (int k = 0; k < dimension_; ++k) square += here.slope[k] * here.slope[k];
    if (!(square > 0)) return std::nullopt;
    // Not farther than a cell at a time: beyond it the slope is another one.
    double length = (enough - here.water) / square;
    for (int k = 0; k < dimension_; ++k)
      if (const double move = std::abs(length * here.slope[k]); move > spacing_[k]) length *= spacing_[k] / move;
    for (int k = 0; k < dimension_; ++k) x[k] += length * here.slope[k];
  }
  return std::nullopt;
}

// Where a particle is that was to go from a to b.
Vector Coast::met(const Vector& a, const Vector& b, double from, double to) const {
  const auto coast = crossing(from, a, to, b);
  if (!coast) return b;
  if (rule_ != AtCoast::slide) return coast->land;
  const auto beside = out_of_land(to, b);
  if (is_land(from, a)) return beside.value_or(a);  // it started there
  if (beside) {
    // A step that went through land to water on the other side ends before it.
    double moved = 0;
    for (int k = 0; k < dimension_; ++k) moved = std::max(moved, std::abs((*beside)[k] - b[k]) / spacing_[k]);
    if (moved > 0 && moved <= 1) return *beside;
  }
  return coast->water;
}

// place(a, b) is where a particle is that was to go from a to b.
template <class Place>
void Coast::place_each(const std::array<std::vector<double>, max_dimension>& began, Particles& particles, int threads,
                       const Place& place) const {
  constexpr std::size_t block = 1024;
  constexpr double seconds = 5e-8;  // of a particle, roughly
  const std::size_t blocks = (particles.size() + block - 1) / block;
  base::parallel_for({blocks, seconds * static_cast<double>(particles.size())}, threads, [&](std::size_t i) {
    for (std::size_t j = i * block; j < std::min((i + 1) * block, particles.size()); ++j) {
      Vector a{}, b{};
      for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k)
        a[k] = began[k][j], b[k] = particles.position[k][j];
      const Vector x = place(a, b);
      for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) particles.position[k][j] = x[k];
    }
  });
}

void Coast::meet(const std::array<std::vector<double>, max_dimension>& began, Particles& particles, double from,
                 double to, int threads) const {
  place_each(began, particles, threads, [&](const Vector& a, const Vector& b) { return met(a, b, from, to); });
}

void Coast::keep_off(const std::array<std::vector<double>, max_dimension>& before, Particles& particles, double from,
                     double to, int threads) const {
  place_each(before, particles, threads,
             [&](const Vector& a, const Vector& b) { return crossing(from, a, to, b) ? a : b; });
}

void CoastTakes::mark(const Particles& particles, double time, std::vector<int>& reason) const {
  const PointsView x = particles.view();
  for (std::size_t j = 0; j < particles.size(); ++j)
    if (coast_.is_land(time, x.at(j))) reason[j] = 0;
}

}  // namespace gaussdrift
