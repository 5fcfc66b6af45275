// The pieces of the evaluation lattice of a case.
#pragma once

#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice_pieces.hpp"

namespace gaussdrift {

/// One where the case has no domain yet.
LatticePieces pieces_of_grid(const Case& spec);

/// The points that a frame has and pictures show: all, or with several pieces every k-th.
Lattice shown_grid(const Case& spec);

}  // namespace gaussdrift
