#include "sim/effects.hpp"

#include <cmath>

#include "effect/charge.hpp"
#include "effect/core_spreading.hpp"
#include "effect/particle_exchange.hpp"
#include "effect/reaction.hpp"
#include "effect/remesh.hpp"
#include "effect/vortex.hpp"
#include "gaussdrift/case.hpp"
#include "sim/simulation.hpp"

namespace gaussdrift {

namespace {

/// A charge density of its own, times the volume of a particle, at the places of the particles.
std::function<std::vector<double>(const Particles&)> charges_by(const ScalarField& density, double cell) {
  return [&density, cell](const Particles& particles) {
    std::vector<double> charges(particles.size(), 0.0);
    density.add(0, particles.view(), charges.data());
    for (double& charge : charges) charge *= cell;
    return charges;
  };
}

}  // namespace

Effects make_effects(const Case& description, const Scene& scene, Follow follow, int threads) {
  const EffectsSpec& named = description.effects;
  Effects effects;
  if (named.reaction) effects.push_back(std::make_unique<Reaction>(*scene.reaction_rate));
  if (const auto& diffusion = named.diffusion) {
    if (diffusion->method == DiffusionSpec::Method::core_spreading)
      effects.push_back(std::make_unique<CoreSpreading>(diffusion->coefficient, *scene.velocity, description.time.end,
                                                        difference_length(scene)));
    else
      effects.push_back(std::make_unique<ParticleExchange>(
          scene.seeding, scene.core_radius, *scene.velocity, std::move(follow),
          ParticleExchange::Options{
              .coefficient = diffusion->coefficient, .tolerance = diffusion->tolerance, .threads = threads}));
  }
  const int dimension = description.domain.dimension;
  const double cell = std::pow(scene.seeding.spacing, dimension);
  const double spreading = named.diffusion ? 4 * named.diffusion->coefficient : 0;  // of blobs, by core spreading
  if (const auto& charge = named.charge) {
    Charge::Options options{.mobility = charge->mobility,
                            .core_radius = scene.core_radius,
                            .spreading = spreading,
                            .cell = cell,
                            .tolerance = charge->tolerance,
                            .dimension = dimension,
                            .threads = threads};
    if (!charge->density.empty()) {
      options.own = charges_by(*scene.charge, cell);
      options.written = charge->density;
    }
    effects.push_back(std::make_unique<Charge>(std::move(options)));
  }
  if (const auto& vortex = named.vortex)
    effects.push_back(std::make_unique<Vortex>(Vortex::Options{.core_radius = scene.core_radius,
                                                               .spreading = spreading,
                                                               .cell = cell,
                                                               .tolerance = vortex->tolerance,
                                                               .threads = threads}));
  if (const auto& remesh = named.remesh)
    effects.push_back(std::make_unique<Remesh>(scene.seeding, Remesh::Options{.every = remesh->every,
                                                                              .stretch = remesh->stretch,
                                                                              .kernel = remesh->kernel,
                                                                              .tolerance = remesh->tolerance}));
  return effects;
}

}  // namespace gaussdrift
