// The effects of a scene: those that its case names are constructed here, nothing else.
#pragma once

#include <memory>
#include <vector>

#include "effect/effect.hpp"

namespace gaussdrift {

struct Case;
struct Scene;

using Effects = std::vector<std::unique_ptr<Effect>>;

/// In the order in which they act. The scene must outlive them.
Effects make_effects(const Case& description, const Scene& scene, int threads);

}  // namespace gaussdrift
