// Particles at the start: one on every lattice point that carries weight.
#pragma once

#include <functional>

#include "base/lattice.hpp"
#include "particle/particles.hpp"

namespace gaussdrift {

/// values[i] = rho_0(x_i).
using DensityFunction = std::function<void(const PointsView& x, double* values)>;

/// alpha_j = h^d rho_0(x_j) on all points x_j of the lattice; only those with alpha_j != 0 are carried [Sch06, 5.3.4].
/// Throws NumericalError naming the place where rho_0 is not finite.
Particles seed(const Lattice& lattice, const DensityFunction& rho_0, int threads);

/// The largest distance between particles that start on neighbouring lattice points, in lattice spacings: blobs of
/// width c h overlap as long as it is below c. Pairs that weigh less than a millionth of the heaviest particle do not
/// count. `particles` as seeded, in that order. O(number of particles).
double largest_stretch(const Particles& particles, const Lattice& lattice);

}  // namespace gaussdrift
