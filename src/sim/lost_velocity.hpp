// Why a path ends: the velocity is not known there, or a little farther on.
#pragma once

#include <string>

#include "field/velocity.hpp"

namespace gaussdrift {

/// What the field says of x, or of the place at the distance `ahead` (behind x if it is negative) along the velocity:
/// steps that follow their error become ever shorter before a border and never cross it. Empty where the field knows
/// of no reason.
std::string why_path_ends(const VelocityField& velocity, double t, int dimension, Vector x, double ahead);

}  // namespace gaussdrift
