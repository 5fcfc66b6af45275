// Places on a sphere: longitudes and latitudes in degrees, unit vectors, and distances between them. docs/method.md,
// section 18.
#pragma once

#include <cmath>
#include <numbers>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

constexpr double radians(double degrees) { return degrees * (std::numbers::pi / 180); }
constexpr double degrees(double radians) { return radians * (180 / std::numbers::pi); }

/// The Earth's mean radius [Mor00], in metres.
constexpr double earth_radius = 6371000;

/// The point of the unit sphere with this longitude and latitude, in degrees.
inline Vector on_unit_sphere(double longitude, double latitude) {
  const double lambda = radians(longitude), phi = radians(latitude), c = std::cos(phi);
  return {c * std::cos(lambda), c * std::sin(lambda), std::sin(phi)};
}

/// Longitude in [-180, 180] and latitude, in degrees, of a vector that is not 0.
inline Vector longitude_and_latitude(const Vector& x) {
  return {degrees(std::atan2(x[1], x[0])), degrees(std::atan2(x[2], std::hypot(x[0], x[1]))), 0};
}

/// The angle between two places, in radians: the length of the great circle on the unit sphere. Accurate for small ones.
inline double angle_between(const Vector& a, const Vector& b) {
  const double dlambda = radians(b[0] - a[0]), dphi = radians(b[1] - a[1]);
  const double s = std::sin(dphi / 2), t = std::sin(dlambda / 2);
  const double square = s * s + std::cos(radians(a[1])) * std::cos(radians(b[1])) * t * t;  // of half the chord
  return 2 * std::atan2(std::sqrt(square), std::sqrt(std::fmax(0, 1 - square)));
}

}  // namespace gaussdrift
