// Plane shear: layers that slide over each other along x.
#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

class Shear : public FormulaField<SolenoidalField> {
 public:
  explicit Shear(const Arguments& arguments)
      : FormulaField(Formula::shear, {point(arguments, "center")[1], number(arguments, "rate")}),
        middle_(point(arguments, "center")[1]),
        rate_(number(arguments, "rate")) {}

  void add_gradient(double /*t*/, const PointsView& x, const GradientsView& g) const override {
    for (std::size_t j = 0; j < x.count; ++j) g.slope[0][1][j] += rate_;
  }
  double cost() const override { return 0.1; }
  bool is_steady() const override { return true; }
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    return Vector{x[0] + rate_ * (x[1] - middle_) * (to - from), x[1], x[2]};
  }

 private:
  double middle_, rate_;
};

}  // namespace

NamedField shear() {
  return {.about = NamedFormula{.name = "shear",
                                .meaning = "plane shear along x",
                                .formula = "u = (rate (y - center_y), 0)",
                                .parameters = {center_parameter("a point of the layer at rest"),
                                               {.name = "rate",
                                                .fallback = "1",
                                                .unit = "1 / time",
                                                .symbol = "gamma",
                                                .meaning = "shear rate du/dy"}}},
          .divergence = "0",
          .exact_flow = "(x + rate (y - center_y) (t - s), y)",
          .make = [](int, const Arguments& arguments) { return std::make_unique<Shear>(arguments); }};
}

}  // namespace gaussdrift::named
