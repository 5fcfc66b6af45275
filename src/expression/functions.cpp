// Every function of NaN is NaN. A zero keeps its sign where the mathematics allows it.
#include "expression/functions.hpp"

#include <cmath>
#include <numbers>

#include "rows/rows.hpp"

namespace gaussdrift::expression {
namespace {

template <double (*f)(double)>
void one(double* a, int, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) a[i] = f(a[i]);
}

template <rows::Unary rows::Kernels::*kernel>
void one(double* a, int, std::size_t count) {
  (rows::kernels().*kernel)(a, count);
}

template <double (*f)(double, double)>
void two(double* a, int, std::size_t count) {
  const double* b = a + row_length;
  for (std::size_t i = 0; i < count; ++i) a[i] = f(a[i], b[i]);
}

template <rows::Binary rows::Kernels::*kernel>
void two(double* a, int, std::size_t count) {
  (rows::kernels().*kernel)(a, a + row_length, false, count);
}

/// f(f(f(a, b), c), d) ...
template <double (*f)(double, double)>
void fold(double* a, int arguments, std::size_t count) {
  for (int k = 1; k < arguments; ++k) {
    const double* b = a + static_cast<std::size_t>(k) * row_length;
    for (std::size_t i = 0; i < count; ++i) a[i] = f(a[i], b[i]);
  }
}

/// Slope of a function of one argument from that argument.
template <double (*slope)(double)>
void one_slope(const double* a, int, std::size_t count, double* slopes) {
  for (std::size_t i = 0; i < count; ++i) slopes[i] = slope(a[i]);
}

/// One slope an argument.
template <double (*first)(double, double), double (*second)(double, double)>
void two_slopes(const double* a, int, std::size_t count, double* slopes) {
  const double* b = a + row_length;
  for (std::size_t i = 0; i < count; ++i) {
    slopes[i] = first(a[i], b[i]);
    slopes[row_length + i] = second(a[i], b[i]);
  }
}

/// 1 for the argument that fold<f> chooses, 0 for the others.
template <double (*f)(double, double)>
void fold_slopes(const double* a, int arguments, std::size_t count, double* slopes) {
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t chosen = 0;
    double value = a[i];
    for (std::size_t k = 1; k < static_cast<std::size_t>(arguments); ++k) {
      const double next = f(value, a[k * row_length + i]);
      if (next != value) chosen = k, value = next;
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(arguments); ++k)
      slopes[k * row_length + i] = k == chosen ? 1.0 : 0.0;
  }
}

double square(double a) { return a * a; }
double slope_tan(double a) { return 1 / square(std::cos(a)); }
double slope_cos(double a) { return -std::sin(a); }
double slope_asin(double a) { return 1 / std::sqrt((1 - a) * (1 + a)); }
double slope_acos(double a) { return -slope_asin(a); }
double slope_atan(double a) { return 1 / (1 + a * a); }
double slope_tanh(double a) { return 1 / square(std::cosh(a)); }
double slope_asinh(double a) { return 1 / std::hypot(1.0, a); }
double slope_acosh(double a) { return a < 1 ? std::nan("") : 1 / std::sqrt((a - 1) * (a + 1)); }
double slope_atanh(double a) { return std::fabs(a) > 1 ? std::nan("") : 1 / ((1 - a) * (1 + a)); }
double slope_log(double a) { return a < 0 ? std::nan("") : 1 / a; }
double slope_log2(double a) { return slope_log(a) / std::numbers::ln2; }
double slope_log10(double a) { return slope_log(a) / std::numbers::ln10; }
double slope_sqrt(double a) { return 0.5 / std::sqrt(a); }
double slope_cbrt(double a) { return 1 / (3 * square(std::cbrt(a))); }
double slope_erf(double a) { return 2 * std::numbers::inv_sqrtpi * std::exp(-a * a); }
double slope_flat(double a) { return std::isnan(a) ? a : 0.0; }
double slope_atan2_y(double y, double x) { return x / (x * x + y * y); }
double slope_atan2_x(double y, double x) { return -y / (x * x + y * y); }
double slope_hypot_a(double a, double b) { return a == 0 ? 0.0 : a / std::hypot(a, b); }
double slope_hypot_b(double a, double b) { return b == 0 ? 0.0 : b / std::hypot(a, b); }
double slope_mod_a(double, double) { return 1; }
double slope_mod_b(double a, double b) { return -std::floor(a / b); }
double slope_power_base(double a, double b) { return b == 0 ? 0.0 : b * std::pow(a, b - 1); }
double slope_power_exponent(double a, double b) { return a == 0 ? 0.0 : std::pow(a, b) * std::log(a); }

double sign(double a) { return a > 0 ? 1.0 : a < 0 ? -1.0 : a; }
double smaller(double a, double b) { return a < b || a != a ? a : b; }
double larger(double a, double b) { return a > b || a != a ? a : b; }

/// a - b floor(a / b): the remainder with the sign of b.
double modulo(double a, double b) {
  const double r = std::fmod(a, b);
  return r != 0 && (r < 0) != (b < 0) ? r + b : r;
}

}  // namespace

void power_slopes(const double* operands, int arguments, std::size_t count, double* slopes) {
  two_slopes<slope_power_base, slope_power_exponent>(operands, arguments, count, slopes);
}

// SLEEF has these hyperbolic functions too, but they overflow early: asinh from 1.4e154 on, sinh from 709.
const std::vector<Function>& functions() {
  static const std::vector<Function> table = {
      {{"sin", 1, "sine of an angle in radians, as all angles"}, one<&rows::Kernels::sin>, one_slope<std::cos>},
      {{"cos", 1, "cosine"}, one<&rows::Kernels::cos>, one_slope<slope_cos>},
      {{"tan", 1, "tangent"}, one<&rows::Kernels::tan>, one_slope<slope_tan>},
      {{"asin", 1, "inverse sine"}, one<&rows::Kernels::asin>, one_slope<slope_asin>},
      {{"acos", 1, "inverse cosine"}, one<&rows::Kernels::acos>, one_slope<slope_acos>},
      {{"atan", 1, "inverse tangent"}, one<&rows::Kernels::atan>, one_slope<slope_atan>},
      {{"atan2", 2, "angle of the point (x, y), written atan2(y, x)"},
       two<&rows::Kernels::atan2>,
       two_slopes<slope_atan2_y, slope_atan2_x>},
      {{"sinh", 1, "hyperbolic sine"}, one<std::sinh>, one_slope<std::cosh>},
      {{"cosh", 1, "hyperbolic cosine"}, one<std::cosh>, one_slope<std::sinh>},
      {{"tanh", 1, "hyperbolic tangent"}, one<&rows::Kernels::tanh>, one_slope<slope_tanh>},
      {{"asinh", 1, "inverse hyperbolic sine"}, one<std::asinh>, one_slope<slope_asinh>},
      {{"acosh", 1, "inverse hyperbolic cosine"}, one<std::acosh>, one_slope<slope_acosh>},
      {{"atanh", 1, "inverse hyperbolic tangent"}, one<&rows::Kernels::atanh>, one_slope<slope_atanh>},
      {{"exp", 1, "e to the power of a"}, one<&rows::Kernels::exp>, one_slope<std::exp>},
      {{"log", 1, "natural logarithm, to base e"}, one<&rows::Kernels::log>, one_slope<slope_log>},
      {{"ln", 1, "the same as log"}, one<&rows::Kernels::log>, one_slope<slope_log>},
      {{"log2", 1, "logarithm to base 2"}, one<&rows::Kernels::log2>, one_slope<slope_log2>},
      {{"log10", 1, "logarithm to base 10"}, one<&rows::Kernels::log10>, one_slope<slope_log10>},
      {{"sqrt", 1, "square root"}, one<&rows::Kernels::sqrt>, one_slope<slope_sqrt>},
      {{"cbrt", 1, "cube root, also of negative numbers"}, one<&rows::Kernels::cbrt>, one_slope<slope_cbrt>},
      {{"pow", 2, "pow(a, b) is a ^ b"}, two<&rows::Kernels::pow>, power_slopes},
      {{"hypot", 2, "sqrt(a^2 + b^2) without overflow"},
       two<&rows::Kernels::hypot>,
       two_slopes<slope_hypot_a, slope_hypot_b>},
      {{"abs", 1, "absolute value"},
       one<&rows::Kernels::abs>,
       one_slope<sign>,
       "abs has a corner at 0, where slope 0 is taken"},
      {{"sign", 1, "-1, 0 or 1"},
       one<sign>,
       one_slope<slope_flat>,
       "sign jumps at 0; its slope is taken as 0 everywhere"},
      {{"min", -2, "smallest of its arguments"},
       fold<smaller>,
       fold_slopes<smaller>,
       "min has corners where its arguments are equal; the slope of the first is taken there"},
      {{"max", -2, "largest of its arguments"},
       fold<larger>,
       fold_slopes<larger>,
       "max has corners where its arguments are equal; the slope of the first is taken there"},
      {{"floor", 1, "largest whole number not above a"},
       one<std::floor>,
       one_slope<slope_flat>,
       "floor jumps at whole numbers; its slope is taken as 0 everywhere"},
      {{"ceil", 1, "smallest whole number not below a"},
       one<std::ceil>,
       one_slope<slope_flat>,
       "ceil jumps at whole numbers; its slope is taken as 0 everywhere"},
      {{"round", 1, "nearest whole number, halves away from 0"},
       one<std::round>,
       one_slope<slope_flat>,
       "round jumps halfway between whole numbers; its slope is taken as 0 everywhere"},
      {{"mod", 2, "mod(a, b) = a - b floor(a/b): remainder with the sign of b"},
       two<modulo>,
       two_slopes<slope_mod_a, slope_mod_b>,
       "mod jumps at multiples of its second argument; the slope between jumps is taken"},
      {{"erf", 1, "error function"}, one<&rows::Kernels::erf>, one_slope<slope_erf>},
  };
  return table;
}

}  // namespace gaussdrift::expression
