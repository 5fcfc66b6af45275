// The flow of Arnold, Beltrami and Childress: its own vorticity, chaotic paths.
#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

class Abc : public FormulaField<SolenoidalField> {
 public:
  explicit Abc(const Arguments& arguments)
      : FormulaField(Formula::abc, {number(arguments, "A"), number(arguments, "B"), number(arguments, "C"),
                                    2 * std::numbers::pi / number(arguments, "wavelength")}),
        a_(number(arguments, "A")),
        b_(number(arguments, "B")),
        c_(number(arguments, "C")),
        wave_(2 * std::numbers::pi / number(arguments, "wavelength")) {}

  void add_gradient(double /*t*/, const PointsView& x, const GradientsView& g) const override {
    for (std::size_t j = 0; j < x.count; ++j) {
      const double px = wave_ * x.axis[0][j], py = wave_ * x.axis[1][j], pz = wave_ * x.axis[2][j];
      g.slope[0][1][j] -= wave_ * c_ * std::sin(py);
      g.slope[0][2][j] += wave_ * a_ * std::cos(pz);
      g.slope[1][0][j] += wave_ * b_ * std::cos(px);
      g.slope[1][2][j] -= wave_ * a_ * std::sin(pz);
      g.slope[2][0][j] -= wave_ * b_ * std::sin(px);
      g.slope[2][1][j] += wave_ * c_ * std::cos(py);
    }
  }
  bool is_steady() const override { return true; }

 private:
  double a_, b_, c_, wave_;
};

}  // namespace

NamedField abc() {
  const auto strength = [](std::string_view name, std::string_view fallback) {
    return NamedParameter{.name = name, .fallback = fallback, .unit = "length / time", .meaning = "strength of a wave"};
  };
  return {
      .about = NamedFormula{.name = "abc",
                            .meaning = "the flow of Arnold, Beltrami and Childress",
                            .formula =
                                "with k = 2 pi / wavelength: u = (A sin kz + C cos ky, B sin kx + A cos kz, C sin ky + "
                                "B cos kx)",
                            .least_dimension = 3,
                            .parameters = {strength("A", "1.7320508075688772"),
                                           strength("B", "1.4142135623730951"),
                                           strength("C", "1"),
                                           {.name = "wavelength",
                                            .fallback = "6.283185307179586",
                                            .range = positive,
                                            .unit = "length",
                                            .meaning = "distance after which the flow repeats, on every axis"}}},
      .divergence = "0",
      .exact_flow = "not known: paths are chaotic",
      .make = [](int, const Arguments& arguments) { return std::make_unique<Abc>(arguments); }};
}

}  // namespace gaussdrift::named
