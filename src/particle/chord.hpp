// Blobs on a sphere: functions of the chord, the straight line through the sphere between two places. The chord is a
// distance of space, so their sum is a Gauss transform of points in space. docs/method.md, section 18.
#pragma once

#include "gaussdrift/points.hpp"
#include "particle/cutoff.hpp"

namespace gaussdrift {

/// The point of space that has this longitude and latitude, in degrees, on a sphere about the origin.
Vector point_of_sphere(double radius, const Vector& place);

/// The radius of the sphere on which this cutoff lies; 0: on none.
double sphere_of(const Cutoff& cutoff);

/// A cutoff on a sphere as terms in space, of the same value for the same |x|. Throws std::logic_error for terms that do
/// not depend on |x| alone, for those there is no such function.
Cutoff in_space(const Cutoff& cutoff);

}  // namespace gaussdrift
