// Images of particles beyond the faces of a folded box (base/folding.hpp): the density in the box is the sum of the blobs
// of all copies of the particles that reach it.
#pragma once

#include <cstdint>
#include <vector>

#include "base/folding.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// The image in copy c of a particle has the id c * ids_of_copy + id. Ids of particles lie between -ids_of_copy / 2 and
/// ids_of_copy / 2.
constexpr std::int64_t ids_of_copy = std::int64_t{1} << 48;

constexpr bool is_image(std::int64_t id) { return id >= ids_of_copy / 2; }

/// Places, weights and ids of the particles, which lie in the box, followed by those of their images within `reach` of
/// it along every axis. Their ids ascend where they do in `particles`. `of`, if given, gets the particle that each of
/// them is or is an image of. Throws InputError where blobs reach over too many copies.
Particles with_images(const Particles& particles, const Folding& folding, double reach,
                      std::vector<std::size_t>* of = nullptr);

}  // namespace gaussdrift
