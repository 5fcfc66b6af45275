// Cutoff functions zeta of order 2, 4, ...: each a combination of derivatives of Gaussians, so that the density of all
// blobs is one Gauss transform a width. method.md, section 3. Knows nothing about particles.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/points.hpp"

namespace gaussdrift {

/// coefficient * D^derivative exp(-|x|^2 / width^2).
struct CutoffTerm {
  double width = 1;
  std::array<int, max_dimension> derivative{};
  double coefficient = 1;
};

/// zeta_eps as a sum of terms.
using Cutoff = std::vector<CutoffTerm>;

/// Names that make_cutoff() knows.
const std::vector<std::string>& cutoff_names();

/// zeta_eps(x) = eps^-d zeta(x / eps) for core radius eps > 0. Throws std::out_of_range for an unknown name and
/// std::invalid_argument for a width ratio that is not positive or is 1. method.md, equations 4 and 4a.
///   gauss2      G(x) = pi^{-d/2} exp(-|x|^2)
///   gauss4      (1 - Laplacian/4) G; in 2D (2 - r^2) exp(-r^2) / pi
///   gauss6      (1 - Laplacian/4 + Laplacian^2/32) G
///   gauss8      (1 - Laplacian/4 + Laplacian^2/32 - Laplacian^3/384) G
///   two-gauss   (a^2 G(x) - a^-d G(x/a)) / (a^2 - 1), of order 4; a = width_ratio [Sch06, 5.2.2 for d = 2]
Cutoff make_cutoff(std::string_view name, int dimension, double core_radius, double width_ratio = 2);

/// Order of the cutoff of that name (moments 1 .. order - 1 vanish). Throws std::out_of_range.
int cutoff_order(std::string_view name);

/// zeta_eps(0), the largest |zeta_eps|: the Fourier transforms of all cutoffs are positive.
double peak(const Cutoff& cutoff);

/// The cutoff convolved with the Gaussian of variance spread/2 an axis. The square of every width grows by `spread`.
/// Its integral and the coefficients of the derivatives stay (method.md, equation 11).
Cutoff spread_cutoff(const Cutoff& cutoff, int dimension, double spread);

}  // namespace gaussdrift
