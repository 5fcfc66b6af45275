#include "particle/cutoff.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "particle/factorial.hpp"
#include "particle/round_coordinates.hpp"

namespace gaussdrift {

namespace {

// Of a round term.
double at_centre(const CutoffTerm& term) {
  // d^a/dx^a exp(-x^2/w^2) at 0 is (-1)^(a/2) a! / (a/2)! / w^a for even a, and 0 for odd a.
  double value = term.coefficient;
  for (const int order : term.derivative) {
    const double sign = order % 2 != 0 ? 0 : order / 2 % 2 != 0 ? -1 : 1;
    value *= sign * factorial(order) / factorial(order / 2) * std::pow(term.width, -order);
  }
  return value;
}

int order_of(const CutoffTerm& term) { return std::accumulate(term.derivative.begin(), term.derivative.end(), 0); }

// The longest radius, or a little more: Frobenius' norm is no smaller than the largest eigenvalue.
double longest_radius(const CutoffTerm& term) {
  if (term.is_round()) return term.width;
  double square = 0;
  for (const auto& row : term.longer)
    for (const double entry : row) square += entry * entry;
  return std::sqrt(term.width * term.width + std::sqrt(square));
}

// |H_n(t)| <= (2 |t| + sqrt(2 n))^n bounds each derivative of a Gaussian. Those of an ellipse are derivatives of a round
// one along directions that are no longer than 1 / width, and along several of them none is larger than along one.
double bound_of(const CutoffTerm& term, double distance) {
  const double t = distance / longest_radius(term);
  double value = std::abs(term.coefficient) * std::exp(-t * t);
  const auto derivative = [&](int order) { value *= std::pow((2 * t + std::sqrt(2. * order)) / term.width, order); };
  if (!term.is_round())
    derivative(order_of(term));
  else
    for (const int order : term.derivative) derivative(order);
  return value;
}

}  // namespace

double peak(const Cutoff& cutoff) {
  double sum = 0;
  for (const CutoffTerm& term : cutoff) {
    if (term.is_round()) {
      sum += at_centre(term);
      continue;
    }
    for (const CutoffTerm& round : derivative_along(term.derivative, round_coordinates(term)))
      sum += term.coefficient * at_centre(round);
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
  // The bound falls from where every term does.
  const auto bound = [&](double distance) {
    double sum = 0;
    for (const CutoffTerm& term : cutoff) sum += bound_of(term, distance);
    return sum;
  };
  double widest = 0, low = 0;
  for (const CutoffTerm& term : cutoff) {
    const double radius = longest_radius(term);
    widest = std::max(widest, radius);
    low = std::max(low, radius * std::sqrt(order_of(term) / 2.));  // here (2 t)^n exp(-t^2) is largest
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

Cutoff on_sphere(Cutoff cutoff, double radius) {
  for (CutoffTerm& term : cutoff) term.sphere = radius;
  return cutoff;
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

Cutoff spread_cutoff(const Cutoff& cutoff, int dimension, double spread, const Tensor& shape) {
  Eigen::MatrixXd matrix(dimension, dimension);
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j) matrix(i, j) = shape[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const Eigen::VectorXd along = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
  const double least = std::max(0.0, along.minCoeff());
  Cutoff longer = spread_cutoff(cutoff, dimension, spread * least);
  for (CutoffTerm& term : longer) {
    for (int i = 0; i < dimension; ++i) {
      const auto row = static_cast<std::size_t>(i);
      for (std::size_t j = 0; j < static_cast<std::size_t>(dimension); ++j)
        term.longer[row][j] = spread * (shape[row][j] - (row == j ? least : 0));
      const double shortest = term.width * term.width;
      term.coefficient *= std::sqrt(shortest / (shortest + spread * (along(i) - least)));
    }
  }
  return longer;
}

}  // namespace gaussdrift
