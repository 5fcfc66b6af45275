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

}  // namespace gaussdrift
