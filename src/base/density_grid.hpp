// A density on the points of a lattice: what a run sums, files hold and pictures show.
#pragma once

#include <vector>

#include "base/lattice.hpp"

namespace gaussdrift {

/// rho_eps^h on the evaluation lattice, first axis fastest.
struct DensityGrid {
  Lattice lattice;
  std::vector<double> rho;
};

}  // namespace gaussdrift
