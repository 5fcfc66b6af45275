#include "accuracy/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"
#include "sim/releases.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

namespace {

// How many values of the density a trial asks for, if one costs no more than a sine or two: in one look over a lattice,
// in a closer look if the first met nothing, and if all particles are taken because they are few.
constexpr double first_look = 250'000, closest_look = 4'000'000, whole_look = 5'000'000;
constexpr double largest_grid = 1'100'000;
constexpr std::size_t smallest_grid = 32;  // points an axis of a grid that is thinned out with the particles

using Indices = std::array<std::size_t, max_dimension>;

double points(const Indices& count, std::size_t stride) {
  double all = 1;
  for (const std::size_t n : count) all *= static_cast<double>((n + stride - 1) / stride);
  return all;
}

/// The smallest that leaves at most so many points.
std::size_t stride_for(const Indices& count, double most) {
  std::size_t stride = 1;
  const std::size_t longest = *std::max_element(count.begin(), count.end());
  while (stride < longest && points(count, stride) > std::max(1.0, most)) ++stride;
  return stride;
}

struct Found {
  Particles particles;
  SeedReport report;
};

Found look(Trial& trial, const LatticePart& part, int threads) {
  trial.looked_at += part.size();
  Found found;
  found.particles = seed_lattice(trial.scene, part.of(trial.lattice), threads, &found.report);
  return found;
}

void take(Trial& trial, const LatticePart& part, Found found) {
  trial.part = part;
  trial.particles = std::move(found.particles);
  trial.seeding = std::move(found.report);
  Scene& scene = trial.scene;
  const double times = static_cast<double>(part.stride);
  scene.seeding = part.of(trial.lattice);
  set_blob(trial.spec.particles, scene);
  trial.spec.effects = trial.effects;
  for (EffectSpec& effect : trial.spec.effects.list)
    if (const auto coarsen = base::find_named(effects(), "effect", effect.name).coarsen) coarsen(effect, times);
}

/// The part of the lattice that has these particles, and one step of the part around them.
LatticePart around(const Particles& particles, const LatticePart& part) {
  Indices low, high{}, across{};
  low.fill(static_cast<std::size_t>(-1));
  for (std::size_t k = 0; k < max_dimension; ++k) across[k] = (part.count[k] + part.stride - 1) / part.stride;
  for (const std::int64_t id : particles.id) {
    std::size_t rest = static_cast<std::size_t>(id);
    for (std::size_t k = 0; k < max_dimension; ++k) {
      low[k] = std::min(low[k], rest % across[k]);
      high[k] = std::max(high[k], rest % across[k]);
      rest /= across[k];
    }
  }
  LatticePart smaller = part;
  for (std::size_t k = 0; k < max_dimension; ++k) {
    const std::size_t begin = low[k] > 0 ? (low[k] - 1) * part.stride : 0,
                      end = std::min(part.count[k], (high[k] + 1) * part.stride + 1);
    smaller.first[k] = part.first[k] + begin;
    smaller.count[k] = end - begin;
  }
  return smaller;
}

LatticePart all_of(const Lattice& lattice) { return {{}, lattice.points, 1}; }

}  // namespace

std::size_t LatticePart::size() const { return static_cast<std::size_t>(points(count, stride)); }

Lattice LatticePart::of(const Lattice& whole) const {
  Lattice part = whole;
  part.spacing = whole.spacing * static_cast<double>(stride);
  for (int k = 0; k < whole.dimension; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    part.origin[axis] = whole.coordinate(k, first[axis]);
    part.points[axis] = (count[axis] + stride - 1) / stride;
  }
  return part;
}

namespace {

/// Where a run starts empty, a density all over the domain stands in for what its sources release.
Case with_something(Case spec) {
  if (spec.density.empty()) spec.density.emplace_back(ExpressionDensitySpec{"1"});
  return spec;
}

}  // namespace

Trial make_trial(const Case& spec, std::size_t most_particles, int threads) {
  Trial trial{.spec = with_something(spec), .scene = make_scene(with_something(spec), threads), .particles = {}};
  trial.lattice = trial.scene.seeding;
  trial.effects = spec.effects;
  const double dearness = std::max(1.0, trial.scene.density->cost());
  LatticePart part = all_of(trial.lattice);
  // First a coarse look over the whole lattice. Then a closer one where there is density, until it fills the part
  // looked at; closer everywhere while none is met.
  double most = std::min(first_look, 4.0 * static_cast<double>(most_particles)) / dearness;
  Found found;
  while (true) {
    part.stride = stride_for(part.count, most);
    found = look(trial, part, threads);
    if (found.particles.size() == 0) {
      if (part.stride == 1) break;
      if (most >= closest_look / dearness)
        throw InputError(fmt::format(
            "the initial density is 0 at {} points that are spread over the particle lattice, which has {}: nothing "
            "can be predicted from so few; make the density wider than {} spacings",
            part.size(), trial.lattice.size(), part.stride));
      most *= 4;
      continue;
    }
    if (part.stride == 1) break;
    const LatticePart smaller = around(found.particles, part);
    if (points(smaller.count, 1) > 0.5 * points(part.count, 1)) break;
    part = smaller;
  }
  trial.carried =
      static_cast<double>(found.particles.size()) * std::pow(static_cast<double>(part.stride), trial.lattice.dimension);
  const LatticePart all = all_of(trial.lattice);
  trial.whole = part.stride == 1 && part.size() == all.size();
  if (!trial.whole && static_cast<double>(all.size()) * dearness <= whole_look &&
      trial.carried <= static_cast<double>(most_particles)) {
    part = all;
    found = look(trial, part, threads);
    trial.carried = static_cast<double>(found.particles.size());
    trial.whole = true;
  }
  take(trial, part, std::move(found));
  if (trial.particles.size() == 0) seed_scene(trial.scene, threads);  // says why there is nothing to carry
  thin_out(trial, most_particles, threads);
  if (spec.density.empty()) trial.carried = std::max(1.0, particles_released(spec, threads) / 2);

  const Lattice& grid = trial.scene.evaluation;
  const std::size_t longest = *std::max_element(grid.points.begin(), grid.points.end());
  LatticePart seen = all_of(grid);
  seen.stride = std::max(stride_for(grid.points, largest_grid),
                         std::min(trial.part.stride, std::max<std::size_t>(1, longest / smallest_grid)));
  trial.grid = seen.of(grid);
  return trial;
}

void thin_out(Trial& trial, std::size_t most_particles, int threads) {
  while (trial.particles.size() > most_particles) {
    const double wanted = std::pow(static_cast<double>(trial.particles.size()) / static_cast<double>(most_particles),
                                   1.0 / trial.lattice.dimension);
    LatticePart part = trial.part;
    part.stride =
        std::max(part.stride + 1, static_cast<std::size_t>(std::ceil(static_cast<double>(part.stride) * wanted)));
    Found fewer = look(trial, part, threads);
    if (fewer.particles.size() == 0) return;  // too coarse for the density
    take(trial, part, std::move(fewer));
    trial.whole = false;
  }
}

}  // namespace gaussdrift::accuracy
