// The vortex of Burgers 1948: drawn in from the sides, stretched along z, kept steady by viscosity.
#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

/// u_r = -alpha r / 2, u_z = alpha z, u_theta = Gamma / (2 pi r) (1 - exp(-s)), s = alpha r^2 / (4 nu).
class Burgers : public FormulaField<SolenoidalField> {
 public:
  explicit Burgers(const Arguments& arguments)
      : Burgers(point(arguments, "center"), number(arguments, "strain"),
                number(arguments, "strain") / (4 * number(arguments, "viscosity")), number(arguments, "circulation")) {}

  void add_gradient(double /*t*/, const PointsView& x, const GradientsView& g) const override {
    for (std::size_t j = 0; j < x.count; ++j) {
      const double dx = x.axis[0][j] - center_[0], dy = x.axis[1][j] - center_[1], s = quarter_ * (dx * dx + dy * dy);
      add_circular_gradient(omega_ * gaussian_swirl(s), omega_ * quarter_ * gaussian_swirl_slope(s), dx, dy, g, j);
      g.slope[0][0][j] -= strain_ / 2;
      g.slope[1][1][j] -= strain_ / 2;
      g.slope[2][2][j] += strain_;
    }
  }
  bool is_steady() const override { return true; }

  // d theta / ds = -omega_ / strain (1 - exp(-s)) / s^2 along a path, whose integral is H(s) = (1 - exp(-s)) / s +
  // E1(s).
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    const double dx = x[0] - center_[0], dy = x[1] - center_[1], shrink = std::exp(-strain_ / 2 * (to - from));
    const double before = quarter_ * (dx * dx + dy * dy), after = before * shrink * shrink;
    const double angle = before < 1e-300 || after < 1e-300  // on the axis: omega is constant
                             ? omega_ * (to - from)
                             : omega_ / strain_ * (winding(after) - winding(before));
    const double c = shrink * std::cos(angle), s = shrink * std::sin(angle);
    return Vector{center_[0] + c * dx - s * dy, center_[1] + s * dx + c * dy,
                  center_[2] + (x[2] - center_[2]) * std::exp(strain_ * (to - from))};
  }

 private:
  Burgers(const Vector& center, double strain, double quarter, double circulation)
      : FormulaField(Formula::burgers, {center[0], center[1], center[2], strain, quarter,
                                        circulation * quarter / (2 * std::numbers::pi)}),
        center_(center),
        strain_(strain),
        quarter_(quarter),
        omega_(circulation * quarter / (2 * std::numbers::pi)) {}
  static double winding(double s) { return gaussian_swirl(s) + (s > 700 ? 0.0 : -std::expint(-s)); }  // E1 < 1e-306

  Vector center_;
  double strain_, quarter_, omega_;
};

}  // namespace

NamedField burgers() {
  return {.about =
              NamedFormula{.name = "burgers",
                           .meaning = "a vortex along z. The flow draws it in from the sides and stretches it [Bur48]",
                           .formula =
                               "with r the distance from the axis through center: u_r = -strain r / 2, u_z = strain (z "
                               "- center_z), u_theta = circulation / (2 pi r) (1 - exp(-strain r^2 / (4 viscosity)))",
                           .least_dimension = 3,
                           .parameters = {center_parameter("the point at rest"),
                                          {.name = "strain",
                                           .fallback = "1",
                                           .range = positive,
                                           .unit = "1 / time",
                                           .symbol = "alpha",
                                           .meaning = "rate of stretching along z"},
                                          {.name = "circulation",
                                           .fallback = "1",
                                           .unit = "length^2 / time",
                                           .symbol = "Gamma",
                                           .meaning = "circulation of the vortex, counter-clockwise"},
                                          {.name = "viscosity",
                                           .fallback = "1",
                                           .range = positive,
                                           .unit = "length^2 / time",
                                           .symbol = "nu",
                                           .meaning = "sets the radius of the core, 2 sqrt(viscosity / strain)"}}},
          .divergence = "0",
          .exact_flow =
              "r exp(-strain (t - s) / 2), z exp(strain (t - s)), and an angle in closed form with the "
              "exponential integral E1",
          .make = [](int, const Arguments& arguments) { return std::make_unique<Burgers>(arguments); }};
}

}  // namespace gaussdrift::named
