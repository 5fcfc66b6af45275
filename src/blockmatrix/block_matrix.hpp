// Matrices of kernel values at points on a line, kept in blocks of low rank: N log N numbers in place of N^2. The
// construction of [Mel08, exercises 3 to 7]; docs/farfield.md, "Matrices in blocks", has what came out.
//
//   const blockmatrix::BlockMatrix matrix(blockmatrix::log_kernel, points, {.degree = 5});
//   const Eigen::VectorXd y = matrix * x;
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "farfield/farfield.hpp"

namespace gaussdrift::blockmatrix {

/// K(x, y) for x != y.
using LineKernel = double (*)(double x, double y);

/// ln |x - y|, [Mel08, (2)].
double log_kernel(double x, double y);
/// e^(x + y), [Mel08, (3)]: smooth, so that one block of low rank is the whole matrix.
double smooth_kernel(double x, double y);

/// Chebyshev points of an interval, degree + 1 of them: its zeros.
Eigen::VectorXd chebyshev_points(int degree, double low, double high);
/// Lagrange polynomials of the Chebyshev points of [low, high] at x: x.size() x (degree + 1). An interval of one point
/// has one polynomial 1 and else 0. Throws farfield::InvalidArgument for a degree below 0 or above 40.
Eigen::MatrixXd lagrange_matrix(int degree, double low, double high, const Eigen::Ref<const Eigen::VectorXd>& x);

/// M with M_ij = K(x_i, x_j) interpolated on the bounding interval of the points in both variables: W S V^T of rank
/// degree + 1, [Mel08, (4)]. W = V for one set of points.
struct LowRank {
  Eigen::MatrixXd w, s, v;  // rows x rank, rank x rank, columns x rank

  Eigen::MatrixXd dense() const { return w * s * v.transpose(); }
};
LowRank interpolate_kernel(LineKernel kernel, int degree, const Eigen::Ref<const Eigen::VectorXd>& rows,
                           const Eigen::Ref<const Eigen::VectorXd>& columns);

/// Rows and columns begin .. end (not included), either exact or of low rank.
struct Block {
  std::size_t row_begin, row_end, column_begin, column_end;
  bool low_rank;

  std::size_t rows() const { return row_end - row_begin; }
  std::size_t columns() const { return column_end - column_begin; }
};

/// The greedy list of [Mel08, exercise 5]: a block of one row or one column is exact; one whose bounding intervals
/// satisfy max diam <= dist / 2 [Mel08, (6)] is of low rank; any other is divided into four. points     ascending,
/// finite, at least one leaf_size  blocks of at most so many rows or columns are exact; 1 as on the sheet Throws
/// InvalidArgument.
std::vector<Block> block_list(const Eigen::Ref<const Eigen::VectorXd>& points, std::size_t leaf_size = 1);

enum class Bases {
  of_blocks,  // W and V for every block, as on the sheet
  shared      // one matrix for every set of indices, used by all blocks that it is the rows or columns of
};

struct BlockOptions {
  int degree = 3;  // n: blocks have rank n + 1; 0 <= n <= 40
  std::size_t leaf_size = 1;
  Bases bases = Bases::of_blocks;
  std::size_t memory_limit = std::size_t{8} << 30;  // bytes
};

/// Numbers that the blocks need: |I| |J| for exact ones, (|I| + |J|) (n + 1) + (n + 1)^2 for others; with shared bases
/// (n + 1)^2 and |I| (n + 1) for every set of indices.
std::size_t storage(const std::vector<Block>& blocks, int degree, Bases bases = Bases::of_blocks);

/// Immutable; zeros on the diagonal, and wherever points are equal.
class BlockMatrix {
 public:
  /// Throws farfield::InvalidArgument, and MemoryLimitError before anything large is allocated.
  BlockMatrix(LineKernel kernel, const Eigen::Ref<const Eigen::VectorXd>& points, const BlockOptions& options = {});

  Eigen::Index size() const { return points_.size(); }
  const std::vector<Block>& blocks() const { return blocks_; }
  /// Numbers that are kept.
  std::size_t storage() const { return blockmatrix::storage(blocks_, options_.degree, options_.bases); }

  /// x  size(). Throws farfield::InvalidArgument.
  Eigen::VectorXd operator*(const Eigen::Ref<const Eigen::VectorXd>& x) const;
  /// Every entry, size() x size().
  Eigen::MatrixXd dense() const;
  /// sum_ij (M_ij - K(x_i, x_j))^2, block by block: the exact ones have none.
  double squared_error() const;

 private:
  using Basis = std::size_t;  // place in bases_

  LineKernel kernel_;
  BlockOptions options_;
  Eigen::VectorXd points_;
  std::vector<Block> blocks_;
  std::vector<double> numbers_;     // F or S of the blocks, one after the other, column by column
  std::vector<std::size_t> first_;  // of each block in numbers_
  std::vector<Eigen::MatrixXd> bases_;
  std::vector<Basis> row_basis_, column_basis_;  // of blocks of low rank
  std::vector<std::pair<std::size_t, std::size_t>> basis_range_;
};

/// M_ij = m_{i-j}, multiplied in N log N by the fast Fourier transform [Mel08, exercise 7].
class ToeplitzMatrix {
 public:
  /// column  M_11, M_21, ..., M_N1
  /// row     M_11, M_12, ..., M_1N; the same length and first entry, at least one. Throws farfield::InvalidArgument.
  ToeplitzMatrix(const Eigen::Ref<const Eigen::VectorXd>& column, const Eigen::Ref<const Eigen::VectorXd>& row);

  Eigen::Index size() const { return size_; }
  /// x  size(). Throws farfield::InvalidArgument.
  Eigen::VectorXd operator*(const Eigen::Ref<const Eigen::VectorXd>& x) const;

 private:
  struct Transform;

  Eigen::Index size_;
  std::shared_ptr<const Transform> transform_;  // never changed once made
};

}  // namespace gaussdrift::blockmatrix
