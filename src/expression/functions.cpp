// NaN goes through every function, and a zero keeps its sign where the mathematics leaves it one.
#include "expression/functions.hpp"

#include <cmath>

namespace gaussdrift::expression {
namespace {

template <double (*f)(double)>
void one(double* a, int, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) a[i] = f(a[i]);
}

template <double (*f)(double, double)>
void two(double* a, int, std::size_t count) {
  const double* b = a + row_length;
  for (std::size_t i = 0; i < count; ++i) a[i] = f(a[i], b[i]);
}

/// f(f(f(a, b), c), d) ...
template <double (*f)(double, double)>
void fold(double* a, int arguments, std::size_t count) {
  for (int k = 1; k < arguments; ++k) {
    const double* b = a + static_cast<std::size_t>(k) * row_length;
    for (std::size_t i = 0; i < count; ++i) a[i] = f(a[i], b[i]);
  }
}

double sign(double a) { return a > 0 ? 1.0 : a < 0 ? -1.0 : a; }
double smaller(double a, double b) { return a < b || a != a ? a : b; }
double larger(double a, double b) { return a > b || a != a ? a : b; }

/// a - b floor(a / b): the remainder with the sign of b.
double modulo(double a, double b) {
  const double r = std::fmod(a, b);
  return r != 0 && (r < 0) != (b < 0) ? r + b : r;
}

}  // namespace

const std::vector<Function>& functions() {
  static const std::vector<Function> table = {
      {{"sin", 1, "sine of an angle in radians, as all angles"}, one<std::sin>},
      {{"cos", 1, "cosine"}, one<std::cos>},
      {{"tan", 1, "tangent"}, one<std::tan>},
      {{"asin", 1, "inverse sine"}, one<std::asin>},
      {{"acos", 1, "inverse cosine"}, one<std::acos>},
      {{"atan", 1, "inverse tangent"}, one<std::atan>},
      {{"atan2", 2, "angle of the point (x, y), written atan2(y, x)"}, two<std::atan2>},
      {{"sinh", 1, "hyperbolic sine"}, one<std::sinh>},
      {{"cosh", 1, "hyperbolic cosine"}, one<std::cosh>},
      {{"tanh", 1, "hyperbolic tangent"}, one<std::tanh>},
      {{"asinh", 1, "inverse hyperbolic sine"}, one<std::asinh>},
      {{"acosh", 1, "inverse hyperbolic cosine"}, one<std::acosh>},
      {{"atanh", 1, "inverse hyperbolic tangent"}, one<std::atanh>},
      {{"exp", 1, "e to the power of a"}, one<std::exp>},
      {{"log", 1, "natural logarithm, to base e"}, one<std::log>},
      {{"ln", 1, "the same as log"}, one<std::log>},
      {{"log2", 1, "logarithm to base 2"}, one<std::log2>},
      {{"log10", 1, "logarithm to base 10"}, one<std::log10>},
      {{"sqrt", 1, "square root"}, one<std::sqrt>},
      {{"cbrt", 1, "cube root, also of negative numbers"}, one<std::cbrt>},
      {{"pow", 2, "pow(a, b) is a ^ b"}, two<std::pow>},
      {{"hypot", 2, "sqrt(a^2 + b^2) without overflow"}, two<std::hypot>},
      {{"abs", 1, "absolute value"}, one<std::fabs>},
      {{"sign", 1, "-1, 0 or 1"}, one<sign>},
      {{"min", -2, "smallest of its arguments"}, fold<smaller>},
      {{"max", -2, "largest of its arguments"}, fold<larger>},
      {{"floor", 1, "largest whole number not above a"}, one<std::floor>},
      {{"ceil", 1, "smallest whole number not below a"}, one<std::ceil>},
      {{"round", 1, "nearest whole number, halves away from 0"}, one<std::round>},
      {{"mod", 2, "mod(a, b) = a - b floor(a/b): remainder with the sign of b"}, two<modulo>},
      {{"erf", 1, "error function"}, one<std::erf>},
  };
  return table;
}

}  // namespace gaussdrift::expression
