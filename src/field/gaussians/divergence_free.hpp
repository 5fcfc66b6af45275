// Divergence-free fields made of Gaussians [Sch06, ch. 6], method.md, section 9: with phi = exp(-sigma r^2),
//   S(y) = sum_k Phi(y - x_k) Gamma_k,   Phi = grad grad^T phi - Laplacian phi I    [Sch06, 6.3]
//   u(y) = sum_k grad phi(y - x_k) x Gamma_k,   the velocity whose vorticity is S    [Sch06, 6.2]
// and their derivatives, by fgtd or, where that is faster, pair by pair.
#pragma once

#include <fgtd/fgtd.hpp>

#include <optional>
#include <string>
#include <vector>

#include "field/gaussians/pairs.hpp"

namespace gaussdrift {

/// One entry of a matrix Gaussian: row and column, and the derivatives of phi that make it.
template <int d>
struct MatrixEntry {
  int row = 0, column = 0;
  fgtd::Combination<d> combination;
};

template <int d>
std::vector<MatrixEntry<d>> matrix_entries(GaussianMatrix matrix);

struct GaussianSumOptions {
  double tolerance = 1e-8;  // of each Gaussian term, as fgtd::Options::tolerance
  /// Of phi: 1 for `curl`, 2 for `field` and `vorticity`, and as many more as are asked of these.
  int derivative_order = 2;
  /// automatic: pairs or fgtd, whichever is predicted to be faster; direct: pairs.
  fgtd::Method method = fgtd::Method::automatic;
  int threads = 0;                                      // 0: all
  std::size_t expected_targets = 0;                     // for the choice only; 0: as many as sources
  std::optional<fgtd::HermiteParameters> hermite = {};  // as fgtd::Options::hermite
};

/// The divergence of a sum at some targets, and the size of the terms that cancel in it.
struct Divergence {
  Eigen::VectorXd value;  // sum_i d_i S_i
  Eigen::VectorXd terms;  // sum_ij |sum_k d_i Phi_ij Gamma_kj|
};

/// A prepared sum over the sources x_k. One fgtd plan with a column of weights a component of Gamma serves all
/// components and derivatives: "d preparations for all of S" [Sch06, 6.5]. Results do not depend on the number of
/// threads.
template <int d>
class GaussianSum {
  static_assert(d == 2 || d == 3);

 public:
  /// points        d x N, finite
  /// coefficients  N x c, Gamma_k as rows; c = d, or c = 1 for `curl` and `vorticity` in two dimensions
  /// Throws the errors of fgtd::Plan.
  GaussianSum(const fgtd::Points<d>& points, const Eigen::MatrixXd& coefficients, double sigma,
              const GaussianSumOptions& options = {});

  /// All components, differentiated by alpha: M x rows of the matrix.
  Eigen::MatrixXd evaluate(GaussianMatrix matrix, const fgtd::Points<d>& targets,
                           const fgtd::Derivative<d>& alpha = {}) const;
  /// One component alone.
  Eigen::VectorXd component(GaussianMatrix matrix, int row, const fgtd::Points<d>& targets,
                            const fgtd::Derivative<d>& alpha = {}) const;
  /// The divergence of D^alpha of the sum (`field` or `curl`), with a derivative of its own for each term. It needs one
  /// derivative more.
  Divergence divergence(GaussianMatrix matrix, const fgtd::Points<d>& targets,
                        const fgtd::Derivative<d>& alpha = {}) const;

  void set_coefficients(const Eigen::MatrixXd& coefficients);

  /// The error of `matrix` anywhere for a tolerance of 1: sum |Gamma_k| N within reach of a point, an upper bound.
  double unit_error(GaussianMatrix matrix) const;

  bool pairwise() const { return pairwise_; }
  std::size_t sources() const { return static_cast<std::size_t>(coefficients_.rows()); }
  /// What was chosen, one line.
  std::string choice() const;

 private:
  Eigen::MatrixXd sum_entries(const std::vector<MatrixEntry<d>>& entries, int rows, const fgtd::Points<d>& targets,
                              const fgtd::Derivative<d>& alpha) const;

  std::vector<double> position_;  // [d][N]
  Eigen::MatrixXd coefficients_;
  double sigma_;
  int threads_;
  fgtd::Plan<d> plan_;
  bool pairwise_;
};

extern template class GaussianSum<2>;
extern template class GaussianSum<3>;

}  // namespace gaussdrift
