// The cutoffs that a case can name.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "particle/cutoff.hpp"
#include "particle/factorial.hpp"

namespace gaussdrift {

namespace {

// Order 2m from one width: zeta = sum_{j<m} (-Laplacian/4)^j / j!  of  G = pi^{-d/2} exp(-|x|^2). The Fourier transform
// of G is exp(-s), s = |xi|^2/4, and that of -Laplacian/4 is s, so zeta^ = e^{-s} (1 + s + ... + s^{m-1}/(m-1)!) = 1 +
// O(s^m): all moments below 2m vanish. Laplacian^j = sum_{|beta|=j} j!/beta! D^{2 beta}.
template <int order>
Cutoff laplacians_of_gaussian(int dimension, double eps, const Arguments& /*none*/) {
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

constexpr std::string_view width_ratio = "width_ratio";

// The pair of [Sch06, 5.2.2 for d = 2]. A G_1 + B G_a with G_a(x) = (sqrt(pi) a)^-d exp(-|x|^2/a^2) integrates to A + B = 1, and its second moments are
// A/2 + B a^2/2 = 0 an axis: A = a^2/(a^2 - 1), B = -1/(a^2 - 1) in every dimension. Odd moments vanish by symmetry.
Cutoff two_gaussians(int dimension, double eps, const Arguments& arguments) {
  const double a = number(arguments, width_ratio);
  if (!(a > 0) || a == 1) throw std::invalid_argument("the width ratio of two-gauss must be positive and not 1");
  const auto peak = [&](double width) { return std::pow(std::sqrt(std::numbers::pi) * width, -dimension); };
  const double square = a * a;
  return {{eps, {}, peak(eps) * square / (square - 1)}, {a * eps, {}, -peak(a * eps) / (square - 1)}};
}

// Close to 1 the two Gaussians cancel: their weights are 1/(a^2 - 1).
std::vector<Complaint> too_equal(const Arguments& arguments) {
  const double a = number(arguments, width_ratio);
  if (std::abs(a - 1) >= 1e-3) return {};
  return {{.key = width_ratio,
           .message = fmt::format("particles.width_ratio = {} makes both Gaussians of two-gauss the same", a),
           .remedy = "2 is usual; gauss4 is the limit at 1"}};
}

NamedCutoff two_gauss() {
  return {
      .name = "two-gauss",
      .meaning = "is a pair of Gaussians, of order 4",
      .order = 4,
      .parameters = {{.name = width_ratio,
                      .fallback = "2",
                      .range = {0.01, 100},
                      .symbol = "a",
                      .meaning = "for `two-gauss`: its two Gaussians have the widths eps and a eps. It may not be 1"}},
      .make = two_gaussians,
      .problems = too_equal};
}

}  // namespace

const std::vector<NamedCutoff>& cutoffs() { return base::catalogue<NamedCutoff>(); }

const NamedCutoff& find_cutoff(std::string_view name) { return base::find_named(cutoffs(), "cutoff", name); }

Cutoff make_cutoff(std::string_view name, int dimension, double core_radius, const Arguments& given) {
  const NamedCutoff& cutoff = find_cutoff(name);
  return cutoff.make(dimension, core_radius, complete(name, cutoff.parameters, given, {}));
}

}  // namespace gaussdrift

namespace gaussdrift::base {

template <>
std::vector<NamedCutoff>& catalogue() {
  static std::vector<NamedCutoff> all{
      {.name = "gauss2",
       .meaning = "is a Gaussian, of order 2",
       .order = 2,
       .is_gaussian = true,
       .make = laplacians_of_gaussian<2>},
      {.name = "gauss4",
       .meaning = "is a Gaussian with its second derivatives, of order 4",
       .order = 4,
       .make = laplacians_of_gaussian<4>},
      {.name = "gauss6",
       .meaning = "is a Gaussian with its derivatives up to the fourth, of order 6",
       .order = 6,
       .make = laplacians_of_gaussian<6>},
      {.name = "gauss8",
       .meaning = "is a Gaussian with its derivatives up to the sixth, of order 8",
       .order = 8,
       .make = laplacians_of_gaussian<8>},
      two_gauss(),
  };
  return all;
}

}  // namespace gaussdrift::base
