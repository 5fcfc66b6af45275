// An initial density that is known at scattered points.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "field/density/density.hpp"
#include "field/samples/sample_fit.hpp"

namespace gaussdrift {

/// Every pair of a point and a sample is summed, so that a value depends on its point alone, whatever points are asked
/// for together: ranks that seed different parts of a lattice get the same bits.
/// domain_low, domain_high: the box whose mass is told.
std::unique_ptr<InitialDensity> make_sampled_density(std::shared_ptr<const SampleFit> fit, Outside outside,
                                                     const Vector& domain_low, const Vector& domain_high);

}  // namespace gaussdrift
