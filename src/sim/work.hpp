// The work of a run, counted, so that decisions that follow from it do not depend on the machine.
#pragma once

#include <cstddef>

#include "gaussdrift/case.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {

/// The work of a run. The unit is one evaluation of a velocity with a sine or two, some 40 ns of one core. It is
/// counted, not timed, so that decisions do not depend on the machine.
struct Work {
  double transport = 0, density = 0, pictures = 0;
  double total() const { return transport + density + pictures; }
};

Work work_of(const Case& spec, const Scene& scene, std::size_t particles);

/// The work of one evaluation of the velocity at all particles, with what they do to each other.
double work_of_rate(const Case& spec, const Scene& scene, std::size_t particles);

/// The work of one evaluation on an exact path, the integrator included.
double work_of_exact_rate(const Scene& scene);

}  // namespace gaussdrift
