// Sums of Gaussians whose width is told otherwise than by sigma, and densities from points: both become a sum of round
// Gaussians of the library fgtd (docs/usage.md, "Densities from points").
#pragma once

#include <string>

#include "sum/points.hpp"

namespace gaussdrift::sum {

struct GaussianShape {
  /// "scott", "silverman", a standard deviation "0.2", or a covariance row by row "1,0.5,0.5,1". Empty: sigma.
  std::string bandwidth = {};
  /// Divides the weights by their sum and the Gaussian by its integral: the sum is a density with the integral 1.
  bool normalised = false;
};

/// sum_points() of Gaussians of this shape, for the weights as they are or normalised. Throws CommandLineError for a
/// bandwidth that is none, or none for these coordinates; InputError for weights and points that have no density.
PointSums sum_shaped(SumRequest request, const GaussianShape& shape);

}  // namespace gaussdrift::sum
