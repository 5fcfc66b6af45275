// Laws that every method keeps in every dimension: linearity, invariance, symmetry, differentiation, empty sets.
#include <gtest/gtest.h>

#include <sstream>

#include "oracle/naive.hpp"

namespace {

constexpr double tolerance = 1e-9;

template <class T>
class EveryMethod : public testing::Test {
 protected:
  static constexpr int dimension = T::value;
  static constexpr double sigma = 9.0;
  static constexpr int count = 40;
  static fgtd::Options options(fgtd::Method method, int order = 0) {
    return {.tolerance = tolerance, .derivative_order = order, .method = method};
  }
  /// In four dimensions the expansions of high order are left to others.
  static std::vector<fgtd::Method> methods() {
    if (dimension == 4) return {fgtd::Method::automatic, fgtd::Method::direct};
    return fgtd::methods();
  }

  fgtd::Points<dimension> sources = naive::random_points<dimension>(count, 31);
  fgtd::Points<dimension> targets = naive::random_points<dimension>(30, 32, -0.3, 1.3);
  Eigen::MatrixXd weights = naive::random_weights(count, 2, 33);
  double weight = std::max(weights.col(0).cwiseAbs().sum(), weights.col(1).cwiseAbs().sum());
};

using Dimensions = testing::Types<naive::Dimension<1>, naive::Dimension<2>, naive::Dimension<3>, naive::Dimension<4>>;
TYPED_TEST_SUITE(EveryMethod, Dimensions);

TYPED_TEST(EveryMethod, IsLinearInTheWeights) {
  constexpr int d = TestFixture::dimension;
  const Eigen::MatrixXd mixed = 2 * this->weights.col(0) - 3 * this->weights.col(1);
  Eigen::MatrixXd all(this->count, 3);
  all << this->weights, mixed;
  for (const fgtd::Method method : this->methods()) {
    SCOPED_TRACE(fgtd::to_string(method));
    const fgtd::Plan<d> together(this->sources, all, this->sigma, this->options(method));
    const Eigen::MatrixXd values = together.evaluate(this->targets);
    // One plan is linear, whatever its tolerance; only rounding differs, by 4.7e-16 of the weight.
    EXPECT_LE((2 * values.col(0) - 3 * values.col(1) - values.col(2)).cwiseAbs().maxCoeff(), 1.4e-15 * this->weight);
    // another number of columns may have other parameters
    const fgtd::Plan<d> alone(this->sources, mixed, this->sigma, this->options(method));
    EXPECT_LE((alone.evaluate(this->targets) - values.col(2)).cwiseAbs().maxCoeff(),
              2 * tolerance * mixed.cwiseAbs().sum());
  }
}

TYPED_TEST(EveryMethod, IsInvariantUnderTranslation) {
  constexpr int d = TestFixture::dimension;
  for (const fgtd::Method method : this->methods()) {
    SCOPED_TRACE(fgtd::to_string(method));
    const double shift = 1024;  // exact for coordinates that are multiples of 2^-30
    const auto round = [](const fgtd::Points<d>& points) -> fgtd::Points<d> {
      return (points * 0x1p30).array().round() * 0x1p-30;
    };
    const fgtd::Points<d> coarse = round(this->sources), coarse_targets = round(this->targets);
    const fgtd::Plan<d> here(coarse, this->weights, this->sigma, this->options(method));
    const fgtd::Points<d> moved = coarse.array() + shift, moved_targets = coarse_targets.array() + shift;
    const fgtd::Plan<d> there(moved, this->weights, this->sigma, this->options(method));
    // twice the promise: boxes and lattices may lie differently
    EXPECT_LE((here.evaluate(coarse_targets) - there.evaluate(moved_targets)).cwiseAbs().maxCoeff(),
              2 * tolerance * this->weight);
  }
}

TYPED_TEST(EveryMethod, HasEvenAndOddDerivativesAtMirroredPoints) {
  constexpr int d = TestFixture::dimension;
  for (const fgtd::Method method : this->methods()) {
    SCOPED_TRACE(fgtd::to_string(method));
    const fgtd::Points<d> mirrored_sources = -this->sources, mirrored_targets = -this->targets;
    const fgtd::Plan<d> plan(this->sources, this->weights, this->sigma, this->options(method, 3));
    const fgtd::Plan<d> mirrored(mirrored_sources, this->weights, this->sigma, this->options(method, 3));
    for (int order = 0; order <= 3; ++order)
      for (const auto& alpha : naive::derivatives_of_order<d>(order)) {
        const double sign = order % 2 == 0 ? 1 : -1;
        // twice the promise: the boxes of the mirrored points lie differently
        EXPECT_LE((plan.evaluate(this->targets, alpha) - sign * mirrored.evaluate(mirrored_targets, alpha))
                      .cwiseAbs()
                      .maxCoeff(),
                  2 * (tolerance + 3e-14) * fgtd::derivative_scale<d>(alpha, this->sigma) * this->weight);
      }
  }
}

TYPED_TEST(EveryMethod, GivesTheClosedFormOfOneGaussian) {
  constexpr int d = TestFixture::dimension;
  for (const fgtd::Method method : this->methods()) {
    SCOPED_TRACE(fgtd::to_string(method));
    const fgtd::Points<d> centre = fgtd::Points<d>::Constant(d, 1, 0.25);
    const double s = this->sigma;
    const fgtd::Plan<d> plan(centre, Eigen::MatrixXd::Ones(1, 1), s, this->options(method, 2));
    const Eigen::MatrixXd values = plan.evaluate(this->targets);
    const Eigen::MatrixXd laplacian = plan.evaluate_combination(this->targets, naive::laplacian<d>());
    for (Eigen::Index i = 0; i < this->targets.cols(); ++i) {
      const double squared = (this->targets.col(i).array() - 0.25).square().sum();
      const double gaussian = std::exp(-s * squared);
      EXPECT_NEAR(values(i, 0), gaussian, tolerance);
      EXPECT_NEAR(laplacian(i, 0), (4 * s * s * squared - 2 * d * s) * gaussian,
                  d * tolerance * s * std::sqrt(8.0));  // N of the Laplacian
    }
  }
}

TYPED_TEST(EveryMethod, HasDerivativesThatAreLimitsOfDifferences) {
  constexpr int d = TestFixture::dimension;
  for (const fgtd::Method method : this->methods()) {
    SCOPED_TRACE(fgtd::to_string(method));
    const fgtd::Plan<d> plan(this->sources, this->weights, this->sigma,
                             {.tolerance = 1e-13, .derivative_order = 3, .method = method});
    const double step = 1e-4;
    for (int l = 0; l < d; ++l) {
      fgtd::Derivative<d> lower{}, higher{};
      lower[0] = higher[0] = 1;
      ++higher[static_cast<std::size_t>(l)];
      fgtd::Points<d> left = this->targets, right = this->targets;
      left.row(l).array() -= step;
      right.row(l).array() += step;
      const Eigen::MatrixXd difference = (plan.evaluate(right, lower) - plan.evaluate(left, lower)) / (2 * step);
      // central difference: step^2/6 times a fourth derivative (below N_alpha of order 4), and rounding 1e-13 / step
      const double allowed =
          (step * step * std::pow(this->sigma, 2) * 20 + 1e-13 / step * this->sigma * 4) * this->weight;
      EXPECT_LE((difference - plan.evaluate(this->targets, higher)).cwiseAbs().maxCoeff(), allowed) << "axis " << l;
    }
  }
}

TYPED_TEST(EveryMethod, GivesTheSameForNewWeightsAsANewPlan) {
  constexpr int d = TestFixture::dimension;
  for (const fgtd::Method method : this->methods()) {
    SCOPED_TRACE(fgtd::to_string(method));
    fgtd::Plan<d> plan(this->sources, this->weights, this->sigma, this->options(method));
    const Eigen::MatrixXd other = naive::random_weights(this->count, 3, 34);
    plan.set_weights(other);
    const Eigen::MatrixXd values = plan.evaluate(this->targets);
    ASSERT_EQ(values.cols(), 3);
    EXPECT_LE((values - naive::sum<d>(this->sources, other, this->sigma, this->targets)).cwiseAbs().maxCoeff(),
              tolerance * this->weight * 2);  // the promise
    plan.set_weights(this->weights);
    const fgtd::Plan<d> fresh(this->sources, this->weights, this->sigma, this->options(method));
    EXPECT_EQ(plan.evaluate(this->targets), fresh.evaluate(this->targets));  // the same operations
  }
}

TYPED_TEST(EveryMethod, SumsNothingToZeroAndReturnsNothingForNoTargets) {
  constexpr int d = TestFixture::dimension;
  for (const fgtd::Method method : this->methods()) {
    SCOPED_TRACE(fgtd::to_string(method));
    const fgtd::Points<d> nothing(d, 0);
    const auto grid = naive::cube_grid<d>(3, 0, 1);
    const fgtd::Plan<d> empty(nothing, Eigen::MatrixXd(0, 2), this->sigma, this->options(method));
    EXPECT_EQ(empty.evaluate(this->targets), Eigen::MatrixXd::Zero(30, 2));
    EXPECT_EQ(empty.evaluate(grid), Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(grid.size()), 2));

    const fgtd::Plan<d> plan(this->sources, this->weights, this->sigma, this->options(method));
    EXPECT_EQ(plan.evaluate(nothing).rows(), 0);
    EXPECT_EQ(plan.evaluate(nothing).cols(), 2);
    fgtd::TensorGrid hollow = grid;
    hollow.axes[d - 1].clear();
    EXPECT_EQ(plan.evaluate(hollow).rows(), 0);
    EXPECT_EQ(plan.evaluate_combinations(this->targets, {}).cols(), 0);
    EXPECT_EQ(plan.evaluate_combination(this->targets, {}), Eigen::MatrixXd::Zero(30, 2));  // the empty operator

    const fgtd::Plan<d> weightless(this->sources, Eigen::MatrixXd(this->count, 0), this->sigma, this->options(method));
    EXPECT_EQ(weightless.evaluate(this->targets).cols(), 0);
  }
}

TYPED_TEST(EveryMethod, FadesToExactZerosWithoutDenormals) {
  constexpr int d = TestFixture::dimension;
  for (const fgtd::Method method : this->methods()) {
    SCOPED_TRACE(fgtd::to_string(method));
    const fgtd::Plan<d> plan(this->sources, this->weights, this->sigma, this->options(method, 2));
    fgtd::Points<d> line = fgtd::Points<d>::Zero(d, 400);
    for (int i = 0; i < 400; ++i) line(0, i) = 0.1 * i;
    for (int order = 0; order <= 2; ++order)
      for (const auto& alpha : naive::derivatives_of_order<d>(order)) {
        const Eigen::MatrixXd values = plan.evaluate(line, alpha);
        EXPECT_EQ(values.bottomRows(200).cwiseAbs().maxCoeff(), 0.0);  // sigma r^2 > 3000
        for (Eigen::Index i = 0; i < values.size(); ++i) {
          // weights and polynomials may bring a term a little below exp(-708), never near the end of the denormals
          EXPECT_TRUE(values.data()[i] == 0 || std::abs(values.data()[i]) > 1e-312);
        }
      }
  }
}

TYPED_TEST(EveryMethod, ReadsPointsAndWeightsThroughStrides) {
  constexpr int d = TestFixture::dimension;
  for (const fgtd::Method method : this->methods()) {
    SCOPED_TRACE(fgtd::to_string(method));
    const fgtd::Plan<d> whole(this->sources, this->weights, this->sigma, this->options(method));
    Eigen::MatrixXd wide(this->count + 5, 4);
    wide.setConstant(std::nan(""));
    wide.block(2, 1, this->count, 2) = this->weights;
    const fgtd::Plan<d> part(this->sources.leftCols(this->count), wide.block(2, 1, this->count, 2), this->sigma,
                             this->options(method));
    EXPECT_EQ(whole.evaluate(this->targets), part.evaluate(this->targets));
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic> taller(d + 2, 30);
    taller.setConstant(std::nan(""));
    taller.topRows(d) = this->targets;
    EXPECT_EQ(whole.evaluate(this->targets), whole.evaluate(fgtd::Points<d>(taller.topRows(d))));
  }
}

TEST(Choice, TellsWhatWasChosen) {
  const auto sources = naive::random_points<2>(500, 35);
  const fgtd::Plan<2> plan(
      sources, Eigen::MatrixXd::Ones(500, 1), 50.0,
      {.tolerance = 1e-7, .derivative_order = 1, .method = fgtd::Method::hermite, .expected_targets = 900});
  const fgtd::Choice& choice = plan.choice();
  EXPECT_EQ(choice.method, fgtd::Method::hermite);
  EXPECT_EQ(choice.tolerance, 1e-7);
  EXPECT_LE(choice.bound.value(), 1e-7);
  EXPECT_EQ(choice.sources, 500u);
  EXPECT_EQ(choice.targets, 900u);
  const fgtd::Hermite& chosen = std::get<fgtd::Hermite>(choice.parameters);
  EXPECT_NEAR(chosen.box_side, chosen.box_scale * std::sqrt(2 / 50.0), 1e-15);  // rounding
  EXPECT_GT(chosen.expansion_order, 0);
  EXPECT_GT(chosen.neighbours, 0);
  EXPECT_GT(chosen.boxes, 0u);
  EXPECT_GT(chosen.cost, 0.0);
  EXPECT_GT(choice.seconds, 0.0);
  std::ostringstream text;
  text << choice;
  EXPECT_NE(text.str().find("hermite: 500 sources, 900 targets, tolerance 1e-07"), std::string::npos) << text.str();
}

/// The names of the parameters, and the line.
std::pair<std::vector<std::string>, std::string> told_by(fgtd::Method method) {
  const auto sources = naive::random_points<2>(500, 35);
  const fgtd::Plan<2> plan(sources, Eigen::MatrixXd::Ones(500, 1), 50.0, {.tolerance = 1e-6, .method = method});
  EXPECT_EQ(plan.choice().method, method);
  std::vector<std::string> names;
  for (const fgtd::Parameter& parameter : fgtd::parameters(plan.choice())) names.push_back(parameter.name);
  std::ostringstream text;
  text << plan.choice();
  return {names, text.str()};
}

TEST(Choice, TellsParametersInTheWordsOfTheMethod) {
  using Names = std::vector<std::string>;
  const auto expect = [](fgtd::Method method, const Names& names, const std::string& words) {
    const auto [told, line] = told_by(method);
    EXPECT_EQ(told, names);
    EXPECT_NE(line.find(words), std::string::npos) << line;
  };
  expect(fgtd::Method::direct, {}, "bound 0, about ");
  expect(fgtd::Method::hermite, {"box_scale", "box_side", "expansion_order", "neighbours", "boxes", "cost"},
         " occupied boxes");
  expect(fgtd::Method::cells, {"side", "within_reach", "occupied"}, ", cells of side ");
  expect(fgtd::Method::outer_product, {"side", "within_reach", "occupied"}, ", cells of side ");
  expect(fgtd::Method::chebyshev, {"box_side", "nodes", "neighbours", "boxes"}, " nodes an axis, ");
  expect(fgtd::Method::spread, {"spacing", "window", "bricks"}, ", lattice spacing ");
}

TEST(Choice, HoldsTheParametersOfItsMethod) {
  const auto sources = naive::random_points<2>(500, 35);
  const auto index = [&](fgtd::Method method) {
    return fgtd::Plan<2>(sources, Eigen::MatrixXd::Ones(500, 1), 50.0, {.tolerance = 1e-6, .method = method})
        .choice()
        .parameters.index();
  };
  for (std::size_t i = 1; i < fgtd::methods().size(); ++i) EXPECT_EQ(index(fgtd::methods()[i]), i - 1);
}

TEST(Method, OfAnUnknownNumberIsRefused) {
  const auto sources = naive::random_points<2>(5, 35);
  try {
    fgtd::Plan<2>(sources, Eigen::MatrixXd::Ones(5, 1), 50.0, {.method = static_cast<fgtd::Method>(77)});
    ADD_FAILURE() << "accepted";
  } catch (const fgtd::InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "fgtd: Options::method = 77 is no method; fgtd::methods() lists them");
  }
}

TEST(Choice, OfTheDefaultOptionsIsValid) {
  const fgtd::Points<3> sources = naive::random_points<3>(10, 36);
  EXPECT_EQ(fgtd::Plan<3>(sources, Eigen::MatrixXd::Ones(10, 1), 1.0).choice().bound.value(),
            0.0);  // direct has no error but rounding
}

TEST(Method, HasTheNamesOfTheFiles) {
  EXPECT_EQ(fgtd::to_string(fgtd::Method::automatic), "auto");
  EXPECT_EQ(fgtd::to_string(fgtd::Method::direct), "direct");
  EXPECT_EQ(fgtd::to_string(fgtd::Method::hermite), "hermite");
}

TEST(DerivativeScale, BoundsEveryDerivativeAndIsTheCramerConstant) {
  EXPECT_DOUBLE_EQ(fgtd::derivative_scale<2>({0, 0}, 5.0), 1.0);
  EXPECT_DOUBLE_EQ(fgtd::derivative_scale<2>({2, 1}, 5.0), std::pow(5.0, 1.5) * std::sqrt(8.0 * 2.0));
  for (int order = 0; order <= 8; ++order)
    for (double t = 0; t < 6; t += 0.01)
      EXPECT_LE(std::abs(naive::hermite_function(order, t)),
                fgtd::derivative_scale<1>({order}, 1.0) * (1 + 1e-15));  // rounding at t = 0, order 0
}

}  // namespace
