// A density whose grid is too large to be held as a whole: summed piece by piece, each on the rank that writes it.
// Pieces and their bits follow from the case alone. docs/distributed.md, docs/decisions/0028-pieces-are-boxes.md.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/communicator.hpp"
#include "gaussdrift/density_grid.hpp"
#include "gaussdrift/lattice_pieces.hpp"
#include "sim/tiled_density.hpp"

namespace gaussdrift {

/// What all pieces have come to.
struct PiecesSummary {
  DensityGrid thin;                 // every k-th point, on rank 0; the lattice everywhere
  double minimum = 0, maximum = 0;  // of all points
};

/// Gets the pieces of this rank.
struct PieceReceiver {
  std::function<void()> begin;  // all pieces come now; perhaps once more, for a finer tolerance
  /// The density at the points that the piece shows, first axis fastest, then each of the derivatives that the options
  /// ask for.
  std::function<void(std::size_t piece, std::vector<double>& values)> piece;
};

/// Sums the tiles, of which each lies in one piece, and hands the pieces out. A rank holds one piece at a time, and what
/// it shares with others: two layers for each piece. All ranks call it. What a receiver throws ends all of them.
PiecesSummary sum_pieces(const TileSources& sources, const Tiles& tiles, const std::vector<int>& owner,
                         const Cutoff& cutoff, const Lattice& lattice, const LatticePieces& pieces,
                         const DensityOptions& options, base::Communicator& ranks, const PieceReceiver& receiver,
                         DensityReport& report);

}  // namespace gaussdrift
