// The velocity and the initial density that a case describes.
#pragma once

#include <memory>

#include "field/density/density.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift {

/// The sum of all [[velocity]]. The case must be valid, as `input` leaves it. threads: for fields that are evaluated
/// for all points at once; 0 for all.
std::unique_ptr<VelocityField> make_velocity(const Case& spec, int threads = 0);

/// The sum of all [[density]].
std::unique_ptr<InitialDensity> make_density(const Case& spec);

}  // namespace gaussdrift
