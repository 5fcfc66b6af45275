/// @file
/// Densities from points (kernel density estimation): how wide the Gaussians are, and coordinates in which they are round.
/// Part of the library fgtd.
#pragma once

#include <Eigen/Core>
#include <fgtd/fgtd.hpp>
#include <string>
#include <variant>
#include <vector>

namespace fgtd {

/// Rules that choose the covariance of the Gaussians from the points: the square of a factor times the covariance of the
/// points. n = (sum w)^2 / sum w^2 is the number of points, as weights w let them count.
enum class BandwidthRule {
  scott,     ///< n^(-1/(d+4)) [Sco92]
  silverman  ///< (n (d+2)/4)^(-1/(d+4)) [Sil86]
};

/// All of them.
const std::vector<BandwidthRule>& bandwidth_rules();
/// The name as it is written in files: "scott", "silverman".
std::string to_string(BandwidthRule rule);

/// The covariance of a Gaussian, in length^2 of the points.
template <int d>
using Covariance = Eigen::Matrix<double, d, d>;

/// A rule, the standard deviation along every axis, or the covariance.
template <int d>
using Bandwidth = std::variant<BandwidthRule, double, Covariance<d>>;

/// The covariance of the Gaussian around every point.
/// @param points     d x N, finite, N > 0
/// @param weights    N, not negative, some of them positive; for rules alone. Their sum does not matter
/// @param bandwidth  a rule, a number, or a matrix, which is returned
/// @throws InvalidArgument  also for a rule and fewer than two points with a weight
template <int d>
Covariance<d> bandwidth_matrix(const Eigen::Ref<const Points<d>>& points,
                               const Eigen::Ref<const Eigen::VectorXd>& weights, const Bandwidth<d>& bandwidth);

/// Weights that are not negative, divided by their sum: what a density has.
/// @throws InvalidArgument  for a negative one, and where their sum is 0 or not finite
Eigen::VectorXd normalised_weights(const Eigen::Ref<const Eigen::VectorXd>& weights);

/// Coordinates z = L^-1 x, for a covariance C = L L^T. In them exp(-x^T C^-1 x / 2) is the round Gaussian exp(-sigma |z|^2)
/// with sigma = 1/2, which a Plan sums.
template <int d>
class Whitening {
  static_assert(1 <= d && d <= 4, "fgtd: dimensions 1 to 4");

 public:
  /// sigma in these coordinates.
  static constexpr double sigma = 0.5;

  /// @throws InvalidArgument  unless the covariance is finite, symmetric and, beyond rounding, positive definite
  explicit Whitening(const Covariance<d>& covariance);

  /// L, lower triangular.
  const Covariance<d>& root() const { return root_; }
  /// Points d x N in these coordinates.
  Points<d> of(const Eigen::Ref<const Points<d>>& points) const;
  /// Is L diagonal? Then a tensor grid is one in these coordinates too, its axes divided by the diagonal of L.
  bool keeps_axes() const;
  /// The largest value of the Gaussian with integral 1: (2 pi)^(-d/2) / det L, in 1/length^d.
  double peak() const;

 private:
  Covariance<d> root_;
};

}  // namespace fgtd
