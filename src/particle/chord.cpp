#include "particle/chord.hpp"

#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "base/sphere.hpp"
#include "particle/factorial.hpp"

namespace gaussdrift {

namespace {

constexpr const char* not_round = "a cutoff that is not round has no chord";

/// The coefficients of powers of the plane's Laplacian: those of D^(2n, 0). The others follow from them, and must.
std::vector<double> of_laplacians(const std::map<std::array<int, max_dimension>, double>& coefficients) {
  std::vector<double> powers;
  for (const auto& [derivative, coefficient] : coefficients)
    if (derivative[1] == 0 && derivative[2] == 0 && derivative[0] % 2 == 0) {
      powers.resize(std::max<std::size_t>(powers.size(), static_cast<std::size_t>(derivative[0] / 2) + 1));
      powers[static_cast<std::size_t>(derivative[0] / 2)] = coefficient;
    }
  std::size_t found = 0;
  for (int n = 0; n < static_cast<int>(powers.size()); ++n)
    for (int x = 0; x <= n; ++x) {
      const auto other = coefficients.find({2 * x, 2 * (n - x), 0});
      const double wanted = powers[static_cast<std::size_t>(n)] * factorial(n) / (factorial(x) * factorial(n - x));
      const double coefficient = other == coefficients.end() ? 0 : other->second;
      if (std::abs(coefficient - wanted) > 1e-12 * std::abs(wanted)) throw std::logic_error(not_round);
      found += other != coefficients.end();
    }
  if (found != coefficients.size()) throw std::logic_error(not_round);
  return powers;
}

/// Laplacian^n of exp(-|x|^2/w^2) is (-4/w^2)^n n! L_n^(d/2-1)(|x|^2/w^2) exp(-|x|^2/w^2) with Laguerre's polynomials,
/// and L_n^(0) = sum_i c_{n-i} L_i^(1/2), c_m = (-1/2)(1/2)...(m - 3/2) / m!. So powers of the plane's Laplacian are
/// sums of powers of that of space.
std::vector<double> powers_in_space(const std::vector<double>& in_plane, double width) {
  std::vector<double> powers(in_plane.size(), 0.0);
  for (std::size_t n = 0; n < in_plane.size(); ++n) {
    double factor = in_plane[n];  // times c_m n!/i! (-4/w^2)^m, m = n - i
    for (std::size_t m = 0; m <= n; ++m) {
      powers[n - m] += factor;
      factor *= (static_cast<double>(m) - 0.5) / static_cast<double>(m + 1) * static_cast<double>(n - m) * -4 /
                (width * width);
    }
  }
  return powers;
}

}  // namespace

Vector point_of_sphere(double radius, const Vector& place) {
  Vector x = on_unit_sphere(place[0], place[1]);
  for (double& component : x) component *= radius;
  return x;
}

double sphere_of(const Cutoff& cutoff) { return cutoff.empty() ? 0 : cutoff.front().sphere; }

Cutoff in_space(const Cutoff& cutoff) {
  std::map<double, std::map<std::array<int, max_dimension>, double>> of_width;
  for (const CutoffTerm& term : cutoff) {
    if (!term.is_round()) throw std::logic_error(not_round);
    of_width[term.width][term.derivative] += term.coefficient;
  }
  Cutoff terms;
  for (const auto& [width, coefficients] : of_width) {
    const std::vector<double> powers = powers_in_space(of_laplacians(coefficients), width);
    for (int n = 0; n < static_cast<int>(powers.size()); ++n)
      for (int x = n; x >= 0; --x)
        for (int y = n - x; y >= 0; --y) {
          const int z = n - x - y;
          const double multinomial = factorial(n) / (factorial(x) * factorial(y) * factorial(z));
          terms.push_back({.width = width,
                           .derivative = {2 * x, 2 * y, 2 * z},
                           .coefficient = powers[static_cast<std::size_t>(n)] * multinomial});
        }
  }
  return terms;
}

}  // namespace gaussdrift
