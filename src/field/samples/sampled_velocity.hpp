// A velocity that is known at scattered points.
#pragma once

#include <memory>
#include <string>

#include "field/samples/sample_fit.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// Derivatives are those of the fitted function. expected_targets: points that are evaluated at once, for the choice of
/// method only. Where a fast sum is quicker for so many, evaluates_in_blocks() is false: last digits then depend on
/// which points are evaluated together.
std::unique_ptr<VelocityField> make_sampled_velocity(std::shared_ptr<const SampleFit> fit, Outside outside,
                                                     std::size_t expected_targets);

}  // namespace gaussdrift
