// Vortices whose angular velocity depends on the distance from a centre alone.
#pragma once

#include <cmath>
#include <optional>

#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

/// Circles about `center`, in 3D about an axis parallel to z: u = omega(r) (-(y - c_y), x - c_x).
/// `Omega` is a function of r^2, finite at 0; Omega::slope is its derivative with respect to r^2. Its values at particles come
/// from a formula of formulas.hpp, whose parameters are center and those that omega.parameters() returns.
template <class Omega>
class CircularField : public FormulaField<SolenoidalField> {
 public:
  CircularField(Formula formula, const Vector& center, const Omega& omega)
      : FormulaField(formula, {center[0], center[1], omega.parameters()[0], omega.parameters()[1]}),
        center_(center),
        omega_(omega) {}

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

}  // namespace gaussdrift::named
