// Velocity fields made of Gaussians, divergence-free by construction [Sch06, ch. 6]: from coefficients, or fitted to
// scattered samples of a velocity or of a vorticity. method.md, section 7.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "field/divergence_free_fit.hpp"
#include "field/velocity.hpp"

namespace gaussdrift {

/// What the numbers beside the points are.
enum class GaussianKind {
  velocity,           // samples of u; the field is S, fitted
  vorticity,          // samples of curl u; the field is the curl form, fitted
  coefficients,       // Gamma_k of S
  curl_coefficients,  // Gamma_k of the curl form
};

/// Numbers a point: `dimension`, but 1 in two dimensions for a vorticity and the coefficients of the curl form.
int gaussian_values(GaussianKind kind, int dimension);

struct GaussianVelocityOptions {
  GaussianKind kind = GaussianKind::velocity;
  double width = 0;         // of phi = exp(-r^2 / width^2), sigma = 1/width^2; 0: default_gaussian_width
  double tolerance = 1e-8;  // of the velocity, relative to the largest at the points
  GaussianFitOptions fit = {};
  int threads = 0;                   // 0: all
  std::size_t expected_targets = 0;  // for the choice of method only; 0: as many as points
};

/// Twice the average spacing (V/N)^(1/d) of the points in their bounding box: wide enough that the Gaussians overlap,
/// narrow enough that the fit is well-conditioned.
double default_gaussian_width(int dimension, const std::vector<double>& positions);

/// positions  [point][dimension];  values  [point][gaussian_values]
/// Throws InputError if the fit fails, or if the Gaussians cancel so far that the tolerance cannot be kept.
std::unique_ptr<VelocityField> make_gaussian_velocity(int dimension, const std::vector<double>& positions,
                                                      const std::vector<double>& values,
                                                      const GaussianVelocityOptions& options);

}  // namespace gaussdrift
