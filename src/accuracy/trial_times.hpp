// How long the parts of a run take, found by trying a little of each on one thread.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "accuracy/footprint.hpp"
#include "accuracy/trial.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/simulation.hpp"
#include "sim/comparison.hpp"

namespace gaussdrift::accuracy {

/// Seconds on `threads` threads of work that takes `seconds` on one. `serial` is the share that is not divided.
double shared(double seconds, int threads, double serial);
constexpr double serial_steps = 0.05, serial_sum = 0.15, serial_drifts = 0.15;

using Columns = std::array<std::vector<double>, max_dimension>;

/// At most so many of the particles, evenly spread over the list.
Particles sample_of(const Particles& all, std::size_t most);

/// The number of particles that fits into the work of a few steps.
std::size_t particles_for_steps(const Case& spec, const Scene& scene, std::size_t particles);

/// Seconds of one step on one thread, from a few steps of a copy that is thrown away.
double time_steps(const Case& spec, const Scene& scene, const Particles& particles);

/// The same for particles that move each other: sums over all of them, which grow dearer as their blobs spread. A few
/// sums at the start, in the middle and at the end of the run, by Simpson's rule.
double time_drifts(const Case& spec, const Scene& scene, const Particles& particles);

/// What effects that replace particles take and do to the number of particles over the run, from fewer particles that
/// take all its steps, or as many as an amount of work allows.
struct Growth {
  double seconds = 0;         // of a step, for each particle at the start
  double between_steps = 0;   // part of it that is neither the flow's nor the drifts'
  double mean = 1, most = 1;  // numbers of particles to that at the start
};
Growth grow(const Case& spec, Trial& trial);

/// All particles, with those that an effect puts around them before the first step. They lie like a surface. halo: how
/// many there are around a sample of particles, each of which stands for `each`.
inline double with_halo(double carried, double halo, double each, int dimension) {
  return carried + halo * std::pow(each, 1 - 1 / static_cast<double>(dimension));
}

/// Steps that a method will choose, and seconds a step on one thread, from a trial that stops after an amount of work
/// and is extrapolated.
struct ChosenSteps {
  double steps = 0, seconds = 0;
};
ChosenSteps try_chosen_steps(const Case& spec, const Scene& scene, const Particles& particles);

/// Seconds of the reference of all outputs, from the paths of some grid points over as much of the run as an amount of
/// work allows. `traced` grows by the evaluations of the velocity at one point.
double time_reference(const Case& spec, const Scene& scene, const Comparison& compared, int threads, double& traced);

/// Seconds of the files of all outputs. Making a file as text in memory is timed with a small one. Writing it to the
/// disk is taken at a usual speed.
double time_files(const Case& spec, const Trial& trial, const Extent& extent);

}  // namespace gaussdrift::accuracy
