// Constructs the effects that a case names, and no others.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/communicator.hpp"
#include "effect/effect.hpp"

namespace gaussdrift {

struct Case;
struct Scene;

using Effects = std::vector<std::unique_ptr<Effect>>;

/// Carries particles from their lattice nodes to the places that they would have reached by now.
using Follow = std::function<void(Particles& particles)>;

/// In the order in which they act. The scene, the ranks and what `follow` and `rank_at` refer to must outlive them.
Effects make_effects(const Case& spec, const Scene& scene, const Follow& follow, base::Communicator& ranks,
                     const RankAt& rank_at, int threads);

}  // namespace gaussdrift
