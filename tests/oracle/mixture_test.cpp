// Several Gaussians of one sum: is every one as accurate as it promises when they share a lattice?
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fgtd/mixture.hpp"
#include "oracle/naive.hpp"

namespace {

/// Widths that differ by 300, strict and lax tolerances, and weights of both signs.
std::vector<fgtd::Gaussian> gaussians() {
  return {{.sigma = 2e4, .coefficient = -0.7, .tolerance = 3e-4},
          {.sigma = 0.3, .coefficient = 1, .tolerance = 1e-9},
          {.sigma = 8, .coefficient = -2, .tolerance = 4e-8},
          {.sigma = 90, .coefficient = 5, .tolerance = 1e-7},
          {.sigma = 700, .coefficient = 1, .tolerance = 2e-5}};
}

/// Two dense squares far apart and a haze around them, and 6 sources with a weight in a column of their own.
template <int d>
fgtd::Points<d> clusters(int count) {
  fgtd::Points<d> points = naive::random_points<d>(count, 3, -1, 2);
  for (int j = 0; j < count; ++j) {
    if (j % 3 == 1) points.col(j) = points.col(j) * 0.02 + fgtd::Points<d>::Constant(d, 1, 0.9);
    if (j % 3 == 2) points.col(j) = points.col(j) * 0.05 - fgtd::Points<d>::Constant(d, 1, 0.6);
  }
  return points;
}
Eigen::MatrixXd one_source_a_column(int count) {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(count, 6);
  for (int k = 0; k < 6; ++k) weights(k * 7, k) = 1;
  return weights;
}

/// The sum by definition, and what its error may be: the parts of all Gaussians and rounding.
template <int d>
struct Wanted {
  Eigen::MatrixXd values;
  double allowed = 0;

  Wanted(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights, const fgtd::Points<d>& targets,
         const fgtd::Derivative<d>& alpha)
      : values(Eigen::MatrixXd::Zero(targets.cols(), weights.cols())) {
    for (const fgtd::Gaussian& of : gaussians()) {
      values += of.coefficient * naive::sum<d>(sources, weights, of.sigma, targets, alpha);
      allowed += (of.tolerance + 1e-13) * std::abs(of.coefficient) * fgtd::derivative_scale<d>(alpha, of.sigma);
    }
  }
};

template <int d>
void expect_promise_kept(int count, int targets_an_axis) {
  const fgtd::Points<d> sources = clusters<d>(count);
  const Eigen::MatrixXd weights = one_source_a_column(count);
  const fgtd::TensorGrid grid = naive::cube_grid<d>(targets_an_axis, -1.3, 1.4);
  fgtd::Points<d> targets = naive::points_of<d>(grid);
  for (int i = 0; i < 30; ++i) targets.col(i) = sources.col(i * 3) + fgtd::Points<d>::Constant(d, 1, i * 1e-3);
  fgtd::Points<d> six(d, 6);  // all that have weights
  for (int k = 0; k < 6; ++k) six.col(k) = sources.col(k * 7);
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(6, 6);
  for (const int order : {0, 2}) {
    const fgtd::Mixture<d> mixture(sources, weights, gaussians(),
                                   {.derivative_order = order, .expected_targets = 100000});
    const std::set<std::size_t> groups(mixture.groups().begin(), mixture.groups().end());
    ASSERT_LT(groups.size(), gaussians().size());  // else this tests nothing
    for (std::size_t k = 0; k < gaussians().size(); ++k)
      EXPECT_LE(mixture.choices()[k].bound.value(), gaussians()[k].tolerance);
    std::vector<fgtd::Derivative<d>> derivatives{{}};
    if (order == 2) {
      derivatives = naive::derivatives_of_order<d>(2);
      derivatives.push_back({1});
    }
    std::vector<fgtd::Combination<d>> combinations;
    for (const auto& alpha : derivatives) combinations.push_back({{alpha, 1.0}});
    const Eigen::MatrixXd at_points = mixture.evaluate_combinations(targets, combinations),
                          on_grid = mixture.evaluate_combinations(grid, combinations);
    for (std::size_t q = 0; q < derivatives.size(); ++q) {
      const Wanted<d> points(six, unit, targets, derivatives[q]);
      const Wanted<d> nodes(six, unit, naive::points_of<d>(grid), derivatives[q]);
      const Eigen::Index column = static_cast<Eigen::Index>(q) * 6;
      EXPECT_LE((at_points.middleCols(column, 6) - points.values).cwiseAbs().maxCoeff(), points.allowed) << q;
      EXPECT_LE((on_grid.middleCols(column, 6) - nodes.values).cwiseAbs().maxCoeff(), nodes.allowed) << q;
    }
  }
}

TEST(Mixture, KeepsThePromiseOfEveryGaussianInOneDimension) { expect_promise_kept<1>(20000, 601); }
TEST(Mixture, KeepsThePromiseOfEveryGaussianInTwoDimensions) { expect_promise_kept<2>(20000, 31); }
TEST(Mixture, KeepsThePromiseOfEveryGaussianInThreeDimensions) { expect_promise_kept<3>(20000, 7); }

TEST(Mixture, IsTheSumOfItsPlansWithOtherWeightsAndMethodsToo) {
  const fgtd::Points<2> sources = clusters<2>(3000), targets = naive::random_points<2>(200, 4, -1.2, 1.2);
  const Eigen::MatrixXd weights = naive::random_weights(3000, 2, 5);
  for (const fgtd::Method method : fgtd::methods()) {
    fgtd::Mixture<2> mixture(sources, naive::random_weights(3000, 1, 6), gaussians(),
                             {.derivative_order = 1, .method = method, .expected_targets = 100000});
    mixture.set_weights(weights);
    const Eigen::MatrixXd found = mixture.evaluate_combinations(targets, {{{{0, 0}, 2.0}, {{1, 0}, 0.1}}});
    Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(200, 2);
    double allowed = 0;
    for (const fgtd::Gaussian& of : gaussians()) {
      const fgtd::Plan<2> plan(sources, weights, of.sigma, {.derivative_order = 1, .method = fgtd::Method::direct});
      wanted += of.coefficient * plan.evaluate_combination(targets, {{{0, 0}, 2.0}, {{1, 0}, 0.1}});
      allowed += of.tolerance * std::abs(of.coefficient) * (2 + 0.1 * std::sqrt(2 * of.sigma));
    }
    EXPECT_LE((found - wanted).cwiseAbs().maxCoeff(), allowed * weights.cwiseAbs().colwise().sum().maxCoeff())
        << fgtd::to_string(method);
  }
}

TEST(Mixture, HasTheSameBitsForAnyNumberOfThreads) {
  const fgtd::Points<2> sources = clusters<2>(20000), targets = naive::random_points<2>(20000, 4, -1.2, 1.2);
  const Eigen::MatrixXd weights = naive::random_weights(20000, 1, 5);
  const fgtd::TensorGrid grid = naive::cube_grid<2>(150, -1.1, 1.2);
  const fgtd::Mixture<2> one(sources, weights, gaussians(), {.threads = 1}),
      three(sources, weights, gaussians(), {.threads = 3});
  ASSERT_EQ(one.groups(), three.groups());
  EXPECT_EQ(one.evaluate_combinations(targets, {{{{}, 1.0}}}), three.evaluate_combinations(targets, {{{{}, 1.0}}}));
  EXPECT_EQ(one.evaluate_combinations(grid, {{{{}, 1.0}}}), three.evaluate_combinations(grid, {{{{}, 1.0}}}));
}

TEST(Mixture, OfNothingIsZeroAndRefusesWhatItCannotSum) {
  const fgtd::Points<2> points = naive::random_points<2>(5, 1);
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(5, 1);
  EXPECT_EQ(fgtd::Mixture<2>(points, ones, {}).evaluate_combinations(points, {{{{}, 1.0}}}).norm(), 0);
  const fgtd::Mixture<2> no_sources(points.leftCols(0), ones.topRows(0), gaussians());
  EXPECT_EQ(no_sources.evaluate_combinations(points, {{{{}, 1.0}}}).norm(), 0);
  EXPECT_THROW(fgtd::Mixture<2>(points, ones, {{.sigma = -1}}), fgtd::InvalidArgument);
  EXPECT_THROW(fgtd::Mixture<2>(points, ones, {{.sigma = 1, .coefficient = NAN}}), fgtd::InvalidArgument);
  EXPECT_THROW(fgtd::Mixture<2>(points, ones, {{.sigma = 1, .tolerance = 1e-15}}), fgtd::ToleranceError);
  fgtd::Options by_hand;
  by_hand.hermite = fgtd::HermiteParameters{};
  EXPECT_THROW(fgtd::Mixture<2>(points, ones, {{.sigma = 1}}, by_hand), fgtd::InvalidArgument);
  EXPECT_THROW(fgtd::Mixture<2>(points, ones, gaussians(), {.most_seconds = 0}), fgtd::TimeLimitError);
  EXPECT_THROW(fgtd::Mixture<2>(points, ones, gaussians(), {.memory_limit = 100}), fgtd::MemoryLimitError);
}

}  // namespace
