// Uniform wind.
#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

class Translation : public FormulaField<SolenoidalField> {
 public:
  Translation(int dimension, const Vector& velocity)
      : FormulaField(dimension == 3 ? Formula::translation_3d : Formula::translation,
                     {velocity[0], velocity[1], velocity[2]}),
        velocity_(velocity) {}

  void add_gradient(double /*t*/, const PointsView& /*x*/, const GradientsView& /*g*/) const override {}
  double cost() const override { return 0.1; }
  bool is_steady() const override { return true; }
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    Vector y = x;
    for (int k = 0; k < max_dimension; ++k) y[k] += velocity_[k] * (to - from);
    return y;
  }

 private:
  Vector velocity_;
};

}  // namespace

NamedField translation() {
  return {.about = NamedFormula{.name = "translation",
                                .meaning = "uniform wind",
                                .formula = "u = velocity",
                                .parameters = {{.name = "velocity",
                                                .kind = Kind::point,
                                                .unit = "length / time",
                                                .meaning = "the wind, the same everywhere"}}},
          .divergence = "0",
          .exact_flow = "x + velocity (t - s)",
          .make = [](int dimension, const Arguments& arguments) {
            return std::make_unique<Translation>(dimension, point(arguments, "velocity"));
          }};
}

}  // namespace gaussdrift::named
