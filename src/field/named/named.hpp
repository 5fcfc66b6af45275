// Helpers that the named fields share.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

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

/// Circles about `center`, in 3D about an axis parallel to z: u = omega(r) (-(y - c_y), x - c_x).
/// `Omega` is a function of r^2, finite at 0; Omega::slope is its derivative with respect to r^2.
template <class Omega>
class CircularField : public SolenoidalField {
 public:
  CircularField(const Vector& center, const Omega& omega) : center_(center), omega_(omega) {}

  void add(double /*t*/, const PointsView& x, const VectorsView& u) const override {
    for (std::size_t i = 0; i < x.count; ++i) {
      const double dx = x.axis[0][i] - center_[0], dy = x.axis[1][i] - center_[1];
      const double omega = omega_(dx * dx + dy * dy);
      u.axis[0][i] -= omega * dy;
      u.axis[1][i] += omega * dx;
    }
  }
  void add_gradient(double /*t*/, const PointsView& x, const GradientsView& g) const override {
    for (std::size_t j = 0; j < x.count; ++j) {
      const double dx = x.axis[0][j] - center_[0], dy = x.axis[1][j] - center_[1], square = dx * dx + dy * dy;
      add_circular_gradient(omega_(square), omega_.slope(square), dx, dy, g, j);
    }
  }
  bool is_steady() const override { return true; }
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    const double dx = x[0] - center_[0], dy = x[1] - center_[1];
    const double angle = omega_(dx * dx + dy * dy) * (to - from), c = std::cos(angle), s = std::sin(angle);
    return Vector{center_[0] + c * dx - s * dy, center_[1] + s * dx + c * dy, x[2]};
  }

 private:
  Vector center_;
  Omega omega_;
};

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
