#include "sim/effects.hpp"

#include <algorithm>
#include <cmath>

#include "effect/catalogue.hpp"
#include "effect/tracer_reactions.hpp"
#include "gaussdrift/case.hpp"
#include "sim/borders/edges.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {

Effects make_effects(const Case& spec, const Scene& scene, const Follow& follow, base::Communicator& ranks,
                     const RankAt& rank_at, int threads) {
  Effects made;
  for (const auto& [effect, values] : effects_of(spec.effects)) {
    const auto fields = std::find_if(scene.effect_fields.begin(), scene.effect_fields.end(),
                                     [&name = values.name](const EffectFields& one) { return one.effect == name; });
    const bool any = fields != scene.effect_fields.end();
    made.push_back(effect->make(values, {.spec = spec,
                                         .velocity = *scene.velocity,
                                         .seeding = scene.seeding,
                                         .core_radius = scene.core_radius,
                                         .distance = difference_length(scene),
                                         .spreading = spreading(spec.effects),
                                         .decay = any ? fields->decay.get() : nullptr,
                                         .carried = any ? fields->carried.get() : nullptr,
                                         .field = any ? fields->field.get() : nullptr,
                                         .follow = follow,
                                         .folding = folding_of(spec.domain),
                                         .ranks = ranks,
                                         .rank_at = rank_at,
                                         .threads = threads}));
  }
  if (tracers_react(spec)) {  // the last one: its rows of path integrals come behind those of others
    bool volumes_are_kept = false;
    for (const auto& [effect, values] : effects_of(spec.effects))
      volumes_are_kept = volumes_are_kept || effect->traits.adds_particles.of(values, spec.domain.dimension);
    made.push_back(
        std::make_unique<TracerReactions>(spec, *scene.velocity, scene.seeding.largest_cell(), volumes_are_kept));
  }
  return made;
}

}  // namespace gaussdrift
