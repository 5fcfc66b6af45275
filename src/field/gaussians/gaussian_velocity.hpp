// Velocity fields made of Gaussians, divergence-free by construction [Sch06, ch. 6]: from coefficients, or fitted to
// scattered samples of a velocity or of a vorticity. method.md, section 9.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "field/gaussians/divergence_free_fit.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// The meaning of the numbers beside the points.
enum class GaussianKind {
  velocity,           // samples of u; the field is S, fitted
  vorticity,          // samples of curl u; the field is the curl form, fitted
  coefficients,       // Gamma_k of S
  curl_coefficients,  // Gamma_k of the curl form
};

/// Are the numbers samples, to which coefficients are fitted?
constexpr bool is_fitted(GaussianKind kind) {
  return kind == GaussianKind::velocity || kind == GaussianKind::vorticity;
}

/// Numbers a point: `dimension`, but 1 in two dimensions for a vorticity and the coefficients of the curl form.
int gaussian_values(GaussianKind kind, int dimension);

constexpr std::array<std::string_view, 4> gaussian_kind_names{"velocity", "vorticity", "coefficients",
                                                              "curl-coefficients"};

/// Names of the columns of a table of points: coordinates, then the numbers beside them.
std::vector<std::string> gaussian_columns_of(GaussianKind kind, int dimension);

struct GaussianModelOptions {
  GaussianKind kind = GaussianKind::velocity;
  double width = 0;         // of phi = exp(-r^2 / width^2), sigma = 1/width^2; 0: default_gaussian_width
  double tolerance = 1e-8;  // of the velocity, relative to the largest at and near the points
  bool regularise = false;  // where Gaussians are too wide, by the least of 1e-12, 1e-10, 1e-8 and 1e-6 that will do
  GaussianFitOptions fit = {};
};

/// A field that is ready to be evaluated: points, coefficients, and facts about them. Plain data.
struct GaussianModel {
  int dimension = 2;
  GaussianMatrix matrix = GaussianMatrix::field;  // or curl
  double width = 1;
  double regularisation = 0;         // of the fit
  double term_tolerance = 1e-8;      // of fgtd, so that the field keeps its tolerance
  std::vector<double> positions;     // [point][dimension]
  std::vector<double> coefficients;  // [point][components]
  std::vector<double> errors;        // of the velocity near each position, estimated; NaN: not known; empty: no fit
  std::string about;                 // one line for people
};

/// Twice the average spacing (V/N)^(1/d) of the points in their bounding box: wide enough that the Gaussians overlap,
/// narrow enough that the fit is well-conditioned.
double default_gaussian_width(int dimension, const std::vector<double>& positions);

/// positions  [point][dimension], at least one;  values  [point][gaussian_values]
/// Throws InputError if the fit fails, or if the Gaussians cancel so far that the tolerance cannot be kept, with any
/// regularisation that may be tried.
GaussianModel make_gaussian_model(int dimension, const std::vector<double>& positions,
                                  const std::vector<double>& values, const GaussianModelOptions& options);

/// expected_targets: points that are evaluated at once, for the choice of method only. threads: 0 for all.
std::unique_ptr<VelocityField> make_gaussian_velocity(const GaussianModel& model, std::size_t expected_targets,
                                                      int threads);

}  // namespace gaussdrift
