// Bandwidths and whitening of density estimates, against sums that are written out.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>

#include "fgtd/density.hpp"
#include "message_of.hpp"

namespace fgtd {
namespace {

using gaussdrift::message_of;

template <int d>
Points<d> cloud(Eigen::Index count) {
  std::mt19937_64 random(d);
  std::normal_distribution<double> normal;
  Points<d> points = Points<d>::NullaryExpr(d, count, [&] { return normal(random); });
  for (int k = 1; k < d; ++k) points.row(k) += 0.7 * points.row(k - 1);
  return points.array() + 3;
}

/// The covariance of weighted samples, entry by entry.
template <int d>
double entry(const Points<d>& x, const Eigen::VectorXd& w, int i, int k) {
  const double all = w.sum(), mean_i = x.row(i).dot(w) / all, mean_k = x.row(k).dot(w) / all;
  double sum = 0;
  for (Eigen::Index j = 0; j < x.cols(); ++j) sum += w(j) * (x(i, j) - mean_i) * (x(k, j) - mean_k);
  return sum / (all - w.squaredNorm() / all);
}

template <int d>
void check_rules() {
  const Points<d> x = cloud<d>(50);
  const Eigen::VectorXd w = Eigen::VectorXd::LinSpaced(50, 0, 3);
  const double n = w.sum() * w.sum() / w.squaredNorm();
  for (const BandwidthRule rule : bandwidth_rules()) {
    const double base = rule == BandwidthRule::scott ? n : n * (d + 2) / 4, factor = std::pow(base, -1.0 / (d + 4));
    const Covariance<d> matrix = bandwidth_matrix<d>(x, w, rule);
    for (int i = 0; i < d; ++i)
      for (int k = 0; k < d; ++k)
        EXPECT_NEAR(matrix(i, k), factor * factor * entry<d>(x, w, i, k), 1e-14) << to_string(rule) << d;
    EXPECT_NEAR((bandwidth_matrix<d>(x, 7 * w, rule) - matrix).norm(), 0, 1e-14);  // the sum of weights does not matter
  }
}

TEST(DensityEstimate, TakesTheFactorOfARuleTimesTheCovariance) {
  check_rules<1>();
  check_rules<2>();
  check_rules<3>();
  check_rules<4>();
}

TEST(DensityEstimate, WhitensAGaussianToARoundOne) {
  Covariance<3> covariance;
  covariance << 2, 0.5, -0.3, 0.5, 1, 0.2, -0.3, 0.2, 0.7;
  const Whitening<3> whitening(covariance);
  EXPECT_LT((whitening.root() * whitening.root().transpose() - covariance).norm(), 1e-15);
  EXPECT_FALSE(whitening.keeps_axes());
  const Points<3> x = cloud<3>(20), z = whitening.of(x);
  for (Eigen::Index j = 0; j < x.cols(); ++j)
    EXPECT_NEAR(z.col(j).squaredNorm(), x.col(j).dot(covariance.inverse() * x.col(j)), 1e-13);
  EXPECT_NEAR(whitening.peak(), 1 / std::sqrt(std::pow(2 * std::numbers::pi, 3) * covariance.determinant()), 1e-15);
  const Whitening<3> diagonal(Covariance<3>(covariance.diagonal().asDiagonal()));
  EXPECT_TRUE(diagonal.keeps_axes());
  EXPECT_EQ(diagonal.of(x)(1, 0), x(1, 0));  // its variance is 1
}

TEST(DensityEstimate, RefusesWhatHasNoDensity) {
  const auto refusal = [](const auto& call) { return message_of<InvalidArgument>(call); };
  Points<2> line(2, 9);
  for (int j = 0; j < 9; ++j) line.col(j) << 0.1 * j, 0.3 * j + 1;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(9);
  EXPECT_NE(refusal([&] {
              Whitening<2>(bandwidth_matrix<2>(line, ones, BandwidthRule::scott));
            }).find("not positive definite: the points lie in fewer than 2 dimensions"),
            std::string::npos);
  Covariance<2> matrix;
  matrix << 1, 2, 2, 1;
  EXPECT_NE(refusal([&] { Whitening<2>{matrix}; }).find("not positive definite"), std::string::npos);
  matrix << 1, 0.5, 0, 1;
  EXPECT_NE(refusal([&] { Whitening<2>{matrix}; }).find("symmetric and 2 x 2"), std::string::npos);
  matrix << 1, NAN, NAN, 1;
  EXPECT_NE(refusal([&] { Whitening<2>{matrix}; }).find("must be finite"), std::string::npos);
  EXPECT_NE(refusal([&] { bandwidth_matrix<2>(line, ones, 0.0); }).find("bandwidth = 0, must be positive"),
            std::string::npos);
  EXPECT_NE(refusal([&] { bandwidth_matrix<2>(line, -ones, BandwidthRule::scott); }).find("weight 0 is -1"),
            std::string::npos);
  EXPECT_NE(refusal([&] { normalised_weights(0 * ones); }).find("have the sum 0"), std::string::npos);
  EXPECT_NE(refusal([&] {
              bandwidth_matrix<2>(line, Eigen::VectorXd::Unit(9, 3), BandwidthRule::silverman);
            }).find("two points at least"),
            std::string::npos);
  EXPECT_NE(refusal([&] { bandwidth_matrix<2>(line, ones.head(8), BandwidthRule::scott); }).find("weights have 8 rows"),
            std::string::npos);
}

}  // namespace
}  // namespace fgtd
