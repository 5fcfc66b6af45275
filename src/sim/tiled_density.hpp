// The density of a large case, tile by tile: each tile is a sum of its own over the particles that reach it, so that
// memory stays bounded and processes may share the tiles. What comes out follows from tiles and particles alone.
// docs/distributed.md.
#pragma once

#include <cstddef>
#include <vector>

#include "base/communicator.hpp"
#include "gaussdrift/lattice.hpp"
#include "gaussdrift/particles.hpp"
#include "particle/cutoff.hpp"
#include "particle/tiles.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {

/// How far a blob is felt: what lies beyond is below the rounding of its largest value.
double reach_of_blob(const Cutoff& cutoff);

/// The particles that a process needs for its tiles.
struct TileSources {
  const Particles& own;   // in its tiles
  const Particles& felt;  // those of other processes, whose blobs reach its tiles; ids ascend in either
};

/// What one tile has come to.
struct TileDensity {
  std::size_t tile = 0;
  std::vector<double> rho;  // on its grid points, first axis fastest
};

/// The densities of the tiles of this process, `owned[tile]`. All processes call it, and get the same report but for its
/// seconds. Throws InputError as evaluate_density() does, on this process alone.
std::vector<TileDensity> evaluate_tiles(const TileSources& sources, const Tiles& tiles, const std::vector<char>& owned,
                                        const Cutoff& cutoff, const Lattice& lattice, const DensityOptions& options,
                                        base::Communicator& ranks, DensityReport& report);

/// Puts the values of a tile where they belong on the lattice.
void place(const std::vector<double>& rho, const Tile& tile, const Lattice& lattice, std::vector<double>& whole);

/// The work of evaluate_tiles() on one process, predicted and not done.
DensityWork predict_tiles(const Particles& particles, const Tiles& tiles, const Cutoff& cutoff, const Lattice& lattice,
                          const DensityOptions& options);

}  // namespace gaussdrift
