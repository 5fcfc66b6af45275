#include "reference/norms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/nan.hpp"

namespace gaussdrift {

namespace {

using base::nan;

/// rho and weight are functions of the number of a value of `exact`.
template <class Rho, class Weight>
ErrorNorms norms(const std::vector<double>& exact, const Rho& rho, const Weight& weight) {
  double largest_error = 0, largest = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (std::isnan(exact[i])) continue;
    largest_error = std::max(largest_error, std::abs(rho(i) - exact[i]));
    largest = std::max(largest, std::abs(exact[i]));
  }
  if (!(largest > 0)) return {nan, nan, nan};
  double error_1 = 0, error_2 = 0, norm_1 = 0, norm_2 = 0;  // of values divided by the largest: squares do not overflow
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (std::isnan(exact[i])) continue;
    const double error = std::abs(rho(i) - exact[i]) / largest, size = std::abs(exact[i]) / largest, w = weight(i);
    error_1 += w * error, error_2 += w * (error * error);
    norm_1 += w * size, norm_2 += w * (size * size);
  }
  return {error_1 / norm_1, std::sqrt(error_2 / norm_2), largest_error / largest};
}

}  // namespace

ErrorNorms compare(const std::vector<double>& rho, const std::vector<double>& exact) {
  return norms(
      exact, [&](std::size_t i) { return rho[i]; }, [](std::size_t) { return 1.0; });
}

ErrorNorms compare(const Lattice& lattice, const std::vector<double>& rho, const std::vector<double>& exact) {
  if (!(lattice.sphere > 0)) return compare(rho, exact);
  return norms(
      exact, [&](std::size_t i) { return rho[i]; }, [&](std::size_t i) { return part_of_largest_cell(lattice, i); });
}

ErrorNorms compare(const std::vector<double>& rho, const GridSample& sample, const std::vector<double>& exact) {
  return norms(
      exact, [&](std::size_t i) { return rho[sample.points[i]]; }, [&](std::size_t i) { return sample.weight[i]; });
}

}  // namespace gaussdrift
