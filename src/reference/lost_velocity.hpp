// Why a path ends: the velocity is not known there, or a little farther on.
#pragma once

#include <string>

#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// The field's reason for having no velocity at x or at the distance `ahead` along the velocity (behind x if negative).
/// Steps that are chosen by their error become ever shorter before a border and never cross it, so x alone may be fine.
/// Empty if the field knows no reason.
std::string why_path_ends(const VelocityField& velocity, double t, int dimension, Vector x, double ahead);

}  // namespace gaussdrift
