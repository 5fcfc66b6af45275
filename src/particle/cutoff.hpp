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

/// zeta_eps(x) = eps^-d zeta(x / eps) for core radius eps > 0. Throws std::out_of_range for an unknown name.
///   gauss2   pi^{-d/2} exp(-|x|^2)
///   gauss4   (1 - Laplacian/4) of it; in 2D (2 - r^2) exp(-r^2) / pi
Cutoff make_cutoff(std::string_view name, int dimension, double core_radius);

}  // namespace gaussdrift
