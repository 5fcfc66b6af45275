// The equations of interpolation by a dense factorisation:
//
//     (A + ridge I) lambda + P b = f,   P^T lambda = 0
//
// with A = sign times the matrix of the kernel, P the polynomials of degree below its order. The columns of Q2 span what
// is orthogonal to P. Then lambda = Q2 y, and B = Q2^T (A + ridge I) Q2 is positive definite: B y = Q2^T f. [Wen05, 8.5]
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <vector>

#include "rbf/fit/frame.hpp"

namespace rbf::detail {

/// Of phi, and of the polynomials of a frame: a column for each column of values.
struct Coefficients {
  Eigen::MatrixXd weights, polynomial;
};

class DenseSystem {
 public:
  /// @param matrix       A; taken over
  /// @param polynomials  P: a row for each equation
  /// @param sign         of the kernel: weights are those of the kernel itself
  DenseSystem(Eigen::MatrixXd matrix, const Eigen::MatrixXd& polynomials, double sign, double ridge);

  /// Of a kernel at points.
  template <int d>
  static DenseSystem of(const Function& function, const Points<d>& points, const Frame<d>& frame, double ridge);

  /// Enough equations, and not all on a line or plane, for the polynomials to be determined.
  bool determines_polynomials() const { return determined_; }
  /// 1/condition of B in the norm of largest row sums, an estimate; 0 if B is not definite to rounding.
  double reciprocal_condition() const;

  Coefficients solve(const Eigen::MatrixXd& values) const;

  /// Rows of G, where weights = G values.
  Eigen::MatrixXd weight_rows(const std::vector<Eigen::Index>& rows) const;
  /// The likelihood of values that are Gaussian with the covariance tau^2 B, B as above, as far as they are orthogonal to P:
  /// what it depends on.
  struct Gaussian {
    Eigen::Index numbers = 0;    // m of them
    double log_determinant = 0;  // ln det B
    Eigen::RowVectorXd squares;  // f^T Q2 B^-1 Q2^T f of each column f
    /// ln of the density of column k for the tau that makes it largest: tau^2 = squares[k] / m.
    double log_likelihood(Eigen::Index k) const;
  };
  /// @param solution  what solve() has found for the values
  Gaussian gaussian(const Eigen::MatrixXd& values, const Coefficients& solution) const;

  /// Diagonal of G. Without value i the others predict it with the error weights_i / G_ii [Rip99].
  Eigen::VectorXd weight_diagonal() const;

 private:
  Eigen::MatrixXd reduced_rows(const std::vector<Eigen::Index>& rows) const;  // of Q2, as columns

  double sign_;
  bool determined_ = true;
  Eigen::HouseholderQR<Eigen::MatrixXd> polynomials_;
  Eigen::MatrixXd coupling_;  // Q1^T A Q2
  Eigen::LLT<Eigen::MatrixXd> factors_;
};

}  // namespace rbf::detail
