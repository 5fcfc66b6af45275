// Particles of all ranks in the order of their ids, cut into pieces, so that no rank needs the memory of all particles.
// The pieces follow from the ids alone, never from where the particles are. docs/distributed.md.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/communicator.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// How many particles stand before each piece, if they are cut into so many pieces of nearly equal numbers.
std::vector<std::size_t> equal_pieces(std::size_t particles, std::size_t pieces);

/// The same if every piece but the last has `most`.
std::vector<std::size_t> full_pieces(std::size_t particles, std::size_t most);

/// Particles of all ranks together.
std::size_t particles_of_all(const Particles& particles, base::Communicator& ranks);

/// Particles with these indices, as pack() has them.
using PackChosen = std::function<base::Bytes(const std::vector<std::size_t>& chosen)>;
using ReceivePiece = std::function<void(std::size_t piece, Particles& particles)>;

/// Hands out the particles in pieces, neighbours to one rank: receive(piece, particles) on the rank that has it, by id.
/// before: of each piece. none: no particles, with the columns that are packed. A rank holds one piece at a time, beside
/// its own particles and those that are on their way. All ranks call it; what is thrown on one ends all of them.
void hand_out_by_id(const Particles& particles, const std::vector<std::size_t>& before, base::Communicator& ranks,
                    const Particles& none, const PackChosen& packed, const ReceivePiece& receive);

}  // namespace gaussdrift
