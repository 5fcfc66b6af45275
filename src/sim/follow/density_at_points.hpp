// The density and its derivatives at a few points anywhere, by the blobs that are felt there: the same bits for any
// number of ranks and threads.
#pragma once

#include <vector>

#include "base/communicator.hpp"
#include "gaussdrift/particles.hpp"
#include "particle/cutoff.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {

/// At points [j][dimension] of rank 0: for the density and each of options.derivatives a list of numbers, one a point, on
/// rank 0. The sums are without approximation, but for what is below rounding. particles: those of this rank, with
/// images. All ranks call it together.
std::vector<std::vector<double>> density_at_points(const Particles& particles, const Cutoff& cutoff,
                                                   const DensityOptions& options, const std::vector<double>& points,
                                                   base::Communicator& ranks);

}  // namespace gaussdrift
