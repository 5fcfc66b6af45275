// Rigid rotation, counter-clockwise; in 3D about an axis parallel to z.
#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

class Rotation : public FormulaField<SolenoidalField> {
 public:
  explicit Rotation(const Arguments& arguments) : Rotation(point(arguments, "center"), number(arguments, "rate")) {}

  void add_gradient(double /*t*/, const PointsView& x, const GradientsView& g) const override {
    for (std::size_t j = 0; j < x.count; ++j) {
      g.slope[0][1][j] -= rate_;
      g.slope[1][0][j] += rate_;
    }
  }
  double cost() const override { return 0.1; }
  bool is_steady() const override { return true; }
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    const double angle = rate_ * (to - from), c = std::cos(angle), s = std::sin(angle);
    const double dx = x[0] - center_[0], dy = x[1] - center_[1];
    return Vector{center_[0] + c * dx - s * dy, center_[1] + s * dx + c * dy, x[2]};
  }

 private:
  Rotation(const Vector& center, double rate)
      : FormulaField(Formula::rotation, {center[0], center[1], rate}), center_(center), rate_(rate) {}

  Vector center_;
  double rate_;
};

}  // namespace

NamedField rotation() {
  return {.about = NamedFormula{.name = "rotation",
                                .meaning = "rigid rotation. One turn takes 2 pi / rate. In 3D its axis is along z",
                                .formula = "u = rate (-(y - center_y), x - center_x)",
                                .parameters = {center_parameter("centre of the rotation"),
                                               {.name = "rate",
                                                .fallback = "1",
                                                .unit = "radians / time",
                                                .symbol = "omega",
                                                .meaning = "angular velocity, counter-clockwise"}}},
          .divergence = "0",
          .exact_flow = "rotation about center by the angle rate (t - s)",
          .make = [](int, const Arguments& arguments) { return std::make_unique<Rotation>(arguments); }};
}

}  // namespace gaussdrift::named
