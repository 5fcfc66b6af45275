// The times of an animation's frames, and where its densities are known.
#pragma once

#include <cstddef>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice.hpp"

namespace gaussdrift {

/// The elapsed times of the frames, ascending, from 0 to time.end; none without an animation. `landings`: the times on
/// which steps land without it. Where there are more steps than frames, frames lie on ends of steps, so that the steps
/// stay the same but for rounding.
std::vector<double> moments(const Case& spec, const std::vector<double>& landings);

/// Every k-th point of the grid of outputs: a frame shows no more along an axis than this has.
std::size_t thinning_of_moments(const Lattice& grid);
Lattice lattice_of_moments(const Lattice& grid);

/// The density needs no more digits than colours show.
double tolerance_of_moments(const Case& spec);

}  // namespace gaussdrift
