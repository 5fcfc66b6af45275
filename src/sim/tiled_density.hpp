// The density of a large case, tile by tile: each tile is a sum of its own over the particles that reach it, so that
// memory stays bounded and processes may share the tiles. What comes out follows from tiles and particles alone.
// docs/distributed.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "gaussdrift/density_grid.hpp"
#include "gaussdrift/lattice.hpp"
#include "gaussdrift/particles.hpp"
#include "particle/cutoff.hpp"
#include "particle/tiles.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {

/// How far a blob is felt: what lies beyond is below the rounding of its largest value.
/// Its derivatives, where options ask for any, are felt a little farther. On a sphere it is a chord.
double reach_of_blob(const Cutoff& cutoff, const DensityOptions& options);

/// The particles that a process needs for its tiles.
struct TileSources {
  const Particles& own;   // in its tiles
  const Particles& felt;  // those of other processes, whose blobs reach its tiles; ids ascend in either
};

/// A particle where the density is probably large.
struct Candidate {
  double weight = 0;
  std::int64_t id = 0;
  bool operator<(const Candidate& other) const {
    return weight != other.weight ? weight > other.weight : id < other.id;
  }
};

/// The sums of the tiles of this process, one by one.
class TileSums {
 public:
  virtual ~TileSums() = default;
  /// The largest at some promising particles: lower bounds of the maxima.
  virtual OfQuantities lower_bounds_of_maxima(const std::vector<Candidate>& heaviest) const = 0;
  /// From now on sums are right to options.tolerance * maxima.
  virtual void begin(const OfQuantities& maxima, DensityReport& report) = 0;
  /// The density at some grid points of a tile, first axis fastest, then its derivatives one after another. main: they are all of the tile, or nearly. Else they
  /// are a thin part of it, and only particles within reach of that are taken.
  virtual std::vector<double> sum(std::size_t tile, const LatticeBox& where, bool main, DensityReport& report) = 0;

  virtual const OfQuantities& largest() const = 0;  // in all sums since begin()
  virtual const OfQuantities& errors() const = 0;   // on a sample of the grid
  virtual std::int64_t sample() const = 0;
  /// What fgtd chose for the fullest tile, if this process has it.
  virtual const std::string& choice_of_fullest() const = 0;
};

/// Calls sum_all, which is to sum all tiles of this process and to agree on how it went. Where the density turns out to
/// be much smaller than expected, it is called once more for a finer tolerance. All processes call it, and get the same
/// report but for its seconds. Throws InputError as evaluate_density() does, on this process alone.
void sum_by_tiles(const TileSources& sources, const Tiles& tiles, const std::vector<char>& owned, const Cutoff& cutoff,
                  const Lattice& lattice, const DensityOptions& options, base::Communicator& ranks,
                  const std::function<void(TileSums&)>& sum_all, DensityReport& report);

/// What one tile has come to.
struct TileDensity {
  std::size_t tile = 0;
  std::vector<double> values;  // the density on its grid points, first axis fastest, then its derivatives
};

/// The densities of the tiles of this process, `owned[tile]`. All processes call it, and get the same report but for its
/// seconds. Throws InputError as evaluate_density() does, on this process alone.
std::vector<TileDensity> evaluate_tiles(const TileSources& sources, const Tiles& tiles, const std::vector<char>& owned,
                                        const Cutoff& cutoff, const Lattice& lattice, const DensityOptions& options,
                                        base::Communicator& ranks, DensityReport& report);

/// Puts the values of a tile where they belong: the density, and `derivatives` of as many points.
void place(std::span<const double> values, const Tile& tile, DensityGrid& whole,
           std::vector<std::vector<double>>& derivatives);

/// The work of evaluate_tiles() on one process, predicted and not done.
DensityWork predict_tiles(const Particles& particles, const Tiles& tiles, const Cutoff& cutoff, const Lattice& lattice,
                          const DensityOptions& options);

}  // namespace gaussdrift
