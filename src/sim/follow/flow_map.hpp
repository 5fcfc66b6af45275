// The flow map of a run: where the points of the particle lattice have gone, and how neighbours have parted.
// docs/method.md, section 16.
#pragma once

#include <cstddef>
#include <vector>

#include "base/folding.hpp"
#include "gaussdrift/lattice.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// dX_i / dx_k of each particle, [j][i][k]: differences of the positions of its two neighbours on the lattice along axis
/// k, or of itself and the one that is there. NaN for a particle with no neighbour along an axis, and for one that did
/// not begin on the lattice. Ids ascend. Across periodic axes two particles are as near as they can be.
std::vector<double> flow_map_gradients(const Particles& particles, const Lattice& lattice, const Folding& folding,
                                       int threads);

/// ln(s) / |t|, s the largest singular value of each gradient: the finite-time Lyapunov exponent over a time t.
std::vector<double> lyapunov_exponents(const std::vector<double>& gradients, int dimension, double t, int threads);

}  // namespace gaussdrift
