// Coefficients of a divergence-free Gaussian field from scattered samples of velocity or vorticity: the linear system
// (A + lambda a I) Gamma = samples, A_ij = matrix(x_i - x_j), a = the diagonal of A. A is symmetric and positive
// definite for distinct points, but the wider the Gaussians, the nearer A is to a singular matrix. method.md, section
// 9.
#pragma once

#include <fgtd/fgtd.hpp>

#include <string>

#include "field/gaussians/pairs.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

/// The Gaussians can hardly be told apart at the samples, or cancel. Regularisation cures that.
class GaussiansTooWide : public InputError {
 public:
  using InputError::InputError;
};

struct GaussianFitOptions {
  /// Wanted: |samples - (A + lambda a I) Gamma| / |samples| in the Euclidean norm; within (0, 1).
  double residual = 1e-6;
  double regularisation = 0;  // lambda >= 0: 0 interpolates the samples, more smooths them
  int most_iterations = 2000;
  int threads = 0;  // 0: all
};

struct GaussianFit {
  Eigen::MatrixXd coefficients;     // N x c
  std::string solver;               // "cholesky" or "conjugate gradients"
  int iterations = 0;               // conjugate gradients
  double residual = 0;              // reached, of the system, recomputed from the coefficients
  double misfit = 0;                // largest difference between field and sample, relative to the largest sample
  Eigen::VectorXd left_out_errors;  // of each sample: OverlappingBlocks::left_out_errors
  double left_out = 0;              // how well samples follow from the others: their size, relative to that of samples
};

/// matrix: `field` for samples of the velocity S, `vorticity` for samples of the vorticity of the curl form.
/// points   d x N, distinct;  samples  N x c with c = gaussian_columns(matrix, d) Up to
/// OverlappingBlocks::dense_unknowns unknowns by a dense factorisation, more by preconditioned conjugate gradients
/// over products with A. Throws InputError naming the samples if two points are equal, and if samples do not
/// follow from each other at all (too narrow). Throws GaussiansTooWide if the matrix is too near to singular or
/// the residual is not reached.
template <int d>
GaussianFit fit_gaussians(GaussianMatrix matrix, const fgtd::Points<d>& points, const Eigen::MatrixXd& samples,
                          double sigma, const GaussianFitOptions& options = {});

extern template GaussianFit fit_gaussians<2>(GaussianMatrix, const fgtd::Points<2>&, const Eigen::MatrixXd&, double,
                                             const GaussianFitOptions&);
extern template GaussianFit fit_gaussians<3>(GaussianMatrix, const fgtd::Points<3>&, const Eigen::MatrixXd&, double,
                                             const GaussianFitOptions&);

}  // namespace gaussdrift
