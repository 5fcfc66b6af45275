/// @file
/// The particles of a run: positions X_j and weights alpha_j, one array per coordinate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// Particles, each the centre of a blob. All arrays have one number a particle.
struct Particles {
  int dimension = 2;                                        ///< 2 or 3
  std::array<std::vector<double>, max_dimension> position;  ///< X_j, one array per axis
  std::vector<double> alpha;                                ///< weights, masses: alpha_j = h^d rho_0(x_j) at the start
  std::vector<std::int64_t> id;  ///< index on the seeding lattice, first axis fastest; beyond it: released; constant

  // Only what the effects and outputs of a scene ask for; empty and 0 without them.
  std::vector<std::vector<double>> path;  ///< integrals along the paths, one array an integral, since they were settled
  std::vector<std::vector<double>> tracers{};  ///< weights of each named tracer, whose sum is alpha; empty: no names
  std::vector<double> volume;                  ///< v_j = h^d at the start, growing with div u
  /// What particles remember of their paths for outputs that ask for it, one array a quantity; 0 where they begin.
  std::vector<std::vector<double>> kept{};
  double spread = 0;  ///< what the square of every Gaussian width has grown by; of ellipses, along the longest axis

  /// Number of particles.
  std::size_t size() const { return alpha.size(); }

  /// Their positions, to read; valid as long as the arrays stay.
  PointsView view() const {
    PointsView points{dimension, size(), {}};
    for (int k = 0; k < dimension; ++k) points.axis[k] = position[k].data();
    return points;
  }
  /// Their positions, to write.
  VectorsView positions() {
    VectorsView points{dimension, size(), {}};
    for (int k = 0; k < dimension; ++k) points.axis[k] = position[k].data();
    return points;
  }
};

/// The points of the seeding lattice without a particle, for one of the things that particles carry.
struct LeftOut {
  double all = 0;       ///< sum of |weights| on all lattice points
  double left_out = 0;  ///< of those without a particle
  /// What is left out, of all.
  double part() const { return all > 0 ? left_out / all : 0; }
};

/// What has no particle; [Sch06, 5.3.4].
struct SeedReport {
  std::size_t left_out = 0;      ///< lattice points that have something and no particle
  std::vector<LeftOut> carried;  ///< mass first, then what effects carry besides
};

}  // namespace gaussdrift
