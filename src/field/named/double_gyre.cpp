// The double gyre of Shadden, Lekien and Marsden 2005: two vortices whose border sways.
#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

class DoubleGyre : public FormulaField<SolenoidalField> {
 public:
  explicit DoubleGyre(const Arguments& arguments)
      : FormulaField(Formula::double_gyre, Scaling(arguments).parameters({number(arguments, "amplitude")})),
        box_(arguments),
        amplitude_(number(arguments, "amplitude")),
        sway_(number(arguments, "sway")),
        period_(number(arguments, "period")) {}

  std::size_t time_values() const override { return 2; }
  void at_time(double t, double* values) const override {
    values[0] = sway_ * std::sin(2 * std::numbers::pi * (t / period_));
    values[1] = 1 - 2 * values[0];
  }
  void add_gradient(double t, const PointsView& x, const GradientsView& g) const override {
    const double pi = std::numbers::pi, a = sway_ * std::sin(2 * pi * (t / period_)), b = 1 - 2 * a;
    const double scale = pi * pi * amplitude_, across = 2 / box_.length[0],
                 up = 1 / box_.length[1];  // d xi/dx, d eta/dy
    for (std::size_t j = 0; j < x.count; ++j) {
      const double xi = 2 * box_.unit(0, x.axis[0][j]), eta = box_.unit(1, x.axis[1][j]);
      const double f = (a * xi + b) * xi, slope = 2 * a * xi + b;
      const double sf = std::sin(pi * f), cf = std::cos(pi * f), se = std::sin(pi * eta), ce = std::cos(pi * eta);
      g.slope[0][0][j] -= scale * cf * slope * ce;
      g.slope[0][1][j] += scale * up / across * sf * se;
      g.slope[1][0][j] += scale * across / up * se * (2 * a / pi * cf - slope * slope * sf);
      g.slope[1][1][j] += scale * cf * ce * slope;
    }
  }
  bool is_steady() const override { return sway_ == 0; }

 private:
  Scaling box_;
  double amplitude_, sway_, period_;
};

}  // namespace

NamedField double_gyre() {
  return {
      .about =
          NamedFormula{
              .name = "double_gyre",
              .meaning = "two vortices side by side, whose border sways [SLM05]. The usual domain is [0, 2] x [0, 1]",
              .formula = "with xi = 0 ... 2, eta = 0 ... 1 across the box and f = a xi^2 + (1 - 2 a) xi, "
                         "a = sway sin(2 pi t / period): u = pi amplitude (-L_x/2 sin(pi f) cos(pi eta), "
                         "L_y cos(pi f) sin(pi eta) df/dxi)",
              .parameters = {min_parameter(),
                             max_parameter(),
                             {.name = "amplitude",
                              .fallback = "0.1",
                              .unit = "1 / time",
                              .symbol = "A",
                              .meaning = "strength of the vortices"},
                             {.name = "sway",
                              .fallback = "0.25",
                              .symbol = "eps",
                              .meaning = "how far the border sways; 0 makes the flow steady"},
                             {.name = "period",
                              .fallback = "10",
                              .range = positive,
                              .unit = "time",
                              .symbol = "2 pi / omega",
                              .meaning = "time in which the border sways to and fro once"}},
              .problem = empty_box},
      .divergence = "0",
      .exact_flow = "not known: paths are chaotic",
      .make = [](int, const Arguments& arguments) { return std::make_unique<DoubleGyre>(arguments); }};
}

}  // namespace gaussdrift::named
