// Scales, bounds and costs of the thesis, and their sharpened forms; see fgtd.hpp and bounds.hpp.
#include "fgtd/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fgtd/fgtd.hpp"

namespace fgtd {

template <int d>
double derivative_scale(const Derivative<d>& alpha, double sigma) {
  double scale = 1;
  for (const int a : alpha)
    for (int n = 1; n <= a; ++n) scale *= std::sqrt(2.0 * n) * std::sqrt(sigma);
  return scale;
}

template <int d>
std::optional<double> hermite_bound(double r, int p, int n, const Derivative<d>& alpha) {
  int k = 0;
  for (const int a : alpha) k = std::max(k, a);
  if (!(r > 0) || r >= 1 || p < 1 || p < 2 * k - 1 || p < k) return std::nullopt;
  const double boxes = n < 0 ? 0.0 : derivative_scale<d>(alpha, 1.0) * std::exp(-r * r * n * n);
  const double kept =
      std::pow(2.0, 0.5 * k) * (1 - std::pow(r, p)) * std::exp(0.5 * (std::lgamma(p + k) - std::lgamma(p)));
  const double cut = std::pow(2.0, k) * std::pow(r, p) * std::exp(-0.5 * std::lgamma(p - k + 1));
  double sum = 0, binomial = 1;
  for (int l = 0; l < d; ++l) {
    sum += binomial * std::pow(kept, l) * std::pow(cut, d - l);
    binomial = binomial * (d - l) / (l + 1);
  }
  return boxes + sum / std::pow(1 - r, d);
}

double hermite_cost(int d, int p, double boxes_per_target, double sources, double targets) {
  const double moments = std::pow(p, d);
  return moments * sources + boxes_per_target * moments * targets;
}

namespace detail {
namespace {

/// Calls body(alpha) for every descending alpha of d entries with |alpha| <= order; other orders of entries are alike.
template <class Body>
void for_each_partition(int d, int order, const Body& body) {
  const auto limit = [&](int axis, int left, int before) { return axis < d ? std::min(left, before) : 0; };
  for (int a = 0; a <= order; ++a)
    for (int b = 0; b <= limit(1, order - a, a); ++b)
      for (int c = 0; c <= limit(2, order - a - b, b); ++c)
        for (int e = 0; e <= limit(3, order - a - b - c, c); ++e) body(std::array<int, 4>{a, b, c, e});
}

/// e_k = sum_{m >= p} r^m sqrt(binomial(m+k, k) / m!)
double tail(double r, int p, int k) {
  double sum = 0;
  double term = std::exp(p * std::log(r) + 0.5 * (std::lgamma(p + k + 1) - std::lgamma(k + 1)) - std::lgamma(p + 1));
  for (int m = p; m < p + 1000; ++m) {
    sum += term;
    const double ratio = r * std::sqrt(m + 1.0 + k) / (m + 1.0);
    term *= ratio;
    if (ratio < 0.5 && term < 1e-17 * sum) break;
  }
  return sum;
}

std::array<double, 4> lookup(const std::vector<double>& of_order, const std::array<int, 4>& alpha) {
  std::array<double, 4> values{};
  for (std::size_t l = 0; l < 4; ++l) values[l] = of_order[static_cast<std::size_t>(alpha[l])];
  return values;
}

}  // namespace

double kept_error(int d, double r, int p, int derivative_order) {
  std::vector<double> e;
  for (int k = 0; k <= derivative_order; ++k) e.push_back(tail(r, p, k));
  double worst = 0;
  for_each_partition(d, derivative_order, [&](const std::array<int, 4>& alpha) {
    const auto values = lookup(e, alpha);
    double error = 0;  // prod (1 + e) - 1 without cancellation
    for (int l = 0; l < d; ++l) error += values[static_cast<std::size_t>(l)] * (1 + error);
    worst = std::max(worst, error);
  });
  return worst;
}

double log_far_error(int d, double r, int p, int derivative_order) {
  std::vector<double> e, whole;
  for (int k = 0; k <= derivative_order; ++k) {
    e.push_back(tail(r, p, k));
    whole.push_back(tail(r, 0, k));
  }
  double worst = 0;
  for_each_partition(d, derivative_order, [&](const std::array<int, 4>& alpha) {
    const auto tails = lookup(e, alpha), series = lookup(whole, alpha);
    double error = 0;  // prod S - prod (S - e), one axis replaced after the other
    for (std::size_t l = 0; l < static_cast<std::size_t>(d); ++l) {
      double product = tails[l];
      for (std::size_t i = 0; i < static_cast<std::size_t>(d); ++i)
        if (i != l) product *= series[i];
      error += product;
    }
    worst = std::max(worst, error);
  });
  return std::log(worst);
}

double dropped_error(int d, double rho, int derivative_order) {
  const double cramer = std::exp(-0.5 * rho * rho);
  if (2 * rho * rho < derivative_order) return cramer;
  std::vector<double> polynomial{1.0};  // sum |coefficients| rho^j, scaled by 1/sqrt(2^k k!)
  for (int n = 0; n < derivative_order; ++n) {
    const double before = n == 0 ? 0.0 : polynomial[static_cast<std::size_t>(n - 1)];
    polynomial.push_back(rho * std::sqrt(2.0 / (n + 1)) * polynomial[static_cast<std::size_t>(n)] +
                         std::sqrt(n / (n + 1.0)) * before);
  }
  double worst = 0;
  for_each_partition(d, derivative_order, [&](const std::array<int, 4>& alpha) {
    const auto values = lookup(polynomial, alpha);
    double product = 1;
    for (std::size_t l = 0; l < static_cast<std::size_t>(d); ++l) product *= values[l];
    worst = std::max(worst, product);
  });
  return std::min(cramer, worst * std::exp(-rho * rho));
}

double find_reach(int d, double tolerance, int derivative_order) {
  double low = 0, high = std::sqrt(2 * std::log(1 / tolerance)) * (1 + 1e-14);  // rounding keeps the bound below
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (dropped_error(d, middle, derivative_order) <= tolerance ? high : low) = middle;
  }
  return high;
}

template <int d>
std::optional<double> thesis_bound(double r, int p, int n, int derivative_order) {
  double worst = 0;
  bool holds = true;
  for_each_partition(d, derivative_order, [&](const std::array<int, 4>& partition) {
    Derivative<d> alpha;
    std::copy_n(partition.begin(), d, alpha.begin());
    const std::optional<double> bound = hermite_bound<d>(r, p, n, alpha);
    holds = holds && bound.has_value();
    if (bound) worst = std::max(worst, *bound / derivative_scale<d>(alpha, 1.0));
  });
  return holds ? std::optional<double>(worst) : std::nullopt;
}

template std::optional<double> thesis_bound<1>(double, int, int, int);
template std::optional<double> thesis_bound<2>(double, int, int, int);
template std::optional<double> thesis_bound<3>(double, int, int, int);
template std::optional<double> thesis_bound<4>(double, int, int, int);

}  // namespace detail

#define FGTD_INSTANTIATE(d)                                          \
  template double derivative_scale<d>(const Derivative<d>&, double); \
  template std::optional<double> hermite_bound<d>(double, int, int, const Derivative<d>&);
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd
