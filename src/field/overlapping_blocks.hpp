// A preconditioner for the systems of fit_gaussians(): the matrix inverted exactly on small sets of neighbouring points
// that overlap, and the results added up (additive Schwarz, [SBG96]). Gaussians a few spacings wide couple near points
// strongly and far ones hardly, so this takes away what makes the system ill-conditioned.
#pragma once

#include <fgtd/fgtd.hpp>

#include <Eigen/Cholesky>
#include <vector>

#include "field/gaussian_pairs.hpp"

namespace gaussdrift {

template <int d>
class OverlappingBlocks {
 public:
  /// Blocks of `core` points or a few less, each with the nearest points around it up to `block_points`.
  static constexpr std::size_t core = 128, block_points = 320;

  /// `shift` is added to the diagonal. Throws InputError if the factors would take more than memory_limit bytes.
  OverlappingBlocks(GaussianMatrix matrix, const fgtd::Points<d>& points, double sigma, double shift, int threads,
                    std::size_t memory_limit = std::size_t{4} << 30);

  /// x and the result: column after column of N x c coefficients. Symmetric and positive definite.
  Eigen::VectorXd solve(const Eigen::VectorXd& x) const;

 private:
  struct Block {
    std::vector<Eigen::Index> points;
    Eigen::LLT<Eigen::MatrixXd> factors;
  };
  std::vector<Block> blocks_;
  Eigen::Index count_, columns_;
  int threads_;
};

/// The matrix of some points: rows and columns as in OverlappingBlocks::solve.
template <int d>
Eigen::MatrixXd dense_gaussian_matrix(GaussianMatrix matrix, const fgtd::Points<d>& points, double sigma, double shift);

extern template class OverlappingBlocks<2>;
extern template class OverlappingBlocks<3>;
extern template Eigen::MatrixXd dense_gaussian_matrix<2>(GaussianMatrix, const fgtd::Points<2>&, double, double);
extern template Eigen::MatrixXd dense_gaussian_matrix<3>(GaussianMatrix, const fgtd::Points<3>&, double, double);

}  // namespace gaussdrift
