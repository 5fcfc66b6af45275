// Solid-body rotation of a sphere about any axis, in longitudes and latitudes [WDH92].
#include "base/sphere.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

// With the axis a and the place X, both unit vectors, and e, n the directions east and north at X: the velocity is
// rate a x X, so that dy/dt = rate a . (X x n) and cos y dx/dt = rate a . (X x e).
class SphereRotation : public NamedVelocityField {
 public:
  explicit SphereRotation(const Arguments& arguments)
      : axis_(on_unit_sphere(point(arguments, "pole")[0], point(arguments, "pole")[1])),
        rate_(number(arguments, "rate")) {}

  void add(double /*t*/, const PointsView& x, const VectorsView& u) const override {
    for (std::size_t i = 0; i < x.count; ++i) {
      const Angles at(x, i);
      u.axis[0][i] += degrees(rate_) * (axis_[2] - at.tangent * along(at));
      u.axis[1][i] += degrees(rate_) * across(at);
    }
  }
  void add_divergence(double /*t*/, const PointsView& x, double* values) const override {
    for (std::size_t i = 0; i < x.count; ++i) {
      const Angles at(x, i);
      values[i] += rate_ * at.tangent * across(at);
    }
  }
  void add_gradient(double /*t*/, const PointsView& x, const GradientsView& g) const override {
    for (std::size_t i = 0; i < x.count; ++i) {
      const Angles at(x, i);
      g.slope[0][0][i] += rate_ * at.tangent * across(at);
      g.slope[0][1][i] -= rate_ * (1 + at.tangent * at.tangent) * along(at);
      g.slope[1][0][i] += rate_ * along(at);
    }
  }
  bool is_steady() const override { return true; }
  double cost() const override { return 2; }
  // Rodrigues' formula; the longitude of the turn nearest to where it began.
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    const Vector& a = axis_;
    const Vector p = on_unit_sphere(x[0], x[1]);
    const double angle = rate_ * (to - from), c = std::cos(angle), s = std::sin(angle);
    const double part = (1 - c) * (a[0] * p[0] + a[1] * p[1] + a[2] * p[2]);
    Vector turned{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      turned[k] = c * p[k] + s * (a[l] * p[m] - a[m] * p[l]) + part * a[k];
    }
    Vector place = longitude_and_latitude(turned);
    place[0] = x[0] + std::remainder(place[0] - x[0], 360.0);
    return place;
  }

 private:
  struct Angles {
    Angles(const PointsView& x, std::size_t i)
        : c(std::cos(radians(x.axis[0][i]))),
          s(std::sin(radians(x.axis[0][i]))),
          tangent(std::tan(radians(x.axis[1][i]))) {}
    double c, s, tangent;
  };
  double along(const Angles& at) const { return axis_[0] * at.c + axis_[1] * at.s; }
  double across(const Angles& at) const { return axis_[0] * at.s - axis_[1] * at.c; }

  Vector axis_;
  double rate_;
};

}  // namespace

NamedField sphere_rotation() {
  return {
      .about = NamedFormula{.name = "sphere_rotation",
                            .meaning = "rigid rotation of a sphere, of places in degrees of longitude and latitude. "
                                       "One turn takes 2 pi / rate",
                            .formula = "dx/dt = rate (a_z - tan y (a_x cos x + a_y sin x)), dy/dt = rate (a_x sin "
                                       "x - a_y cos x), a the unit vector to the pole",
                            .most_dimension = 2,
                            .parameters = {{.name = "pole",
                                            .kind = Kind::point,
                                            .unit = "degrees",
                                            .meaning = "longitude and latitude of the pole about which it turns "
                                                       "counter-clockwise, seen from outside"},
                                           {.name = "rate",
                                            .fallback = "1",
                                            .unit = "radians / time",
                                            .symbol = "omega",
                                            .meaning = "angular velocity, counter-clockwise"}}},
      .divergence = "0 on the sphere",
      .exact_flow = "rotation about the pole by the angle rate (t - s)",
      .on_sphere = true,
      .make = [](int, const Arguments& arguments) { return std::make_unique<SphereRotation>(arguments); }};
}

}  // namespace gaussdrift::named
