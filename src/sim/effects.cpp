#include "sim/effects.hpp"

#include "effect/reaction.hpp"
#include "gaussdrift/case.hpp"
#include "sim/simulation.hpp"

namespace gaussdrift {

Effects make_effects(const Case& description, const Scene& scene, int /*threads*/) {
  const EffectsSpec& named = description.effects;
  Effects effects;
  if (named.reaction) effects.push_back(std::make_unique<Reaction>(*scene.reaction_rate));
  return effects;
}

}  // namespace gaussdrift
