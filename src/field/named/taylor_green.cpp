// Taylor and Green's lattice of vortices; with a decay it solves the Navier-Stokes equations.
#include <algorithm>
#include <array>

#include "field/named/formula.hpp"
#include "field/named/named.hpp"

namespace gaussdrift::named {

namespace {

/// Carlson's R_F(x, y, z) by duplication [Car95], at most one argument 0. Right to a few roundings.
double carlson(double x, double y, double z) {
  for (int k = 0; k < 60; ++k) {
    const double mean = (x + y + z) / 3;
    const double dx = 1 - x / mean, dy = 1 - y / mean, dz = 1 - z / mean;
    if (std::max({std::abs(dx), std::abs(dy), std::abs(dz)}) < 2e-3) {  // the next term of the series is its 6th power
      const double e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
      return (1 + (e2 / 24 - 0.1 - 3 * e3 / 44) * e2 + e3 / 14) / std::sqrt(mean);
    }
    const double shift = std::sqrt(x * y) + std::sqrt(x * z) + std::sqrt(y * z);
    x = (x + shift) / 4, y = (y + shift) / 4, z = (z + shift) / 4;
  }
  return 1 / std::sqrt((x + y + z) / 3);
}

/// Arithmetic-geometric mean of 1 and b > 0: K(m) = pi / 2 / agm(sqrt(1 - m^2)).
double agm(double b) {
  double a = 1;
  for (int n = 0; n < 40 && std::abs(a - b) > 1e-15 * a; ++n) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return (a + b) / 2;
}

struct Jacobi {
  double sn, cn, dn;
};

/// Jacobi's elliptic functions of u for the complementary modulus k' > 0, by arithmetic-geometric means [AS64, 16.4].
Jacobi jacobi(double u, double complement) {
  constexpr int most = 40;
  std::array<double, most> ratio{};  // c_n / a_n
  double a = 1, b = complement, scale = 1;
  int n = 0;
  for (; n < most && std::abs(a - b) > 1e-15 * a; ++n) {
    const double mean = (a + b) / 2;
    ratio[n] = (a - b) / 2 / mean;
    b = std::sqrt(a * b);
    a = mean;
    scale *= 2;
  }
  double angle = scale * a * u;
  for (; n > 0; --n) angle = (angle + std::asin(ratio[n - 1] * std::sin(angle))) / 2;
  const double sn = std::sin(angle), cn = std::cos(angle);
  return {sn, cn, std::hypot(cn, complement * sn)};
}

class TaylorGreen : public FormulaField<SolenoidalField> {
 public:
  explicit TaylorGreen(const Arguments& arguments)
      : FormulaField(Formula::taylor_green, {point(arguments, "corner")[0], point(arguments, "corner")[1],
                                             2 * std::numbers::pi / number(arguments, "wavelength")}),
        corner_(point(arguments, "corner")),
        speed_(number(arguments, "speed")),
        wave_(2 * std::numbers::pi / number(arguments, "wavelength")),
        decay_(number(arguments, "decay")) {}

  std::size_t time_values() const override { return 1; }
  void at_time(double t, double* values) const override { *values = speed_ * std::exp(-decay_ * t); }
  void add_gradient(double t, const PointsView& x, const GradientsView& g) const override {
    const double rate = wave_ * speed_ * std::exp(-decay_ * t);
    for (std::size_t j = 0; j < x.count; ++j) {
      const double a = wave_ * (x.axis[0][j] - corner_[0]), b = wave_ * (x.axis[1][j] - corner_[1]);
      const double stretch = rate * std::cos(a) * std::cos(b), turn = rate * std::sin(a) * std::sin(b);
      g.slope[0][0][j] += stretch;
      g.slope[0][1][j] -= turn;
      g.slope[1][0][j] += turn;
      g.slope[1][1][j] -= stretch;
    }
  }
  bool is_steady() const override { return decay_ == 0; }

  // Within one cell, with the angles a, b = 0 ... pi and k' = sin a sin b, m = sqrt(1 - k'^2), which the path keeps:
  //   cos a = m sn(tau),  sin a = dn(tau),  cos b = -m cn(tau) / dn(tau),  tau growing like k times the length at speed
  //   u.
  // A quarter K further a takes the place of b: cos b = m sn(tau - K), sin b = dn(tau - K). Counting tau from the
  // nearest multiple of K keeps every digit close to the walls, where K is large.
  std::optional<Vector> flow(double from, double to, const Vector& x) const override {
    const double pi = std::numbers::pi;
    double a = wave_ * (x[0] - corner_[0]), b = wave_ * (x[1] - corner_[1]);
    const double column = std::floor(a / pi), row = std::floor(b / pi);
    a -= column * pi, b -= row * pi;
    const double sense = std::fmod(std::abs(column + row), 2) == 1 ? -1 : 1;
    // int_from^to exp(-decay t) dt
    const double span = to - from;
    const double time = decay_ == 0 ? span : -std::exp(-decay_ * from) * std::expm1(-decay_ * span) / decay_;
    const double run = sense * wave_ * speed_ * time;
    const double sa = std::sin(a), ca = std::cos(a), sb = std::sin(b), cb = std::cos(b);
    const double complement = std::abs(sa * sb), modulus = std::hypot(ca, sa * cb);
    if (complement == 0) {  // on a wall: tan(angle / 2) grows like an exponential
      if (sa == 0)
        b = 2 * std::atan(std::tan(b / 2) * std::exp(-run * ca));
      else
        a = 2 * std::atan(std::tan(a / 2) * std::exp(run * cb));
    } else if (modulus > 0) {
      const double quarter = pi / 2 / agm(complement);
      const bool shifted = sb > sa;  // count from K
      const double sn = (shifted ? cb : ca) / modulus, dn = shifted ? sb : sa;
      const double cn = (shifted ? ca * sb : -sa * cb) / modulus;
      double rest = sn * carlson(cn * cn, dn * dn, 1), quarters = shifted ? 1 : 0;
      if (cn < 0) rest = -rest, quarters += 2;
      rest += run;
      const double turned = std::round(rest / quarter);
      const Jacobi end = jacobi(rest - turned * quarter, complement);
      quarters = std::fmod(quarters + turned, 4);
      if (quarters < 0) quarters += 4;
      const double sign = quarters < 2 ? 1 : -1;
      if (quarters == 0 || quarters == 2) {
        a = std::atan2(end.dn, sign * modulus * end.sn);
        b = std::atan2(complement, -sign * modulus * end.cn);
      } else {
        a = std::atan2(complement, sign * modulus * end.cn);
        b = std::atan2(end.dn, sign * modulus * end.sn);
      }
    }
    return Vector{corner_[0] + (column * pi + a) / wave_, corner_[1] + (row * pi + b) / wave_, x[2]};
  }

 private:
  Vector corner_;
  double speed_, wave_, decay_;
};

}  // namespace

NamedField taylor_green() {
  return {.about =
              NamedFormula{
                  .name = "taylor_green",
                  .meaning = "the vortices of Taylor and Green [TG37] on a lattice. In 3D they are the same at every z",
                  .formula = "with k = 2 pi / wavelength, a = k (x - corner_x), b = k (y - corner_y): u = speed "
                             "exp(-decay t) (sin a cos b, -cos a sin b)",
                  .parameters = {{.name = "corner",
                                  .kind = Kind::point,
                                  .fallback = "origin",
                                  .unit = "length",
                                  .meaning = "a point where four vortices meet"},
                                 {.name = "speed",
                                  .fallback = "1",
                                  .unit = "length / time",
                                  .meaning = "speed of the strongest wind at t = 0"},
                                 {.name = "wavelength",
                                  .fallback = "6.283185307179586",
                                  .range = positive,
                                  .unit = "length",
                                  .meaning = "distance after which the flow repeats: two vortices"},
                                 {.name = "decay",
                                  .fallback = "0",
                                  .unit = "1 / time",
                                  .symbol = "2 nu k^2",
                                  .meaning = "rate at which the flow dies away"}}},
          .divergence = "0",
          .exact_flow =
              "in Jacobi's elliptic functions; one turn takes 4 K(m) / (k speed), m^2 = 1 - sin^2 a sin^2 b, "
              "without decay",
          .make = [](int, const Arguments& arguments) { return std::make_unique<TaylorGreen>(arguments); }};
}

}  // namespace gaussdrift::named
