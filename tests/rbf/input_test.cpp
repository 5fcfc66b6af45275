// Few points, wrong arguments, and other ways to ask for the same.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "message_of.hpp"
#include "rbf/naive.hpp"

namespace {

using gaussdrift::message_of;
using rbf::Function;
using rbf::Kernel;
using rbf::Method;
using rbf::Options;
using rbf::Plan;

const Function multiquadric{Kernel::multiquadric, 0.3};

TEST(RbfInput, MayBeEmptyOrOnePoint) {
  for (const Function& function : naive::functions())
    for (const Method method : rbf::methods()) {
      const Plan<2> none(function, rbf::Points<2>(2, 0), Eigen::MatrixXd(0, 1), {.method = method});
      EXPECT_EQ(none.evaluate(rbf::Points<2>::Ones(2, 3)), Eigen::MatrixXd::Zero(3, 1));
      const rbf::Points<2> one = rbf::Points<2>::Constant(2, 1, 5), target = rbf::Points<2>::Constant(2, 1, 5.25);
      const Plan<2> plan(function, one, Eigen::MatrixXd::Constant(1, 1, -2.0), {.method = method, .range = 0.5});
      const double exact = -2 * rbf::value(function, std::sqrt(0.125));
      EXPECT_NEAR(plan.evaluate(target)(0, 0), exact, 2e-6 * rbf::largest_value(function, 0.5));
      EXPECT_NEAR(plan.evaluate(one)(0, 0), -2 * rbf::value(function, 0), 2e-6 * rbf::largest_value(function, 0.5));
      EXPECT_EQ(plan.evaluate(rbf::Points<2>(2, 0)).rows(), 0);
    }
}

TEST(RbfInput, MayBeOnePlaceManyTimes) {
  const rbf::Points<3> centres = rbf::Points<3>::Constant(3, 50, 0.1);
  const Plan<3> plan(multiquadric, centres, Eigen::MatrixXd::Ones(50, 1));
  EXPECT_EQ(plan.choice().method, Method::direct);
  EXPECT_NEAR(plan.evaluate(centres.leftCols(1))(0, 0), 50 * 0.3, 1e-13);
}

TEST(RbfInput, MayHaveWeightsZero) {
  const rbf::Points<2> centres = naive::numbers(2, 400, 1);
  for (const Function& function : naive::functions()) {
    const Plan<2> plan(function, centres, Eigen::MatrixXd::Zero(400, 1), {.method = Method::gaussians});
    EXPECT_EQ(plan.evaluate(centres), Eigen::MatrixXd::Zero(400, 1));
  }
}

TEST(RbfInput, IsRefusedWithTheRule) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const rbf::Points<2> centres = naive::numbers(2, 10, 1);
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(10, 1);
  const auto message = [&](const Function& function, const Options& options) {
    return message_of<rbf::Error>([&] { Plan<2>(function, centres, weights, options); });
  };
  EXPECT_EQ(message({Kernel::multiquadric, 0}, {}).substr(0, 66),
            "rbf: shape = 0, must be positive and finite for multiquadric: a le");
  EXPECT_EQ(message({Kernel::matern52, -1}, {}).substr(0, 52), "rbf: shape = -1, must be positive and finite for mat");
  EXPECT_EQ(message({Kernel::thin_plate, 1}, {}), "rbf: shape = 1, must be 0 for thin-plate, which has no shape");
  EXPECT_EQ(message({static_cast<Kernel>(99), 1}, {}), "rbf: kernel = 99 is no kernel; rbf::kernels() lists them");
  EXPECT_EQ(message(multiquadric, {.tolerance = 0}), "rbf: Options::tolerance = 0, must lie in (0, 1)");
  EXPECT_EQ(message(multiquadric, {.tolerance = nan}), "rbf: Options::tolerance = nan, must lie in (0, 1)");
  EXPECT_EQ(
      message(multiquadric, {.tolerance = 1e-12, .method = Method::gaussians}),
      "rbf: Options::tolerance = 1e-12 cannot be promised by gaussians, must be at least 1e-11; leave the method to "
      "auto or direct");
  EXPECT_EQ(
      message({Kernel::thin_plate, 0}, {.derivative_order = 2}),
      "rbf: Options::derivative_order = 2, must lie in 0 .. 1 for thin-plate, whose second derivatives are infinite "
      "at distance 0");
  EXPECT_EQ(message(multiquadric, {.derivative_order = 3}),
            "rbf: Options::derivative_order = 3, must lie in 0 .. 2 for multiquadric");
  EXPECT_EQ(message(multiquadric, {.threads = -1}), "rbf: Options::threads = -1, must be positive, or 0 for all");
  EXPECT_EQ(message(multiquadric, {.range = -1}), "rbf: Options::range = -1, must be 0 or lie in [1e-75, 1e+75]");
  EXPECT_EQ(message(multiquadric, {.memory_limit = 100}).substr(0, 31), "rbf: the plan needs about 400 b");
  EXPECT_EQ(message(multiquadric, {.expected_grid = rbf::TensorGrid{{{0}}}}),
            "rbf: Options::expected_grid has 1 axes, must have 2");

  rbf::Points<2> wrong = centres;
  wrong(1, 3) = nan;
  EXPECT_EQ(message_of<rbf::InvalidArgument>([&] { Plan<2>(multiquadric, wrong, weights); }),
            "rbf: centre 3, coordinate 1 is nan; centres must be finite");
  EXPECT_EQ(message_of<rbf::InvalidArgument>([&] { Plan<2>(multiquadric, centres, weights.topRows(9)); }),
            "rbf: there are 10 centres but 9 rows of weights; every centre needs one");
  Eigen::MatrixXd infinite = weights;
  infinite(7, 0) = -HUGE_VAL;
  EXPECT_EQ(message_of<rbf::InvalidArgument>([&] { Plan<2>(multiquadric, centres, infinite); }),
            "rbf: weight 7, column 0 is -inf; weights must be finite");
  EXPECT_EQ(message_of<rbf::InvalidArgument>([&] { rbf::value(multiquadric, -1); }),
            "rbf: r = -1, must be at least 0 and finite");
}

TEST(RbfInput, IsRefusedBeyondTheRange) {
  const rbf::Points<2> centres = naive::numbers(2, 500, 1), far = rbf::Points<2>::Constant(2, 1, 9);
  for (const Method method : {Method::direct, Method::gaussians}) {
    const Plan<2> plan(multiquadric, centres, Eigen::MatrixXd::Ones(500, 1), {.method = method});
    const std::string message = message_of<rbf::InvalidArgument>([&] { plan.evaluate(far); });
    EXPECT_EQ(message.find("rbf: target 0 is 14."), 0U) << message;
    EXPECT_NE(message.find("give a larger range, rbf::range_of() tells which"), std::string::npos) << message;
    EXPECT_THROW(plan.evaluate(rbf::TensorGrid{{{0, 9}, {0}}}), rbf::InvalidArgument);
    const double range = rbf::range_of<2>(centres, far);
    const Plan<2> wide(multiquadric, centres, Eigen::MatrixXd::Ones(500, 1), {.method = method, .range = range});
    EXPECT_NEAR(wide.evaluate(far)(0, 0),
                static_cast<double>(naive::sum<2>(multiquadric, centres, Eigen::VectorXd::Ones(500), far.col(0), {})),
                1e-6 * 500 * rbf::largest_value(multiquadric, range));
  }
  const Plan<2> plan(multiquadric, centres, Eigen::MatrixXd::Ones(500, 1));
  EXPECT_EQ(message_of<rbf::InvalidArgument>([&] {
              plan.evaluate(centres, {1, 0});
            }),
            "rbf: a derivative of order 1 was asked for, Options::derivative_order is 0");
}

TEST(RbfInput, IsRefusedIfItWouldTakeTooLong) {
  const rbf::Points<2> centres = naive::numbers(2, 3000, 1);
  for (const Method method : {Method::direct, Method::gaussians}) {
    Options options{.method = method};
    const auto plan = [&] { return Plan<2>(multiquadric, centres, Eigen::MatrixXd::Ones(3000, 1), options); };
    const double seconds = plan().choice().seconds;
    options.most_seconds = seconds;
    EXPECT_NO_THROW(plan());
    options.most_seconds = seconds / 2;
    try {
      plan();
      ADD_FAILURE() << rbf::to_string(method);
    } catch (const rbf::TimeLimitError& error) {
      EXPECT_EQ(error.seconds, seconds);
      EXPECT_EQ(error.method, method);
    }
  }
}

TEST(RbfSum, IsTheSameOnAGridInOnePassAndByColumns) {
  const rbf::Points<2> centres = naive::numbers(2, 600, 1);
  const Eigen::MatrixXd weights = naive::numbers(600, 2, 2);
  const rbf::TensorGrid grid{{{-0.9, 0, 0.1, 0.7}, {-0.5, 0.25, 0.5}}};
  rbf::Points<2> nodes(2, 12);
  for (int i = 0; i < 12; ++i)
    nodes.col(i) << grid.axes[0][static_cast<std::size_t>(i % 4)], grid.axes[1][static_cast<std::size_t>(i / 4)];
  for (const Function& function : naive::functions())
    for (const Method method : {Method::direct, Method::gaussians}) {
      Plan<2> plan(function, centres, weights, {.tolerance = 1e-8, .derivative_order = 1, .method = method});
      const double allowed = 2e-8 * weights.cwiseAbs().colwise().sum().maxCoeff() *
                             static_cast<double>(naive::scales(function, plan.choice().range).value);
      const Eigen::MatrixXd on_grid = plan.evaluate(grid), at_nodes = plan.evaluate(nodes);
      EXPECT_LE((on_grid - at_nodes).cwiseAbs().maxCoeff(), allowed) << plan.choice();
      const Eigen::MatrixXd together =
          plan.evaluate_combinations(nodes, {{{{0, 0}, 1.0}}, {{{1, 0}, 2.0}, {{0, 1}, 1.0}}});
      ASSERT_EQ(together.cols(), 4);
      const Eigen::MatrixXd along = 2 * plan.evaluate(nodes, {1, 0}) + plan.evaluate(nodes, {0, 1});
      const double steep = allowed * (1 + 3 * static_cast<double>(naive::scales(function, plan.choice().range).first /
                                                                  naive::scales(function, plan.choice().range).value));
      EXPECT_LE((together.leftCols(2) - at_nodes).cwiseAbs().maxCoeff(), allowed);
      EXPECT_LE((together.rightCols(2) - along).cwiseAbs().maxCoeff(), steep);
      // Other weights for the same points.
      plan.set_weights(-weights.rightCols(1));
      EXPECT_LE((plan.evaluate(nodes) + at_nodes.rightCols(1)).cwiseAbs().maxCoeff(), allowed);
    }
}

TEST(RbfSum, TakesAGridThatIsExpected) {
  const rbf::Points<2> centres = (naive::numbers(2, 3000, 1).array() + 1e4).matrix();
  const Eigen::MatrixXd weights = naive::numbers(3000, 1, 2);
  rbf::TensorGrid grid{{{}, {}}};
  for (int i = 0; i < 30; ++i) {
    grid.axes[0].push_back(1e4 - 0.9 + 0.06 * i);
    grid.axes[1].push_back(1e4 - 0.8 + 0.04 * i);
  }
  for (const Function& function : naive::functions()) {
    const auto sum = [&](Method method) {
      const Plan<2> plan(function, centres, weights, {.method = method, .expected_grid = grid});
      EXPECT_EQ(plan.choice().targets, 900U);
      return plan.evaluate(grid);
    };
    const double scale = rbf::largest_value(function, 3) * weights.cwiseAbs().sum();
    EXPECT_LE((sum(Method::gaussians) - sum(Method::direct)).cwiseAbs().maxCoeff(), 1e-6 * scale)
        << rbf::to_string(function.kernel);
  }
}

TEST(RbfSum, IsTheSameToTheLastBitOnAnyNumberOfThreads) {
  const rbf::Points<3> centres = naive::numbers(3, 2000, 1);
  const Eigen::MatrixXd weights = naive::numbers(2000, 1, 2);
  for (const Function& function : naive::functions())
    for (const Method method : {Method::direct, Method::gaussians}) {
      const auto sum = [&](int threads) {
        return Plan<3>(function, centres, weights, {.method = method, .threads = threads})
            .evaluate(centres.leftCols(500));
      };
      EXPECT_EQ(sum(1), sum(3)) << rbf::to_string(function.kernel) << " by " << rbf::to_string(method);
    }
}

TEST(RbfSum, IsDirectForFewPointsAndByGaussiansForMany) {
  const rbf::Points<2> centres = naive::numbers(2, 8000, 1);
  for (const Function& function : naive::functions()) {
    const auto method = [&](Eigen::Index count, double tolerance) {
      return Plan<2>(function, centres.leftCols(count), Eigen::MatrixXd::Ones(count, 1), {.tolerance = tolerance})
          .choice()
          .method;
    };
    EXPECT_EQ(method(300, 1e-6), Method::direct);
    EXPECT_EQ(method(8000, 1e-6), Method::gaussians);
    EXPECT_EQ(method(2000, 1e-13), Method::direct);
  }
}

}  // namespace
