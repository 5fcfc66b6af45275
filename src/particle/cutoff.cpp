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

// A G_1 + B G_a with G_a(x) = (sqrt(pi) a)^-d exp(-|x|^2/a^2) integrates to A + B = 1, and its second moments are
// A/2 + B a^2/2 = 0 an axis: A = a^2/(a^2 - 1), B = -1/(a^2 - 1) in every dimension. Odd moments vanish by symmetry.
Cutoff two_gaussians(int dimension, double eps, double a) {
  if (!(a > 0) || a == 1) throw std::invalid_argument("the width ratio of two-gauss must be positive and not 1");
  const auto peak = [&](double width) { return std::pow(std::sqrt(std::numbers::pi) * width, -dimension); };
  const double square = a * a;
  return {{eps, {}, peak(eps) * square / (square - 1)}, {a * eps, {}, -peak(a * eps) / (square - 1)}};
}

struct Named {
  std::string name;
  int order;
};
const std::vector<Named>& cutoffs() {
  static const std::vector<Named> list{{"gauss2", 2}, {"gauss4", 4}, {"gauss6", 6}, {"gauss8", 8}, {"two-gauss", 4}};
  return list;
}

}  // namespace

const std::vector<std::string>& cutoff_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Named& cutoff : cutoffs()) list.push_back(cutoff.name);
    return list;
  }();
  return names;
}

int cutoff_order(std::string_view name) {
  for (const Named& cutoff : cutoffs())
    if (cutoff.name == name) return cutoff.order;
  throw std::out_of_range("no cutoff is called " + std::string(name));
}

Cutoff make_cutoff(std::string_view name, int dimension, double core_radius, double width_ratio) {
  const int order = cutoff_order(name);
  return name == "two-gauss" ? two_gaussians(dimension, core_radius, width_ratio)
                             : laplacians_of_gaussian(order, dimension, core_radius);
}

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
