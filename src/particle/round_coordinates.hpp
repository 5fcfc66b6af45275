// Blobs that are ellipses, all of one shape: a linear change of coordinates makes them round, so that their sum is a
// Gauss transform. docs/method.md, section 8.2.
#pragma once

#include <vector>

#include "particle/cutoff.hpp"

namespace gaussdrift {

/// y = map x, a lower triangular matrix.
struct RoundCoordinates {
  Tensor map{};

  /// Axes stay what they are, and only their units change: a tensor grid is one in y as well.
  bool keeps_axes() const;
  Vector of(const Vector& x) const;
};

/// The coordinates in which the Gaussian of this term is exp(-|y|^2).
RoundCoordinates round_coordinates(const CutoffTerm& term);

/// D^derivative along x as a sum of derivatives along y, with their coefficients.
std::vector<CutoffTerm> derivative_along(const std::array<int, max_dimension>& derivative,
                                         const RoundCoordinates& coordinates);

}  // namespace gaussdrift
