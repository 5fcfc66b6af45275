// Some of the particles.
#pragma once

#include <cstddef>
#include <vector>

#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// Places, weights and ids of the particles with these indices, in that order; nothing of what effects ask for.
Particles subset(const Particles& all, const std::vector<std::size_t>& chosen);

}  // namespace gaussdrift
