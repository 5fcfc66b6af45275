// A preconditioner for the systems of fit_gaussians(). It inverts the matrix exactly on small overlapping sets of
// neighbouring points and adds the results up (additive Schwarz, [SBG96]). Gaussians a few spacings wide couple near
// points strongly and far ones hardly, so this removes most of the bad condition.
#pragma once

#include <fgtd/fgtd.hpp>

#include <Eigen/Cholesky>
#include <vector>

#include "field/gaussians/pairs.hpp"

namespace gaussdrift {

template <int d>
class OverlappingBlocks {
 public:
  /// Up to so many unknowns are one block, and solve() is exact.
  static constexpr Eigen::Index dense_unknowns = 1000;
  /// Otherwise blocks of up to `core` points, each with the nearest points around it up to `block_points`. Larger
  /// blocks save iterations and cost memory: 2 MB a block in two dimensions, 4 MB in three.
  static constexpr std::size_t core = 80, block_points = 240;

  /// `shift` is added to the diagonal. Throws InputError if the factors would take more than memory_limit bytes.
  OverlappingBlocks(GaussianMatrix matrix, const fgtd::Points<d>& points, double sigma, double shift, int threads,
                    std::size_t memory_limit = std::size_t{4} << 30);

  /// x and the result: column after column of N x c coefficients. Symmetric and positive definite.
  Eigen::VectorXd solve(const Eigen::VectorXd& x) const;
  bool is_exact() const { return blocks_.size() == 1; }

  /// The reciprocal condition of the worst block, 0 if it is not definite to rounding. The whole matrix is not better.
  double reciprocal_condition() const;

  /// The length of the error of each sample that is predicted by a fit to the rest of its block [Rip99]. NaN where it was
  /// not left out: samples of at most 24 blocks are.
  Eigen::VectorXd left_out_errors(const Eigen::VectorXd& samples) const;

 private:
  struct Block {
    std::vector<Eigen::Index> points;  // ascending
    std::vector<Eigen::Index> own;     // places among `points` that belong to no other block
    Eigen::LLT<Eigen::MatrixXd> factors;
  };
  Eigen::VectorXd gathered(const Block& block, const Eigen::VectorXd& x) const;

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
