// What the interpolation of a velocity on a grid adds to the error of a run: shown by taking every second point, and every
// second time, of the data. method.md, section 10.
#pragma once

#include <vector>

#include "accuracy/probes.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/particles.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

/// Is a velocity interpolated, from data that are held?
bool interpolates_velocity(const Case& spec);

/// The largest change of the density at the probes that the lost points make, scaled by the order of the interpolation to
/// what the points that are there still miss. `start`: particles at the start; they are carried by steps of the case
/// times `factor`, once for each. NaN if some of them are lost.
double interpolation_error(const Case& spec, const Scene& scene, const Particles& start,
                           const std::vector<Probe>& probes, double factor, int threads);
/// By how many times the particles are carried for that.
int carryings_for_interpolation(const Case& spec);

}  // namespace gaussdrift::accuracy
