// Stretching along the axes: plane strain, expansion, collapse.
#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

class Strain : public FormulaField<NamedVelocityField> {
 public:
  Strain(int dimension, const Vector& center, const Vector& rates)
      : FormulaField(dimension == 3 ? Formula::strain_3d : Formula::strain,
                     {center[0], center[1], center[2], rates[0], rates[1], rates[2]}),
        center_(center),
        rates_(rates) {}

  void add_divergence(double /*t*/, const PointsView& x, double* values) const override {
    for (std::size_t i = 0; i < x.count; ++i) values[i] += divergence();
  }
  void add_gradient(double /*t*/, const PointsView& x, const GradientsView& g) const override {
    for (int k = 0; k < x.dimension; ++k)
      for (std::size_t j = 0; j < x.count; ++j) g.slope[k][k][j] += rates_[k];
  }
  double cost() const override { return 0.1; }
  bool is_solenoidal() const override { return divergence() == 0; }
  bool is_steady() const override { return true; }
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    Vector y{};
    for (int k = 0; k < max_dimension; ++k) y[k] = center_[k] + (x[k] - center_[k]) * std::exp(rates_[k] * (to - from));
    return y;
  }

 private:
  double divergence() const { return rates_[0] + rates_[1] + rates_[2]; }

  Vector center_, rates_;
};

}  // namespace

NamedField strain() {
  return {.about = NamedFormula{.name = "strain",
                                .meaning = "stretching along the axes: [1, -1] is plane strain, [1, 1] an expansion",
                                .formula = "u_k = rates_k (x_k - center_k)",
                                .parameters = {center_parameter("the point at rest"),
                                               {.name = "rates",
                                                .kind = Kind::point,
                                                .unit = "1 / time",
                                                .meaning = "rate of stretching along each axis"}}},
          .divergence = "the sum of the rates",
          .exact_flow = "center_k + (x_k - center_k) exp(rates_k (t - s))",
          .make = [](int dimension, const Arguments& arguments) {
            return std::make_unique<Strain>(dimension, point(arguments, "center"), point(arguments, "rates"));
          }};
}

}  // namespace gaussdrift::named
