// Rigid rotation, counter-clockwise; in 3D about an axis parallel to z.
#include <fmt/format.h>

#include <cmath>

#include "field/named_fields.hpp"

namespace gaussdrift::named {

namespace {

class Rotation : public VelocityField {
 public:
  Rotation(int dimension, const Arguments& arguments)
      : dimension_(dimension), center_(point(arguments, "center")), rate_(number(arguments, "rate")) {}

  void add(double /*t*/, const PointsView& x, const VectorsView& u) const override {
    const double rate = rate_, cx = center_[0], cy = center_[1];
    const double *px = x.axis[0], *py = x.axis[1];
    double *ux = u.axis[0], *uy = u.axis[1];
    for (std::size_t i = 0; i < x.count; ++i) {
      const double dx = px[i] - cx, dy = py[i] - cy;
      ux[i] -= rate * dy;
      uy[i] += rate * dx;
    }
  }

  bool is_solenoidal() const override { return true; }
  bool is_steady() const override { return true; }

  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    const double angle = rate_ * (to - from), c = std::cos(angle), s = std::sin(angle);
    const double dx = x[0] - center_[0], dy = x[1] - center_[1];
    return Vector{center_[0] + c * dx - s * dy, center_[1] + s * dx + c * dy, x[2]};
  }

  std::string describe() const override {
    const std::string about = dimension_ == 2 ? fmt::format("({}, {})", center_[0], center_[1])
                                              : fmt::format("the axis ({}, {}, z)", center_[0], center_[1]);
    return fmt::format("rotation about {}, {} rad a time unit, div u = 0", about, rate_);
  }

 private:
  int dimension_;
  Vector center_;
  double rate_;
};

}  // namespace

NamedField rotation() {
  using Kind = NamedParameter::Kind;
  return {{.name = "rotation",
           .meaning = "rigid rotation, counter-clockwise; one turn takes 2 pi / rate",
           .formula = "u = rate (-(y - center_y), x - center_x), and 0 along z",
           .parameters = {{.name = "center",
                           .kind = Kind::point,
                           .fallback = "origin",
                           .unit = "length",
                           .meaning = "centre of the rotation"},
                          {.name = "rate",
                           .fallback = "1",
                           .unit = "radians / time",
                           .symbol = "omega",
                           .meaning = "angular velocity, counter-clockwise"}}},
          "0",
          "rotation about center by the angle rate (t - s)",
          [](int dimension, const Arguments& arguments) { return std::make_unique<Rotation>(dimension, arguments); }};
}

}  // namespace gaussdrift::named
