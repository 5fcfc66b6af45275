// Particles of other lattices than that of the run: at their start, half a spacing aside, and every so many alone. Sums
// over them tell the error of the lattice from that of the blobs and of the steps.
#pragma once

#include <cstddef>
#include <vector>

#include "gaussdrift/case.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

/// The lattice points of some particles, with their weights at the start.
Particles at_start(const Particles& particles, const std::vector<std::size_t>& chosen, const Scene& scene);

/// The same blobs half a spacing aside on every axis: one in each cell of the lattice that has one of `start` at a
/// corner. Outside the lattice neither density nor velocity need be defined, but for cells that an edge of the domain
/// shares out: one that reaches over a periodic edge, and those in the middle of which there is a closed one. A blob of
/// these meets its image there, so it has half of the weight.
Particles between(const Particles& start, const Scene& scene, const Domain& domain);

/// Every `stride`-th lattice point on each axis, weights scaled.
Particles thinned(const Particles& particles, const Lattice& lattice, std::size_t stride);

}  // namespace gaussdrift::accuracy
