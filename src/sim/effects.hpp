// The effects of a scene: those that its case names are constructed here, nothing else.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "effect/effect.hpp"

namespace gaussdrift {

struct Case;
struct Scene;

using Effects = std::vector<std::unique_ptr<Effect>>;

/// Carries particles that stand on their lattice nodes to where they would be now, had they been there all along.
using Follow = std::function<void(Particles& particles)>;

/// In the order in which they act. The scene and what `follow` refers to must outlive them.
Effects make_effects(const Case& description, const Scene& scene, Follow follow, int threads);

}  // namespace gaussdrift
