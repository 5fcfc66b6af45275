/// @file
/// A density on the points of a lattice: what a run sums, files hold and pictures show.
#pragma once

#include <vector>

#include "gaussdrift/lattice.hpp"

namespace gaussdrift {

/// rho_eps^h on the evaluation lattice.
struct DensityGrid {
  Lattice lattice;          ///< its points
  std::vector<double> rho;  ///< at each of them, first axis fastest; mass / length^dimension
};

}  // namespace gaussdrift
