// The particles of a run: positions X_j and weights alpha_j, one array per coordinate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/points.hpp"

namespace gaussdrift {

struct Particles {
  int dimension = 2;
  std::array<std::vector<double>, max_dimension> position;  // X_j, one array per axis
  std::vector<double> alpha;                                // alpha_j = h^d rho_0(x_j) at the start
  std::vector<std::int64_t> id;  // index on the seeding lattice, first axis fastest; constant

  // Only what the effects of a scene ask for; empty and 0 without them.
  std::vector<std::vector<double>> path;  // integrals along the paths, one array an integral, since they were settled
  std::vector<double> volume;             // v_j = h^d at the start, growing with div u
  double spread = 0;                      // what the square of every Gaussian width of the blobs has grown by

  std::size_t size() const { return alpha.size(); }

  PointsView view() const {
    PointsView points{dimension, size(), {}};
    for (int k = 0; k < dimension; ++k) points.axis[k] = position[k].data();
    return points;
  }
  VectorsView positions() {
    VectorsView points{dimension, size(), {}};
    for (int k = 0; k < dimension; ++k) points.axis[k] = position[k].data();
    return points;
  }
};

}  // namespace gaussdrift
