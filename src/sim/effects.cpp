#include "sim/effects.hpp"

#include "effect/core_spreading.hpp"
#include "effect/particle_exchange.hpp"
#include "effect/reaction.hpp"
#include "gaussdrift/case.hpp"
#include "sim/simulation.hpp"

namespace gaussdrift {

Effects make_effects(const Case& description, const Scene& scene, int threads) {
  const EffectsSpec& named = description.effects;
  Effects effects;
  if (named.reaction) effects.push_back(std::make_unique<Reaction>(*scene.reaction_rate));
  if (const auto& diffusion = named.diffusion) {
    const double end = description.time.end, distance = difference_length(scene);
    if (diffusion->method == DiffusionSpec::Method::core_spreading)
      effects.push_back(std::make_unique<CoreSpreading>(diffusion->coefficient, *scene.velocity, end, distance));
    else
      effects.push_back(std::make_unique<ParticleExchange>(
          *scene.velocity, ParticleExchange::Options{diffusion->coefficient, scene.core_radius, scene.seeding, end,
                                                     diffusion->halo, threads}));
  }
  return effects;
}

}  // namespace gaussdrift
