// Images of particles beyond the faces of a folded box (base/folding.hpp): the density in the box is the sum of the blobs
// of all copies of the particles that reach it.
#pragma once

#include <cstdint>

#include "base/folding.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// Places, weights and ids of the particles, which lie in the box, followed by those of their images within `reach` of
/// it along every axis. Images of copy c have ids c * ids + id, so that ids ascend where they do in `particles`; all ids
/// of particles are below `ids`. Throws InputError where blobs reach over too many copies.
Particles with_images(const Particles& particles, const Folding& folding, double reach, std::int64_t ids);

}  // namespace gaussdrift
