/// @file
/// Generalized interpolation: values with gradients (Hermite), and vector fields without divergence. Part of the library
/// rbf. Both are dense: for some thousand numbers.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "rbf/interpolant.hpp"

namespace rbf {

namespace detail {
template <int d>
struct FittedHermite;
template <int d>
struct FittedDivergenceFree;
}  // namespace detail

/// More numbers than these are refused by the classes of this header: the matrix is dense.
constexpr Eigen::Index most_generalized = 4000;

/// A function that takes values at some points and gradients at others, or at the same [Wen05, 16.2]:
///
///     s(y) = sum_j a_j phi(|y - x_j|) - sum_k b_k . grad phi(|y - z_k|) + constant
///
/// with the constant for multiquadric alone. Kernels without second derivatives at 0 are refused: thin_plate.
template <int d>
class HermiteInterpolant {
  static_assert(1 <= d && d <= 3, "rbf: dimensions 1 to 3");

 public:
  /// Fits.
  /// @param function      the kernel; a shape of 0 is chosen
  /// @param points        d x N, distinct; N >= 1 for multiquadric
  /// @param values        N
  /// @param slope_points  d x M, distinct, M >= 0
  /// @param gradients     M x d
  /// @param options       as of an Interpolant; the residual is measured in values, slopes times the typical spacing
  /// @throws InvalidArgument, IllConditioned, MemoryLimitError  as an Interpolant
  HermiteInterpolant(const Function& function, const Eigen::Ref<const Points<d>>& points,
                     const Eigen::Ref<const Eigen::VectorXd>& values, const Eigen::Ref<const Points<d>>& slope_points,
                     const Eigen::Ref<const Eigen::MatrixXd>& gradients, const FitOptions& options = {});

  /// D^alpha s at targets, |alpha| <= 1, anywhere; right to rounding.
  Eigen::VectorXd evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha = {}) const;
  /// What was done. left_out is of the values alone, each predicted from all other numbers. Of more than 500 values, 500
  /// are left out in turn.
  const FitReport& report() const;

 private:
  std::shared_ptr<const detail::FittedHermite<d>> fitted_;
};

/// A field that takes vectors at points and has no divergence anywhere [NW94]:
///
///     u(y) = sum_j Phi(y - x_j) gamma_j,    Phi = grad grad^T phi - Laplacian phi I
template <int d>
class DivergenceFreeInterpolant {
  static_assert(d == 2 || d == 3, "rbf: fields without divergence in 2 and 3 dimensions");

 public:
  /// Fits.
  /// @param function  the kernel, not thin_plate; a shape of 0 is chosen
  /// @param points    d x N, distinct, N >= 1
  /// @param vectors   N x d
  /// @param options   as of an Interpolant; regularisation is in units of Phi, which is 1/length^2 of those of phi
  /// @throws InvalidArgument, IllConditioned, MemoryLimitError  as an Interpolant
  DivergenceFreeInterpolant(const Function& function, const Eigen::Ref<const Points<d>>& points,
                            const Eigen::Ref<const Eigen::MatrixXd>& vectors, const FitOptions& options = {});

  /// u at targets, anywhere: M x d, right to rounding.
  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets) const;
  /// d u_k / d y_l at targets, anywhere, in column k + d l: M x d^2, right to rounding. Third derivatives of the kernel
  /// are summed over all pairs. With matern32 they jump at the points; there the mean of both sides is returned.
  Eigen::MatrixXd gradient(const Eigen::Ref<const Points<d>>& targets) const;
  /// gamma: N x d.
  const Eigen::MatrixXd& weights() const;
  /// The length of the error of each vector, predicted from the others: N numbers. NaN for those that were not left out:
  /// 500 are, evenly spread over all.
  const Eigen::VectorXd& left_out_errors() const;
  /// What was done. left_out has one number: the root mean square length of the errors of vectors, each predicted from
  /// the others. Of more than 500 vectors, 500 are left out in turn.
  const FitReport& report() const;

 private:
  std::shared_ptr<const detail::FittedDivergenceFree<d>> fitted_;
};

extern template class HermiteInterpolant<1>;
extern template class HermiteInterpolant<2>;
extern template class HermiteInterpolant<3>;
extern template class DivergenceFreeInterpolant<2>;
extern template class DivergenceFreeInterpolant<3>;

}  // namespace rbf
