#include "particle/cutoff.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace gaussdrift {

namespace {

double factorial(int n) { return std::tgamma(n + 1.0); }

}  // namespace

double peak(const Cutoff& cutoff) {
  double sum = 0;
  for (const CutoffTerm& term : cutoff) {
    // d^a/dx^a exp(-x^2/w^2) at 0 is (-1)^(a/2) a! / (a/2)! / w^a for even a, and 0 for odd a.
    double value = term.coefficient;
    for (const int order : term.derivative) {
      const double sign = order % 2 != 0 ? 0 : order / 2 % 2 != 0 ? -1 : 1;
      value *= sign * factorial(order) / factorial(order / 2) * std::pow(term.width, -order);
    }
    sum += value;
  }
  return sum;
}

double fourier(const Cutoff& cutoff, int dimension, double wave_number) {
  double sum = 0;
  for (const CutoffTerm& term : cutoff) {
    if (term.derivative[1] != 0 || term.derivative[2] != 0 || term.derivative[0] % 2 != 0) continue;
    // Of exp(-|x|^2/w^2): (sqrt(pi) w)^d exp(-k^2 w^2/4). A derivative is a factor i k; odd ones cancel.
    const double sign = term.derivative[0] / 2 % 2 != 0 ? -1 : 1;
    sum += sign * term.coefficient * std::pow(wave_number, term.derivative[0]) *
           std::pow(std::sqrt(std::numbers::pi) * term.width, dimension) *
           std::exp(-std::pow(wave_number * term.width, 2) / 4);
  }
  return sum;
}

double narrowest_width(const Cutoff& cutoff) {
  return std::min_element(cutoff.begin(), cutoff.end(),
                          [](const CutoffTerm& a, const CutoffTerm& b) { return a.width < b.width; })
      ->width;
}

double reach(const Cutoff& cutoff, double part) {
  // |H_n(t)| <= (2 |t| + sqrt(2 n))^n bounds each derivative of a Gaussian. The bound falls from where every term does.
  const auto bound = [&](double distance) {
    double sum = 0;
    for (const CutoffTerm& term : cutoff) {
      const double t = distance / term.width;
      double value = std::abs(term.coefficient) * std::exp(-t * t);
      for (const int order : term.derivative) value *= std::pow((2 * t + std::sqrt(2. * order)) / term.width, order);
      sum += value;
    }
    return sum;
  };
  double widest = 0, low = 0;
  for (const CutoffTerm& term : cutoff) {
    widest = std::max(widest, term.width);
    const int order = std::accumulate(term.derivative.begin(), term.derivative.end(), 0);
    low = std::max(low, term.width * std::sqrt(order / 2.));  // here (2 t)^n exp(-t^2) is largest
  }
  const double allowed = part * std::abs(peak(cutoff));
  double high = low + widest;
  while (bound(high) > allowed) high += widest;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (bound(middle) > allowed ? low : high) = middle;
  }
  return high;
}

Cutoff spread_cutoff(const Cutoff& cutoff, int dimension, double spread) {
  Cutoff wider = cutoff;
  for (CutoffTerm& term : wider) {
    const double before = term.width;
    term.width = std::sqrt(before * before + spread);
    term.coefficient *= std::pow(before / term.width, dimension);
  }
  return wider;
}

}  // namespace gaussdrift
