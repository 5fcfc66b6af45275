// What values of a velocity take, so that work along paths can be handed to threads before the first piece is done.
#pragma once

#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// Roughly: 20 ns for a formula with a sine or two.
inline double value_seconds(const VelocityField& velocity) { return 2e-8 * velocity.cost(); }

}  // namespace gaussdrift
