// The deformation of a ball in a box of LeVeque 1996 and Enright et al. 2002.
#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

class Deformation : public FormulaField<SolenoidalField> {
 public:
  explicit Deformation(const Arguments& arguments)
      : FormulaField(Formula::deformation, Scaling(arguments).parameters()),
        box_(arguments),
        reversal_{number(arguments, "period")} {}

  std::size_t time_values() const override { return 1; }
  void at_time(double t, double* values) const override { *values = reversal_.factor(t); }
  void add_gradient(double t, const PointsView& x, const GradientsView& g) const override {
    const double pi = std::numbers::pi, f = reversal_.factor(t);
    for (std::size_t j = 0; j < x.count; ++j) {
      Vector square{}, twice{}, cosine{};  // sin^2(pi xi), sin(2 pi xi), cos(2 pi xi)
      for (int k = 0; k < 3; ++k) {
        const double a = pi * box_.unit(k, x.axis[k][j]), s = std::sin(a), c = std::cos(a);
        square[k] = s * s;
        twice[k] = 2 * s * c;
        cosine[k] = c * c - s * s;
      }
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        const double scale = (k == 0 ? 2 : -1) * f * box_.length[k] * pi;
        g.slope[k][k][j] += scale / box_.length[k] * twice[k] * twice[a] * twice[b];
        g.slope[k][a][j] += 2 * scale / box_.length[a] * square[k] * cosine[a] * twice[b];
        g.slope[k][b][j] += 2 * scale / box_.length[b] * square[k] * twice[a] * cosine[b];
      }
    }
  }
  bool is_steady() const override { return reversal_.is_steady(); }
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    return reversal_.is_undone(from, to) ? std::optional(x) : std::nullopt;
  }

 private:
  Scaling box_;
  Reversal reversal_;
};

}  // namespace

NamedField deformation() {
  return {
      .about =
          NamedFormula{.name = "deformation",
                       .meaning =
                           "a flow in a box that deforms a ball and restores it [LeV96], [EFFM02]. T = 3 is usual for "
                           "the unit cube",
                       .formula = "with xi, eta, zeta = 0 ... 1 across the box: u = (2 L_x sin^2(pi xi) sin(2 pi eta) "
                                  "sin(2 pi zeta), -L_y sin(2 pi xi) sin^2(pi eta) sin(2 pi zeta), -L_z sin(2 pi xi) "
                                  "sin(2 pi eta) sin^2(pi zeta)) cos(pi t / T)",
                       .least_dimension = 3,
                       .parameters = {min_parameter(), max_parameter(), period_parameter()},
                       .problem = empty_box},
      .divergence = "0",
      .exact_flow = "back where it was when sin(pi t / T) = sin(pi s / T), for example after T; not known in between",
      .make = [](int, const Arguments& arguments) { return std::make_unique<Deformation>(arguments); }};
}

}  // namespace gaussdrift::named
