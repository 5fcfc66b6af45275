#include "particle/cutoff.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace gaussdrift {

namespace {

double factorial(int n) { return std::tgamma(n + 1.0); }

// Order 2m from one width: zeta = sum_{j<m} (-Laplacian/4)^j / j!  of  G = pi^{-d/2} exp(-|x|^2). The Fourier transform
// of G is exp(-s), s = |xi|^2/4, and that of -Laplacian/4 is s, so zeta^ = e^{-s} (1 + s + ... + s^{m-1}/(m-1)!) = 1 +
// O(s^m): all moments below 2m vanish. Laplacian^j = sum_{|beta|=j} j!/beta! D^{2 beta}.
Cutoff laplacians_of_gaussian(int order, int dimension, double eps) {
  Cutoff terms;
  const double peak = std::pow(std::sqrt(std::numbers::pi) * eps, -dimension);
  for (int j = 0; j < order / 2; ++j) {
    const double factor = peak * std::pow(-eps * eps / 4, j) / factorial(j);
    for (int bx = j; bx >= 0; --bx) {
      for (int by = j - bx; by >= 0; --by) {
        const int bz = j - bx - by;
        if ((dimension < 3 && bz > 0) || (dimension < 2 && by > 0)) continue;
        const double multinomial = factorial(j) / (factorial(bx) * factorial(by) * factorial(bz));
        terms.push_back({eps, {2 * bx, 2 * by, 2 * bz}, factor * multinomial});
      }
    }
  }
  return terms;
}

}  // namespace

const std::vector<std::string>& cutoff_names() {
  static const std::vector<std::string> names{"gauss2", "gauss4"};
  return names;
}

Cutoff make_cutoff(std::string_view name, int dimension, double core_radius) {
  if (name == "gauss2") return laplacians_of_gaussian(2, dimension, core_radius);
  if (name == "gauss4") return laplacians_of_gaussian(4, dimension, core_radius);
  throw std::out_of_range("no cutoff is called " + std::string(name));
}

}  // namespace gaussdrift
