#include "time/stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaussdrift::time {

namespace {

constexpr double largest_radius = 64;    // no method here is stable farther out: R is a polynomial of degree <= 7
constexpr double scan_step = 1.0 / 256;  // finer than any dent of |R| = 1 of these polynomials

// The end of the first stretch [0, y] on which `holds`, to rounding.
template <class Holds>
double end_of_stretch(const Holds& holds, double most) {
  double inside = 0;
  for (double y = scan_step;; y += scan_step) {
    y = std::min(y, most);
    if (!holds(y)) {
      double outside = y;
      for (int i = 0; i < 60; ++i) {
        const double middle = (inside + outside) / 2;
        (holds(middle) ? inside : outside) = middle;
      }
      return inside;
    }
    inside = y;
    if (y >= most) return most;
  }
}

}  // namespace

std::vector<double> stability_polynomial(const Tableau& rk) {
  const auto stages = static_cast<std::size_t>(rk.stages);
  std::vector<double> polynomial{1}, power(stages, 1.0);  // power = A^k 1
  for (int k = 0; k < rk.stages; ++k) {
    double sum = 0;
    for (int i = 0; i < rk.stages; ++i) sum += rk.b(i) * power[static_cast<std::size_t>(i)];
    polynomial.push_back(sum);
    std::vector<double> next(stages, 0.0);
    for (int i = 0; i < rk.stages; ++i)
      for (int l = 0; l < i; ++l) next[static_cast<std::size_t>(i)] += rk.a(i, l) * power[static_cast<std::size_t>(l)];
    power = next;
  }
  return polynomial;
}

std::complex<double> stability_function(const std::vector<double>& polynomial, std::complex<double> z) {
  std::complex<double> value = 0;
  for (auto c = polynomial.rbegin(); c != polynomial.rend(); ++c) value = value * z + *c;
  return value;
}

double largest_stable_step(const Tableau& rk, std::complex<double> lambda, double length, double growth, double most) {
  const double size = std::abs(lambda);
  if (size == 0 || length <= 0) return most;
  const std::vector<double> polynomial = stability_polynomial(rk);
  const auto holds = [&](double radius) {  // radius = |lambda| step; a run shorter than a step takes one
    const std::complex<double> z = radius * lambda / size;
    const double steps = std::max(1.0, length * size / radius);
    return steps * (std::log(std::abs(stability_function(polynomial, z))) - std::max(0.0, z.real())) <= growth;
  };
  const double farthest = std::min(most * size, largest_radius), radius = end_of_stretch(holds, farthest);
  return radius == most * size ? most : radius / size;
}

double growth_of_step(const Tableau& rk, std::complex<double> lambda, double length, double step) {
  const std::complex<double> z = step * lambda;
  const double once = std::log(std::abs(stability_function(stability_polynomial(rk), z))) - std::max(0.0, z.real());
  return std::max(1.0, length / step) * once;
}

}  // namespace gaussdrift::time
