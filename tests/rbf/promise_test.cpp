// Are sums and their derivatives as accurate as promised, against the definition in long double?
#include <gtest/gtest.h>

#include "rbf/naive.hpp"

namespace {

struct Law {
  rbf::Function function;
  int dimension;
};

std::vector<Law> laws() {
  std::vector<Law> all;
  for (const rbf::Function& function : naive::functions())
    for (int d = 1; d <= 3; ++d) all.push_back({function, d});
  return all;
}

class EverySum : public testing::TestWithParam<Law> {
 protected:
  template <class Work>
  void in_dimension(const Work& work) const {
    if (GetParam().dimension == 1) work.template operator()<1>();
    if (GetParam().dimension == 2) work.template operator()<2>();
    if (GetParam().dimension == 3) work.template operator()<3>();
  }
};

/// The largest error of D^alpha at some targets, relative to the sum of |weights|.
template <int d>
double error_of(const rbf::Plan<d>& plan, const rbf::Function& function, const rbf::Points<d>& centres,
                const Eigen::MatrixXd& weights, const rbf::Points<d>& targets, const rbf::Derivative<d>& alpha) {
  const Eigen::MatrixXd found = plan.evaluate(targets, alpha);
  double worst = 0;
  for (Eigen::Index k = 0; k < weights.cols(); ++k)
    for (Eigen::Index i = 0; i < targets.cols(); ++i) {
      const long double exact = naive::sum<d>(function, centres, weights.col(k), targets.col(i), alpha);
      worst = std::max(worst, std::abs(static_cast<double>(found(i, k) - exact)) / weights.col(k).cwiseAbs().sum());
    }
  return worst;
}

TEST_P(EverySum, KeepsItsPromise) {
  in_dimension([&]<int d>() {
    const rbf::Function& function = GetParam().function;
    unsigned seed = 0;
    for (const double tolerance : {1e-3, 1e-6, 1e-10})
      for (const naive::Cloud<d>& cloud : naive::clouds<d>(240, 7)) {
        ++seed;
        const Eigen::MatrixXd weights = naive::numbers(cloud.points.cols(), 1, seed).cwiseAbs();
        rbf::Points<d> targets(d, 30);
        targets.leftCols(15) = cloud.points.leftCols(15);
        targets.rightCols(15) = cloud.points.rightCols(15) * 0.75 + cloud.points.leftCols(15) * 0.25;
        const rbf::Plan<d> plan(function, cloud.points, weights,
                                {.tolerance = tolerance, .method = rbf::Method::gaussians});
        ASSERT_EQ(plan.choice().method, rbf::Method::gaussians);
        EXPECT_LE(plan.choice().bound, tolerance);
        const double scale = static_cast<double>(naive::scales(function, plan.choice().range).value);
        // 2e-13: rounding
        EXPECT_LE((error_of<d>(plan, function, cloud.points, weights, targets, {})), (tolerance + 2e-13) * scale)
            << cloud.name << ", " << plan.choice();
      }
  });
}

TEST_P(EverySum, KeepsItsPromiseForDerivatives) {
  in_dimension([&]<int d>() {
    const rbf::Function& function = GetParam().function;
    const int highest = rbf::highest_derivative(function.kernel);
    const rbf::Points<d> centres = naive::clouds<d>(240, 3)[1].points, targets = centres.rightCols(24);
    const Eigen::MatrixXd weights = naive::numbers(240, 1, 4).cwiseAbs();
    for (int order = 1; order <= highest; ++order) {
      const rbf::Plan<d> plan(function, centres, weights,
                              {.tolerance = 1e-5, .derivative_order = order, .method = rbf::Method::gaussians});
      const naive::Scales scales = naive::scales(function, plan.choice().range);
      const double of[] = {static_cast<double>(scales.value), static_cast<double>(scales.first),
                           static_cast<double>(scales.second)};
      rbf::Derivative<d> first{}, second{}, mixed{};
      first[d - 1] = 1;
      second[0] = 2;
      mixed[0] = mixed[d - 1] = d == 1 ? 2 : 1;
      EXPECT_LE((error_of<d>(plan, function, centres, weights, targets, {})), 1e-5 * of[0]) << plan.choice();
      EXPECT_LE((error_of<d>(plan, function, centres, weights, targets, first)), 1e-5 * of[1]) << plan.choice();
      if (order < 2) continue;
      EXPECT_LE((error_of<d>(plan, function, centres, weights, targets, second)), 1e-5 * of[2]) << plan.choice();
      EXPECT_LE((error_of<d>(plan, function, centres, weights, targets, mixed)), 1e-5 * of[2]) << plan.choice();
    }
  });
}

TEST_P(EverySum, IsExactWhenSummedDirectly) {
  in_dimension([&]<int d>() {
    const rbf::Function& function = GetParam().function;
    const int highest = rbf::highest_derivative(function.kernel);
    const Eigen::MatrixXd weights = naive::numbers(240, 2, 4);
    for (const naive::Cloud<d>& cloud : naive::clouds<d>(240, 5)) {
      const rbf::Points<d> targets = cloud.points.rightCols(20);
      const rbf::Plan<d> plan(function, cloud.points, weights,
                              {.derivative_order = highest, .method = rbf::Method::direct});
      const naive::Scales scales = naive::scales(function, plan.choice().range);
      rbf::Derivative<d> first{}, mixed{};
      first[0] = 1;
      mixed[0] = mixed[d - 1] = d == 1 ? 2 : 1;
      // 1e-13: rounding of some hundred terms, and of the origin that is subtracted from far points
      EXPECT_LE((error_of<d>(plan, function, cloud.points, weights, targets, {})), 1e-13 * scales.value) << cloud.name;
      EXPECT_LE((error_of<d>(plan, function, cloud.points, weights, targets, first)), 1e-13 * scales.first)
          << cloud.name;
      if (highest == 2) {
        EXPECT_LE((error_of<d>(plan, function, cloud.points, weights, targets, mixed)), 1e-13 * scales.second)
            << cloud.name;
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Rbf, EverySum, testing::ValuesIn(laws()), [](const auto& of) {
  return naive::name(of.param.function) + "_" + std::to_string(of.param.dimension) + "D";
});

// From shapes far below the distance of points to far above the range.
TEST(RbfSum, KeepsItsPromiseForEveryShape) {
  const rbf::Points<2> centres = naive::numbers(2, 300, 1);
  const Eigen::MatrixXd weights = naive::numbers(300, 1, 2).cwiseAbs();
  for (const rbf::Kernel kernel : rbf::kernels()) {
    if (!rbf::takes_shape(kernel)) continue;
    for (const double shape : {1e-4, 1e-2, 3.0, 1e3}) {
      const rbf::Function function{kernel, shape};
      const rbf::Plan<2> plan(function, centres, weights, {.tolerance = 1e-6, .method = rbf::Method::gaussians});
      const double scale = static_cast<double>(naive::scales(function, plan.choice().range).value);
      EXPECT_LE(error_of<2>(plan, function, centres, weights, centres.leftCols(20), {}), 1e-6 * scale) << plan.choice();
    }
  }
}

}  // namespace
