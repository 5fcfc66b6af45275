// Particles at the start: one on every lattice point whose density or charge is large enough.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/folding.hpp"
#include "gaussdrift/lattice.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// values[i] = rho_0(x_i).
using DensityFunction = std::function<void(const PointsView& x, double* values)>;

/// What particles carry from the start: its density, and its name for people.
struct Carried {
  std::string name;
  DensityFunction density;
  bool is_tracer = false;  // its weights are kept, as a column of Particles::tracers
};

/// The weight of a lattice point is h^d times a density there; `carried.front()` gives alpha_j, but where there are tracers
/// alpha_j is the sum of theirs. A point has a particle
/// if one of its weights is not 0 and not below `threshold` times the largest weight of that kind [Sch06, 5.3.4].
/// Throws NumericalError naming the place where a density is not finite.
Particles seed(const Lattice& lattice, const std::vector<Carried>& carried, double threshold, int threads,
               SeedReport* report = nullptr);

/// The same on several ranks: each has the particles of every N-th line of the lattice, so that a small dense density is
/// spread over all of them. The report is that of all.
Particles seed(const Lattice& lattice, const std::vector<Carried>& carried, double threshold, int threads,
               SeedReport* report, base::Communicator& ranks);

/// One density, and every point where it is not 0.
Particles seed(const Lattice& lattice, const DensityFunction& rho_0, int threads);

/// The largest distance between particles that start on neighbouring lattice points, in lattice spacings: blobs of
/// width c h overlap as long as it is below c. Pairs that weigh less than a millionth of the heaviest particle do not
/// count. `particles` as seeded, in that order; those with ids beyond the lattice do not count. O(number of particles). Along a periodic axis the nearest images count.
double largest_stretch(const Particles& particles, const Lattice& lattice, const Folding& folding = {});

/// The same where particles are on several ranks, in the order of ids on each.
double largest_stretch(const Particles& particles, const Lattice& lattice, base::Communicator& ranks,
                       const Folding& folding = {});

}  // namespace gaussdrift
