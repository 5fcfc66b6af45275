#include "fgtd/density.hpp"

#include <cmath>
#include <numbers>

#include "fgtd/arguments.hpp"
#include "fgtd/check.hpp"

namespace fgtd {

namespace {

using detail::text;

/// Of the Gaussians of a rule, in units of the standard deviation of the points.
double factor_of(BandwidthRule rule, double number, int d) {
  const double exponent = -1.0 / (d + 4);
  return std::pow(rule == BandwidthRule::scott ? number : number * (d + 2) / 4, exponent);
}

/// The sum of the weights. Throws unless they are those of a density.
double sum_of(const Eigen::Ref<const Eigen::VectorXd>& weights) {
  for (Eigen::Index j = 0; j < weights.size(); ++j)
    if (!(weights(j) >= 0))
      throw InvalidArgument("fgtd: weights of a density must not be negative; weight " + std::to_string(j) + " is " +
                            text(weights(j)));
  const double sum = weights.sum();
  if (!(sum > 0) || !std::isfinite(sum))
    throw InvalidArgument("fgtd: the weights of a density have the sum " + text(sum) +
                          "; they must not be negative, and some must be positive and finite");
  return sum;
}

/// sum w (x - m)(x - m)^T / (W - sum w^2 / W), with W = sum w and m = sum w x / W: the mean of what samples give is the
/// covariance that they come from.
template <int d>
Covariance<d> covariance_of(const Eigen::Ref<const Points<d>>& points, const Eigen::Ref<const Eigen::VectorXd>& weights,
                            double sum, double number) {
  const Eigen::Matrix<double, d, 1> mean = points * weights / sum;
  Covariance<d> covariance = Covariance<d>::Zero();
  for (Eigen::Index j = 0; j < points.cols(); ++j) {
    const Eigen::Matrix<double, d, 1> from_mean = points.col(j) - mean;
    covariance.noalias() += weights(j) * from_mean * from_mean.transpose();
  }
  return covariance / (sum - sum / number);
}

}  // namespace

const std::vector<BandwidthRule>& bandwidth_rules() {
  static const std::vector<BandwidthRule> all{BandwidthRule::scott, BandwidthRule::silverman};
  return all;
}

std::string to_string(BandwidthRule rule) { return rule == BandwidthRule::scott ? "scott" : "silverman"; }

Eigen::VectorXd normalised_weights(const Eigen::Ref<const Eigen::VectorXd>& weights) {
  return weights / sum_of(weights);
}

template <int d>
Covariance<d> bandwidth_matrix(const Eigen::Ref<const Points<d>>& points,
                               const Eigen::Ref<const Eigen::VectorXd>& weights, const Bandwidth<d>& bandwidth) {
  if (const auto* matrix = std::get_if<Covariance<d>>(&bandwidth)) return *matrix;
  if (const auto* deviation = std::get_if<double>(&bandwidth)) {
    if (!(*deviation > 0) || !std::isfinite(*deviation))
      throw InvalidArgument("fgtd: bandwidth = " + text(*deviation) + ", must be positive and finite");
    return *deviation * *deviation * Covariance<d>::Identity();
  }
  const BandwidthRule rule = std::get<BandwidthRule>(bandwidth);
  detail::check_points("source", points.data(), d, static_cast<std::size_t>(points.cols()), detail::stride<d>(points),
                       1);
  detail::check_weights(weights, static_cast<std::size_t>(points.cols()), 1);
  const double sum = sum_of(weights), number = sum * sum / weights.squaredNorm();
  if (!(number > 1))
    throw InvalidArgument("fgtd: bandwidth \"" + to_string(rule) +
                          "\" needs the covariance of two points at least. Give a number or a matrix");
  const double factor = factor_of(rule, number, d);
  return factor * factor * covariance_of<d>(points, weights, sum, number);
}

template <int d>
Whitening<d>::Whitening(const Covariance<d>& covariance) : root_(Covariance<d>::Zero()) {
  constexpr double symmetry = 1e-8;  // of the largest entry
  if (!covariance.allFinite() ||
      (covariance - covariance.transpose()).cwiseAbs().maxCoeff() > symmetry * covariance.cwiseAbs().maxCoeff())
    throw InvalidArgument("fgtd: a matrix as bandwidth must be finite, symmetric and " + std::to_string(d) + " x " +
                          std::to_string(d));
  constexpr double rounding = 1e-13;  // what is left of a variance when that of other axes has gone
  for (int k = 0; k < d; ++k) {
    for (int l = 0; l < k; ++l)
      root_(k, l) = (covariance(k, l) - root_.row(k).head(l).dot(root_.row(l).head(l))) / root_(l, l);
    const double left = covariance(k, k) - root_.row(k).head(k).squaredNorm();
    if (!(covariance(k, k) > 0) || !(left > rounding * covariance(k, k)))
      throw InvalidArgument(
          "fgtd: the covariance of the Gaussians is not positive definite: the points lie in fewer than " +
          std::to_string(d) +
          " dimensions, or the bandwidth does. Give a number as bandwidth, or leave out coordinates");
    root_(k, k) = std::sqrt(left);
  }
}

template <int d>
Points<d> Whitening<d>::of(const Eigen::Ref<const Points<d>>& points) const {
  Points<d> white(d, points.cols());
  for (Eigen::Index j = 0; j < points.cols(); ++j)
    for (int k = 0; k < d; ++k) {
      double rest = points(k, j);
      for (int l = 0; l < k; ++l) rest -= root_(k, l) * white(l, j);
      white(k, j) = rest / root_(k, k);
    }
  return white;
}

template <int d>
bool Whitening<d>::keeps_axes() const {
  return root_.isDiagonal(0);
}

template <int d>
double Whitening<d>::peak() const {
  return std::pow(2 * std::numbers::pi, -0.5 * d) / root_.diagonal().prod();
}

template Covariance<1> bandwidth_matrix<1>(const Eigen::Ref<const Points<1>>&, const Eigen::Ref<const Eigen::VectorXd>&,
                                           const Bandwidth<1>&);
template Covariance<2> bandwidth_matrix<2>(const Eigen::Ref<const Points<2>>&, const Eigen::Ref<const Eigen::VectorXd>&,
                                           const Bandwidth<2>&);
template Covariance<3> bandwidth_matrix<3>(const Eigen::Ref<const Points<3>>&, const Eigen::Ref<const Eigen::VectorXd>&,
                                           const Bandwidth<3>&);
template Covariance<4> bandwidth_matrix<4>(const Eigen::Ref<const Points<4>>&, const Eigen::Ref<const Eigen::VectorXd>&,
                                           const Bandwidth<4>&);
template class Whitening<1>;
template class Whitening<2>;
template class Whitening<3>;
template class Whitening<4>;

}  // namespace fgtd
