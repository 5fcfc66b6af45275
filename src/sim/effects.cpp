#include "sim/effects.hpp"

#include "effect/core_spreading.hpp"
#include "effect/particle_exchange.hpp"
#include "effect/reaction.hpp"
#include "effect/remesh.hpp"
#include "gaussdrift/case.hpp"
#include "sim/simulation.hpp"

namespace gaussdrift {

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
  if (const auto& remesh = named.remesh)
    effects.push_back(std::make_unique<Remesh>(scene.seeding, Remesh::Options{.every = remesh->every,
                                                                              .stretch = remesh->stretch,
                                                                              .kernel = remesh->kernel,
                                                                              .tolerance = remesh->tolerance}));
  return effects;
}

}  // namespace gaussdrift
