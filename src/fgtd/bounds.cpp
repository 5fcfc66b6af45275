// Scales, bounds and costs of the thesis.
#include <cmath>

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
  const double kept = std::pow(2.0, 0.5 * k) * (1 - std::pow(r, p)) * std::exp(0.5 * (std::lgamma(p + k) - std::lgamma(p)));
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

#define FGTD_INSTANTIATE(d)                                              \
  template double derivative_scale<d>(const Derivative<d>&, double);     \
  template std::optional<double> hermite_bound<d>(double, int, int, const Derivative<d>&);
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd
