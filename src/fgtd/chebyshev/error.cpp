#include "fgtd/chebyshev/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fgtd::detail {
namespace {

/// ln( M_{a+n} / sqrt(2^a a!) )
double log_derivative(int a, int n) {
  return (a + n) * std::numbers::ln2 + std::lgamma(0.5 * (a + n + 1)) - 0.5 * std::log(std::numbers::pi) -
         0.5 * (a * std::numbers::ln2 + std::lgamma(a + 1.0));
}

/// E_a
double axis_error(double h, int nodes, int a) {
  const double log_factor = std::numbers::ln2 + nodes * std::log(h / 4) - std::lgamma(nodes + 1.0);
  return 2 * std::exp(log_factor + log_derivative(a, nodes)) + std::exp(2 * log_factor + log_derivative(a, 2 * nodes));
}

bool fades(int d, double h, int nodes, double reach, double tolerance, int derivative_order) {
  const double rho = reach + 2 * h, limit = 2 * std::log(1 / tolerance) + 40;
  if (d * rho * rho <= limit) return true;
  double log_error = -1e300, polynomial = 1, before = 0, largest = 1;  // recurrence (7) with a plus
  for (int a = 0; a <= derivative_order; ++a) {
    log_error = std::max(log_error, std::log(axis_error(h, nodes, a)) + rho * rho);
    largest = std::max(largest, polynomial);
    const double next = std::sqrt(2.0 / (a + 1)) * rho * polynomial + std::sqrt(a / (a + 1.0)) * before;
    before = polynomial;
    polynomial = next;
  }
  const double log_sum =
      std::max(log_error, std::log(largest)) + std::log1p(std::exp(-std::abs(log_error - std::log(largest))));
  return d * log_sum <= 40 - std::log(tolerance);
}

}  // namespace

double interpolation_error(int d, double h, int nodes, int derivative_order) {
  // best[k]: the largest sum of ln(1 + E_{alpha_l}) over the axes so far with |alpha| = k
  std::vector<double> axis, best(static_cast<std::size_t>(derivative_order) + 1, 0.0);
  for (int a = 0; a <= derivative_order; ++a) axis.push_back(std::log1p(axis_error(h, nodes, a)));
  for (int l = 0; l < d; ++l)
    for (std::size_t k = best.size(); k-- > 0;) {
      double most = 0;
      for (std::size_t a = 0; a <= k; ++a) most = std::max(most, best[k - a] + axis[a]);
      best[k] = most;
    }
  return std::expm1(*std::max_element(best.begin(), best.end()));
}

double widest_side(int d, int nodes, double reach, double tolerance, int derivative_order) {
  // The error grows nearly like h^P: a few steps of that law from below or above, held between bounds that close in.
  double low = 1e-8, high = 16, h = 1;
  if (interpolation_error(d, low, nodes, derivative_order) > tolerance) return 0;
  for (int step = 0; step < 60 && high > low * 1.0005; ++step) {
    const double error = interpolation_error(d, h, nodes, derivative_order);
    (error <= tolerance ? low : high) = h;
    h *= std::pow(0.9995 * tolerance / error, 1.0 / nodes);
    if (!(h > low && h < high)) h = std::sqrt(low * high);
    if (error <= tolerance && error >= 0.998 * tolerance) break;
  }
  for (int step = 0; step < 100; ++step, low *= 0.95)
    if (fades(d, low, nodes, reach, tolerance, derivative_order)) return low;
  return 0;
}

}  // namespace fgtd::detail
