// Which rank has which tile, and particles on their way there.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "gaussdrift/particles.hpp"
#include "particle/tiles.hpp"

namespace gaussdrift {

/// The rank of each tile: the list is cut where the work reaches the parts of the ranks, so that neighbours stay
/// together. Only how many tiles there are limits how evenly.
std::vector<int> share_tiles(const std::vector<double>& work, int ranks);

/// Moves every particle to the owner of its tile. Afterwards ids ascend on each rank.
void place_particles(Particles& particles, const Tiles& tiles, const std::vector<int>& owner,
                     base::Communicator& ranks);

/// Positions, weights and ids of the particles of other ranks that are felt in the tiles of this one; ids ascend.
Particles felt_from_elsewhere(const Particles& particles, const Tiles& tiles, const std::vector<int>& owner,
                              base::Communicator& ranks);

/// All particles, by id, on rank 0; elsewhere none.
Particles gather_particles(const Particles& particles, base::Communicator& ranks);

/// The columns of some particles as bytes, and back: unpack() appends.
base::Bytes pack(const Particles& particles, const std::vector<std::size_t>& chosen);
/// Positions, weights and ids alone.
base::Bytes pack_bare(const Particles& particles, const std::vector<std::size_t>& chosen);
void unpack(std::span<const std::byte> bytes, Particles& particles);

/// Orders all columns by id.
void sort_by_id(Particles& particles);

}  // namespace gaussdrift
