// The single vortex in a box of LeVeque 1996 and Rider and Kothe 1998, which winds a disk up to a thin spiral and back.
#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

class Swirl : public FormulaField<SolenoidalField> {
 public:
  explicit Swirl(const Arguments& arguments)
      : FormulaField(Formula::swirl, Scaling(arguments).parameters()),
        box_(arguments),
        reversal_{number(arguments, "period")} {}

  std::size_t time_values() const override { return 1; }
  void at_time(double t, double* values) const override { *values = 2 * reversal_.factor(t); }
  void add_gradient(double t, const PointsView& x, const GradientsView& g) const override {
    const double pi = std::numbers::pi, f = 2 * reversal_.factor(t) * pi;
    for (std::size_t j = 0; j < x.count; ++j) {
      const double a = pi * box_.unit(0, x.axis[0][j]), b = pi * box_.unit(1, x.axis[1][j]);
      const double sa = std::sin(a), ca = std::cos(a), sb = std::sin(b), cb = std::cos(b);
      const double stretch = f * 2 * (sa * ca) * (sb * cb);
      g.slope[0][0][j] += stretch;
      g.slope[0][1][j] += f * box_.length[0] / box_.length[1] * (sa * sa) * (cb * cb - sb * sb);
      g.slope[1][0][j] -= f * box_.length[1] / box_.length[0] * (sb * sb) * (ca * ca - sa * sa);
      g.slope[1][1][j] -= stretch;
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

NamedField swirl() {
  return {
      .about = NamedFormula{.name = "swirl",
                            .meaning = "a single vortex in a box [LeV96], [RK98]. T = 8 is usual for the unit square",
                            .formula =
                                "with xi, eta = 0 ... 1 across the box L_x x L_y: u = (L_x sin^2(pi xi) sin(2 pi eta), "
                                "-L_y sin^2(pi eta) sin(2 pi xi)) cos(pi t / T)",
                            .parameters = {min_parameter(), max_parameter(), period_parameter()},
                            .problem = empty_box},
      .divergence = "0",
      .exact_flow = "back where it was when sin(pi t / T) = sin(pi s / T), for example after T; not known in between",
      .make = [](int, const Arguments& arguments) { return std::make_unique<Swirl>(arguments); }};
}

}  // namespace gaussdrift::named
