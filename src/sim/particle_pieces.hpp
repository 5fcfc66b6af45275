// Particles in pieces, for files of which none needs the memory of all particles. The pieces follow from the ids alone,
// never from where the particles are. docs/distributed.md.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/communicator.hpp"
#include "gaussdrift/frame.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// How many pieces so many particles have, if none is to have more than `most`.
std::size_t pieces_of_particles(std::size_t count, double most);

/// Hands out the particles of all ranks in the order of their ids, cut into pieces of nearly equal numbers, neighbours to
/// one rank: receive(piece) on the rank that has it. A rank holds one piece at a time. velocity: [j][dimension], of the
/// particles of this rank, and so are the fields. All ranks call it; what a receiver throws ends all of them.
void hand_out_particles(const Particles& particles, const std::vector<double>& velocity,
                        const std::vector<FieldOnGrid>& fields, std::size_t pieces, base::Communicator& ranks,
                        const std::function<void(const ParticlePiece&)>& receive);

}  // namespace gaussdrift
