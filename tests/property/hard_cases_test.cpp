// Hard cases, each for every method: the promise holds, term by term, where Gauss transforms usually break.
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "oracle/promise.hpp"

namespace {

using naive::Scene;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

class HardCase : public testing::TestWithParam<fgtd::Method> {
 protected:
  fgtd::Options options(double tolerance, int order = 0) const {
    return {.tolerance = tolerance, .derivative_order = order, .method = GetParam(), .threads = 1};
  }

  /// Every watched term at all targets and nodes, planned for points and for the grid.
  template <int d>
  void expect_promise(const Scene<d>& scene, const std::vector<double>& tolerances = {1e-4, 1e-10},
                      const std::vector<int>& orders = {0, 2}) const {
    const Eigen::MatrixXd weights = scene.weights();
    const fgtd::Points<d> nodes = naive::points_of<d>(scene.grid);
    naive::ExactTerms<d> at_targets(scene, scene.targets), on_grid(scene, nodes);
    for (const double tolerance : tolerances)
      for (const int order : orders)
        for (const bool for_grid : {false, true}) {
          fgtd::Options chosen = options(tolerance, order);
          if (for_grid) {
            chosen.expected_grid = scene.grid;
          } else {
            chosen.expected_targets = 10000;
          }
          const fgtd::Plan<d> plan(scene.sources, weights, scene.sigma, chosen);
          for (const auto& alpha : naive::derivatives_of_order<d>(order)) {
            const auto expect = [&](const naive::Errors& errors, const char* kind) {
              EXPECT_LE(errors.of_promise, 1.0)
                  << scene.name << ", d = " << d << ", sigma = " << scene.sigma << ", " << kind << ", derivative "
                  << naive::name_of<d>(alpha) << ", planned for " << (for_grid ? "grid" : "points") << ": "
                  << plan.choice() << ", " << errors.where;
            };
            expect(naive::measure<d>(at_targets, plan.evaluate(scene.targets, alpha), scene.sigma, tolerance, alpha),
                   "points");
            expect(naive::measure<d>(on_grid, plan.evaluate(scene.grid, alpha), scene.sigma, tolerance, alpha), "grid");
            if (testing::Test::HasFailure()) return;
          }
        }
  }
};

/// Beside the watched sources at distances of up to 11 widths, and `elsewhere`.
template <int d>
fgtd::Points<d> near_and(const Scene<d>& scene, const fgtd::Points<d>& elsewhere) {
  naive::Random random(80);
  std::vector<Eigen::Matrix<double, d, 1>> list;
  for (const Eigen::Index j : scene.watched)
    for (const double distance : {0.0, 0.3, 1.0, 2.0, 3.0, 4.0, 5.0, 6.5, 8.0, 11.0}) {
      Eigen::Matrix<double, d, 1> direction;
      for (int l = 0; l < d; ++l) direction[l] = random() - 0.5;
      list.push_back(scene.sources.col(j) + direction.normalized() * distance / std::sqrt(scene.sigma));
    }
  fgtd::Points<d> targets(d, static_cast<Eigen::Index>(list.size()) + elsewhere.cols());
  for (std::size_t i = 0; i < list.size(); ++i) targets.col(static_cast<Eigen::Index>(i)) = list[i];
  targets.rightCols(elsewhere.cols()) = elsewhere;
  return targets;
}

/// A grid whose nodes are the coordinates of some targets: fine where the sources are, coarse elsewhere.
template <int d>
fgtd::TensorGrid grid_through(const fgtd::Points<d>& targets, int count) {
  fgtd::TensorGrid grid;
  for (int l = 0; l < d; ++l) {
    std::vector<double> axis;
    for (int i = 0; i < count; ++i) axis.push_back(targets(l, i * (targets.cols() - 1) / (count - 1)));
    std::sort(axis.begin(), axis.end());
    axis.erase(std::unique(axis.begin(), axis.end()), axis.end());
    grid.axes.push_back(axis);
  }
  return grid;
}

template <int d>
void finish(Scene<d>& scene, int watched, const fgtd::Points<d>& elsewhere) {
  scene.watch(watched);
  scene.targets = near_and<d>(scene, elsewhere);
  scene.grid = grid_through<d>(scene.targets, d == 1 ? 60 : d == 2 ? 24 : 9);
}

// ---------------------------------------------------------------------------------------------------------------
// Sigma

TEST_P(HardCase, OfEverySigmaOnTheUnitSquare) {
  for (int exponent = -8; exponent <= 14; exponent += 2) {
    Scene<2> scene{"unit square", std::pow(10.0, exponent), naive::random_points<2>(600, 81), {}, {}, {}};
    finish<2>(scene, 8, naive::random_points<2>(60, 82, -0.5, 1.5));
    expect_promise<2>(scene, {1e-8}, {0, 1});
  }
}

TEST_P(HardCase, OfSigmaNearTheEndsOfTheDoubles) {
  for (const double sigma : {1e-300, 1e-150, 1e150, 1e280}) {
    Scene<2> scene{"unit square", sigma, naive::random_points<2>(40, 83), {}, {}, {}};
    finish<2>(scene, 5, naive::random_points<2>(20, 84, -0.5, 1.5));
    expect_promise<2>(scene, {1e-8}, {0});
  }
}

/// Sigma = 0.0001 ... 10000 at fixed p = 9 and nu = 4 boxes an axis: the fixed choice blows up, `automatic` does not.
/// The thesis names neither points, weights nor derivative: 10 000 Halton points with Halton weights and the derivative
/// (0, 1, 2), which it uses elsewhere, give its errors to within one order of magnitude, or better ones. Its n >= 2
/// takes every one of the 4 boxes an axis, which is n = 3 here.
TEST(ThesisTable46, FixedParametersBlowUpAsPublishedAndAutomaticKeepsItsPromise) {
  std::ifstream file(std::string(REFERENCE_DIR) + "/schroeder-table-4.6.csv");
  std::string line;
  std::getline(file, line);
  ASSERT_EQ(line, "sigma,n0,n1,n2_or_more");
  const int count = 10000, some = 1000;
  fgtd::Points<3> points(3, count);
  Eigen::MatrixXd weights(count, 1);
  for (int j = 0; j < count; ++j) {
    points.col(j) << naive::halton(j + 1, 2), naive::halton(j + 1, 3), naive::halton(j + 1, 5);
    weights(j, 0) = naive::halton(j + 1, 7);
  }
  const fgtd::Derivative<3> alpha{0, 1, 2};
  const fgtd::Points<3> targets = points.leftCols(some);
  constexpr int order = 3, nu = 4;
  constexpr double tolerance = 1e-6;
  int rows = 0;
  for (; std::getline(file, line); ++rows) {
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    const double sigma = std::stod(field), box_scale = std::sqrt(sigma / 2) / nu;
    const double promised = (tolerance + 3e-14) * fgtd::derivative_scale<3>(alpha, sigma) * weights.sum();
    const Eigen::MatrixXd exact =
        fgtd::Plan<3>(points, weights, sigma, {.derivative_order = order, .method = fgtd::Method::direct})
            .evaluate(targets, alpha);
    for (const int n : {0, 1, 3}) {
      std::getline(fields, field, ',');
      fgtd::Options by_hand{.derivative_order = order};
      by_hand.hermite = {.box_scale = box_scale, .expansion_order = 9, .neighbours = n};
      const fgtd::Plan<3> plan(points, weights, sigma, by_hand);
      EXPECT_EQ(plan.choice().bound.has_value(), box_scale < 1) << sigma;  // (3.5) lives below r = 1
      const double error = (plan.evaluate(targets, alpha) - exact).cwiseAbs().maxCoeff();
      RecordProperty("error at sigma = " + std::to_string(sigma) + ", n = " + std::to_string(n),
                     std::to_string(std::log10(error)) + " published " + field);
      const double published = std::stod(field);
      if (published > 1e-10) {
        // Printed are powers of ten. Ours lie from 0.34 to 6.5 of them.
        EXPECT_LE(error, 8 * published) << "sigma = " << sigma << ", n = " << n;
        EXPECT_GE(error, 0.3 * published) << "sigma = " << sigma << ", n = " << n;
      } else {  // rounding: ours is at most 0.12 of theirs
        EXPECT_LE(error, 0.3 * published) << "sigma = " << sigma << ", n = " << n;
      }
      if (published >= 1e15) {
        EXPECT_GT(error, 3e12 * promised);  // measured 7e12
      }
    }
    const fgtd::Plan<3> automatic(points, weights, sigma, {.tolerance = tolerance, .derivative_order = order});
    EXPECT_LE((automatic.evaluate(targets, alpha) - exact).cwiseAbs().maxCoeff(), promised) << automatic.choice();
  }
  EXPECT_EQ(rows, 9);
}

// ---------------------------------------------------------------------------------------------------------------
// Points

template <int d>
Scene<d> equal_points(double sigma) {
  Scene<d> scene{"all points equal", sigma, fgtd::Points<d>::Constant(d, 500, 0.3), {}, {}, {}};
  finish<d>(scene, 3, naive::random_points<d>(20, 85));
  return scene;
}

TEST_P(HardCase, OfEqualPoints) {
  for (const double sigma : {1e-3, 1.0, 1e8}) {
    expect_promise<1>(equal_points<1>(sigma));
    expect_promise<2>(equal_points<2>(sigma));
    expect_promise<3>(equal_points<3>(sigma), {1e-6}, {0, 1});
  }
}

TEST_P(HardCase, OfCollinearPointsInSpace) {
  for (const double sigma : {0.5, 1e4}) {
    for (const Eigen::Vector3d& direction : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 1),
                                             Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, -0.3, 1e-9)}) {
      Scene<3> scene{"collinear", sigma, {}, {}, {}, {}};
      scene.sources = direction * naive::random_points<1>(400, 86);
      finish<3>(scene, 5, naive::random_points<3>(20, 87));
      expect_promise<3>(scene, {1e-7}, {0, 1});
    }
  }
}

TEST_P(HardCase, OfPointsInAPlaneAndOnFacesAndCornersOfTheirBox) {
  for (const double sigma : {3.0, 500.0}) {
    Scene<3> scene{"faces and corners", sigma, naive::points_of<3>(naive::cube_grid<3>(8, 0, 1)), {}, {}, {}};
    finish<3>(scene, 6, naive::points_of<3>(naive::cube_grid<3>(4, -1, 2)));
    expect_promise<3>(scene, {1e-7}, {0, 1});
    Scene<3> plane{"plane", sigma, naive::random_points<3>(400, 88), {}, {}, {}};
    plane.sources.row(1).setConstant(0.75);
    finish<3>(plane, 6, naive::random_points<3>(30, 89));
    expect_promise<3>(plane, {1e-7}, {0, 1});
  }
}

TEST_P(HardCase, OfTargetsAMillionBoxSidesAway) {
  const double sigma = 100;
  const auto sources = naive::random_points<2>(500, 90);
  const Eigen::MatrixXd weights = naive::random_weights(500, 2, 91);
  const fgtd::Plan<2> plan(sources, weights, sigma, options(1e-8, 2));
  fgtd::Points<2> far = naive::random_points<2>(40, 92, -1, 1) * 1e6;
  for (int i = 0; i < 40; ++i) far(0, i) += far(0, i) < 0 ? -1e6 : 1e6;
  far.col(1) << 1e300, -1e300;
  far.col(2) << -std::numeric_limits<double>::max(), 0;
  const fgtd::TensorGrid grid{{{-1e300, -1e6, 1e6, 1e300}, {-1e15, -3e5, 0.5, 2e6}}};
  for (const fgtd::Derivative<2>& alpha : {fgtd::Derivative<2>{0, 0}, {1, 1}, {0, 2}}) {
    EXPECT_EQ(plan.evaluate(far, alpha), Eigen::MatrixXd::Zero(40, 2)) << plan.choice();
    EXPECT_EQ(plan.evaluate(grid, alpha), Eigen::MatrixXd::Zero(16, 2)) << plan.choice();
  }
}

TEST_P(HardCase, OfTinyClustersBesideFarOutliers) {
  Scene<2> scene{"clusters and outliers", 1, naive::random_points<2>(600, 93, 0, 1e-7), {}, {}, {}};
  for (int j = 0; j < 600; ++j) {
    if (j % 3 == 1) scene.sources.col(j).array() += 0.5;
    if (j % 3 == 2) scene.sources.col(j).array() -= 0.25;
  }
  scene.sources.col(5) << 1e3, -1e3;
  scene.sources.col(599) << -1e3, 1e3;
  scene.sources.col(0) << 1e3, 1e3;
  for (const double sigma : {1e-8, 1.0, 1e4, 1e13, 1e15, 1e17}) {
    scene.sigma = sigma;
    finish<2>(scene, 9, naive::random_points<2>(40, 94, -1e3, 1e3));
    expect_promise<2>(scene, {1e-7}, {0, 1});
  }
}

TEST_P(HardCase, OfACloudFarFromTheOrigin) {
  for (const double shift : {5.0, -1e5}) {
    Scene<2> scene{"far from the origin", 1e10, naive::random_points<2>(300, 95, 0, 1e-4), {}, {}, {}};
    scene.sources.array() += shift;
    const fgtd::Points<2> around = naive::random_points<2>(30, 96, -1e-4, 2e-4).array() + shift;
    finish<2>(scene, 8, around);
    expect_promise<2>(scene, {1e-4, 1e-12}, {0, 1});
  }
}

TEST_P(HardCase, OfCoordinatesNearTheEndOfTheDoubles) {
  const double sigmas[] = {1e-300, 1.0, 1e290};
  for (const double sigma : sigmas) {
    fgtd::Points<2> sources(2, 5);
    sources << 1e300, -1e308, 0, 1.5e308, 1.00000001e300, 1e308, 1e308, 0, -1.7e308, 1e308;
    fgtd::Points<2> targets(2, 5);
    targets << 1e300, 1e308, 0, 1e-160, 1.00000001e300, 1e308, -1e308, 0, 0, 1e308;
    const fgtd::Plan<2> plan(sources, Eigen::MatrixXd::Ones(5, 1), sigma, options(1e-8, 1));
    const Eigen::MatrixXd values = plan.evaluate(targets), slopes = plan.evaluate(targets, {1, 0});
    EXPECT_TRUE(values.allFinite() && slopes.allFinite()) << plan.choice();
    EXPECT_NEAR(values(0, 0), 1, 1e-8) << plan.choice();  // the promise: one source is here, the others are far
    EXPECT_NEAR(values(2, 0), 1, 1e-8) << plan.choice();
    EXPECT_NEAR(values(4, 0), 1, 1e-8) << plan.choice();
    EXPECT_EQ(values(1, 0), 0) << plan.choice();
    const fgtd::TensorGrid grid{{{-1e308, 0, 1e300}, {-1.7e308, 0, 1e308}}};
    const Eigen::MatrixXd nodes = plan.evaluate(grid);
    EXPECT_TRUE(nodes.allFinite() && plan.evaluate(grid, {0, 1}).allFinite()) << plan.choice();
    EXPECT_NEAR(nodes(4, 0), 1, 1e-8) << plan.choice();  // (0, 0)
    EXPECT_NEAR(nodes(6, 0), 1, 1e-8) << plan.choice();  // (-1e308, 1e308)
    EXPECT_NEAR(nodes(8, 0), 1, 1e-8) << plan.choice();  // (1e300, 1e308)
  }
}

TEST_P(HardCase, OfDenormalCoordinates) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  Scene<2> scene{"denormal", 1, naive::random_points<2>(300, 97, 0, 1000), {}, {}, {}};
  for (Eigen::Index i = 0; i < scene.sources.size(); ++i)
    scene.sources.data()[i] = tiny * std::floor(scene.sources.data()[i]);
  for (const double sigma : {1e-300, 1.0, 1e300}) {
    scene.sigma = sigma;
    scene.watch(5);
    scene.targets = scene.sources.leftCols(50);
    scene.targets.col(7) << 1 / std::sqrt(sigma), 0;
    scene.targets.col(8) << tiny, -0.5 / std::sqrt(sigma);
    scene.grid.axes = {{-tiny, 0, tiny, 50 * tiny, 1 / std::sqrt(sigma)}, {0, tiny, 1 / std::sqrt(sigma)}};
    expect_promise<2>(scene, {1e-8}, {0});
  }
}

TEST_P(HardCase, OfNoneOneAndTwoSourcesAndNoTargets) {
  const auto grid = naive::cube_grid<3>(4, -0.5, 1);
  const fgtd::Points<3> targets = naive::random_points<3>(9, 98);
  const fgtd::Plan<3> none(fgtd::Points<3>(3, 0), Eigen::MatrixXd(0, 2), 2.0, options(1e-6));
  EXPECT_EQ(none.evaluate(targets), Eigen::MatrixXd::Zero(9, 2));
  EXPECT_EQ(none.evaluate(grid), Eigen::MatrixXd::Zero(64, 2));
  for (const int count : {1, 2})
    for (const double sigma : {1e-6, 2.0, 1e9}) {
      Scene<3> scene{std::to_string(count) + " sources", sigma, naive::random_points<3>(count, 99), {}, {}, {}};
      finish<3>(scene, count, targets);
      expect_promise<3>(scene, {1e-6, 1e-13}, {0, 1});
      const fgtd::Plan<3> plan(scene.sources, scene.weights(), sigma, options(1e-6));
      EXPECT_EQ(plan.evaluate(fgtd::Points<3>(3, 0)).rows(), 0);
      EXPECT_EQ(plan.evaluate(fgtd::TensorGrid{{{0, 1}, {}, {0}}}).rows(), 0);
      EXPECT_EQ(plan.evaluate(fgtd::TensorGrid{{{0.5}, {0.5}, {0.5}}}).rows(), 1);
    }
}

// ---------------------------------------------------------------------------------------------------------------
// Weights

/// 30 decades of weights of both signs, the largest 1e100: each value within the sum of what its terms are promised.
template <int d>
void expect_heavy_sums(double sigma, const fgtd::Options& options) {
  const int count = 400;
  const auto sources = naive::random_points<d>(count, 100), targets = naive::random_points<d>(150, 101, -0.3, 1.3);
  Eigen::MatrixXd weights(count, 1);
  naive::Random random(102);
  for (int j = 0; j < count; ++j) weights(j, 0) = (random() < 0.5 ? -1 : 1) * std::pow(10.0, 70 + 30 * random());
  const fgtd::TensorGrid grid = naive::cube_grid<d>(d == 1 ? 150 : d == 2 ? 14 : 6, -0.3, 1.3);
  const fgtd::Plan<d> plan(sources, weights, sigma, options);
  const auto expect = [&](const fgtd::Points<d>& points, const Eigen::MatrixXd& values,
                          const fgtd::Derivative<d>& alpha) {
    const double scale = fgtd::derivative_scale<d>(alpha, sigma);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      long double exact = 0;
      double allowed = 0;
      for (Eigen::Index j = 0; j < count; ++j) {
        const long double term = weights(j, 0) * naive::term<d>(points.col(i), sources.col(j), sigma, alpha);
        exact += term;
        allowed +=
            std::abs(weights(j, 0)) *
            naive::promised(options.tolerance, scale,
                            static_cast<double>(naive::squared_distance<d>(points.col(i), sources.col(j), sigma)),
                            static_cast<double>(term / weights(j, 0)));
      }
      EXPECT_LE(std::abs(values(i, 0) - static_cast<double>(exact)), allowed)
          << "sigma = " << sigma << ", " << plan.choice() << ", point " << i;
    }
  };
  for (const auto& alpha : naive::derivatives_of_order<d>(options.derivative_order)) {
    expect(targets, plan.evaluate(targets, alpha), alpha);
    expect(naive::points_of<d>(grid), plan.evaluate(grid, alpha), alpha);
  }
}

TEST_P(HardCase, OfWeightsOfThirtyDecadesAndBothSigns) {
  for (const double sigma : {0.1, 300.0, 1e5}) {
    expect_heavy_sums<1>(sigma, options(1e-9, 1));
    expect_heavy_sums<2>(sigma, options(1e-9, 1));
    expect_heavy_sums<3>(sigma, options(1e-5));
  }
}

// ---------------------------------------------------------------------------------------------------------------
// Refusals

template <class Exception, class Action>
std::string message_of_refusal(const Action& action) {
  try {
    action();
  } catch (const Exception& exception) {
    return exception.what();
  }
  return "nothing thrown";
}

TEST_P(HardCase, OfInputThatIsNotFiniteIsRefusedByNameAndIndex) {
  using Refusal = fgtd::InvalidArgument;
  const auto points = naive::random_points<2>(200, 103);
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(200, 2);
  const auto wrong = [](auto values, Eigen::Index row, Eigen::Index column, double value) {
    values(row, column) = value;
    return values;
  };
  fgtd::Plan<2> plan(points, weights, 30.0, options(1e-6));
  const Eigen::MatrixXd before = plan.evaluate(points);
  EXPECT_EQ(message_of_refusal<Refusal>(
                [&] { fgtd::Plan<2>(wrong(points, 1, 150, not_a_number), weights, 30.0, options(1e-6)); }),
            "fgtd: source 150, coordinate 1 is nan; sources must be finite");
  EXPECT_EQ(
      message_of_refusal<Refusal>([&] { fgtd::Plan<2>(points, wrong(weights, 7, 1, -infinite), 30.0, options(1e-6)); }),
      "fgtd: weight 7, column 1 is -inf; weights must be finite");
  EXPECT_EQ(message_of_refusal<Refusal>([&] { plan.set_weights(wrong(weights, 199, 0, not_a_number)); }),
            "fgtd: weight 199, column 0 is nan; weights must be finite");
  EXPECT_EQ(message_of_refusal<Refusal>([&] { plan.evaluate(wrong(points, 0, 42, infinite)); }),
            "fgtd: target 42, coordinate 0 is inf; targets must be finite");
  EXPECT_EQ(message_of_refusal<Refusal>([&] {
              plan.evaluate(fgtd::TensorGrid{{{0, 1}, {0, not_a_number}}});
            }),
            "fgtd: grid, axis 1, node 1 is nan; nodes must be finite");
  EXPECT_EQ(message_of_refusal<Refusal>([&] { fgtd::Plan<2>(points, weights, infinite, options(1e-6)); }),
            "fgtd: sigma = inf, must be positive and finite");
  EXPECT_EQ(plan.evaluate(points), before);  // a refusal leaves the plan as it was
}

INSTANTIATE_TEST_SUITE_P(Property, HardCase, testing::ValuesIn(fgtd::methods()), naive::MethodName());

}  // namespace
