// Helpers that the named fields share.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "field/named/named_fields.hpp"

namespace gaussdrift::named {

using Kind = NamedParameter::Kind;

/// A steady or unsteady field with div u = 0.
class SolenoidalField : public NamedVelocityField {
 public:
  void add_divergence(double /*t*/, const PointsView& /*x*/, double* /*values*/) const override {}
  bool is_solenoidal() const override { return true; }
};

/// (1 - exp(-s)) / s for s >= 0, 1 at s = 0: the angular velocity of a Gaussian vortex relative to that at its centre.
inline double gaussian_swirl(double s) { return s == 0 ? 1.0 : -std::expm1(-s) / s; }

/// The derivative of gaussian_swirl: (exp(-s) (1 + s) - 1) / s^2, -1/2 at s = 0.
inline double gaussian_swirl_slope(double s) {
  if (s > 1) return (std::exp(-s) * (1 + s) - 1) / (s * s);
  double sum = 0, power = 1;  // -sum_n n (-s)^(n-1) / (n+1)!, where the formula cancels
  for (int n = 1; n <= 18; ++n) {
    power /= n + 1;
    sum -= n * power;
    power *= -s;
  }
  return sum;
}

/// Adds at point j the gradient of u = omega(r^2) (-dy, dx), from omega and its derivative with respect to r^2.
inline void add_circular_gradient(double omega, double slope, double dx, double dy, const GradientsView& g,
                                  std::size_t j) {
  g.slope[0][0][j] -= 2 * slope * dx * dy;
  g.slope[0][1][j] -= omega + 2 * slope * dy * dy;
  g.slope[1][0][j] += omega + 2 * slope * dx * dx;
  g.slope[1][1][j] += 2 * slope * dx * dy;
}

inline NamedParameter center_parameter(std::string_view meaning) {
  return {.name = "center", .kind = Kind::point, .fallback = "origin", .unit = "length", .meaning = meaning};
}

/// The corners of the box that a field is scaled to.
inline NamedParameter min_parameter() {
  return {.name = "min",
          .kind = Kind::point,
          .fallback = "domain.min",
          .unit = "length",
          .meaning = "lower corner of the box that the flow fills"};
}
inline NamedParameter max_parameter() {
  return {.name = "max",
          .kind = Kind::point,
          .fallback = "domain.max",
          .unit = "length",
          .meaning = "upper corner of that box"};
}
inline NamedParameter period_parameter() {
  return {.name = "period",
          .fallback = "none",
          .range = positive,
          .unit = "time",
          .symbol = "T",
          .meaning = "the flow reverses at T/2 and has undone itself at T; without it the flow is steady"};
}

inline std::string empty_box(int dimension, const Arguments& arguments) {
  const auto min = point(arguments, "min"), max = point(arguments, "max");
  for (int k = 0; k < dimension; ++k)
    if (!(min[k] < max[k])) return std::string("the box is empty along ") + "xyz"[k] + ": min must be less than max";
  return "";
}

/// xi = (x - min) / length: the unit cube.
struct Scaling {
  Vector min, length{};

  explicit Scaling(const Arguments& arguments) : min(point(arguments, "min")) {
    const auto max = point(arguments, "max");
    for (int k = 0; k < max_dimension; ++k) length[k] = max[k] - min[k];
  }
  double unit(int axis, double x) const { return (x - min[axis]) / length[axis]; }
  /// As formulas.hpp takes them, and what follows.
  std::vector<double> parameters(const std::vector<double>& more = {}) const {
    std::vector<double> all{min[0], min[1], min[2], length[0], length[1], length[2]};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

/// g(t) = cos(pi t / T): a flow that runs back along its own paths.
struct Reversal {
  double period;  // infinite: g = 1

  double factor(double t) const { return std::cos(std::numbers::pi * (t / period)); }
  bool is_steady() const { return std::isinf(period); }
  /// Is the integral of g over the time between 0, to rounding? Then everything is back.
  bool is_undone(double from, double to) const {
    if (is_steady()) return from == to;
    const double a = std::numbers::pi * (from / period), b = std::numbers::pi * (to / period);
    return std::abs(std::sin(b) - std::sin(a)) <=
           4e-16 * (1 + std::abs(a) + std::abs(b));  // roundings of sin and its angle
  }
};

}  // namespace gaussdrift::named
