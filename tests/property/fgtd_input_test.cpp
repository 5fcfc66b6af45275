// Each wrong argument is refused with the right type of exception and a sentence that names argument, value and rule.
#include <gtest/gtest.h>

#include <limits>

#include "oracle/naive.hpp"

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The message of the exception that `action` throws.
template <class Exception, class Action>
std::string message(const Action& action) {
  try {
    action();
  } catch (const Exception& exception) {
    return exception.what();
  } catch (const std::exception& exception) {
    return std::string("another exception: ") + exception.what();
  }
  return "nothing thrown";
}

struct Arguments {
  fgtd::Points<2> sources = naive::random_points<2>(20, 41);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(20, 2);
  double sigma = 3;
  fgtd::Options options;

  fgtd::Plan<2> plan() const { return fgtd::Plan<2>(sources, weights, sigma, options); }
};

std::string refusal(const Arguments& arguments) {
  return message<fgtd::InvalidArgument>([&] { arguments.plan(); });
}

TEST(FgtdInput, SourcesAreFinite) {
  Arguments arguments;
  arguments.sources(1, 17) = nan;
  EXPECT_EQ(refusal(arguments), "fgtd: source 17, coordinate 1 is nan; sources must be finite");
  arguments.sources(1, 17) = -infinity;
  EXPECT_EQ(refusal(arguments), "fgtd: source 17, coordinate 1 is -inf; sources must be finite");
}

TEST(FgtdInput, WeightsAreFiniteAndOneForEverySource) {
  Arguments arguments;
  arguments.weights(3, 1) = infinity;
  EXPECT_EQ(refusal(arguments), "fgtd: weight 3, column 1 is inf; weights must be finite");
  arguments.weights = Eigen::MatrixXd::Ones(19, 2);
  EXPECT_EQ(refusal(arguments), "fgtd: weights have 19 rows for 20 sources; there must be one row for every source");
  auto plan = Arguments().plan();
  EXPECT_EQ(message<fgtd::InvalidArgument>([&] { plan.set_weights(Eigen::MatrixXd::Constant(20, 1, nan)); }),
            "fgtd: weight 0, column 0 is nan; weights must be finite");
  EXPECT_EQ(message<fgtd::InvalidArgument>([&] { plan.set_weights(Eigen::MatrixXd::Ones(21, 1)); }),
            "fgtd: weights have 21 rows for 20 sources; there must be one row for every source");
}

TEST(FgtdInput, SigmaIsPositiveAndFinite) {
  for (const auto& [sigma, text] : {std::pair{0.0, "0"}, {-2.5, "-2.5"}, {nan, "nan"}, {infinity, "inf"}}) {
    Arguments arguments;
    arguments.sigma = sigma;
    EXPECT_EQ(refusal(arguments), std::string("fgtd: sigma = ") + text + ", must be positive and finite");
  }
}

TEST(FgtdInput, ToleranceCanBePromised) {
  for (const auto& [tolerance, text] : {std::pair{2.0, "2"}, {1.0, "1"}, {0.0, "0"}, {-1.0, "-1"}, {nan, "nan"}}) {
    Arguments arguments;
    arguments.options.tolerance = tolerance;
    EXPECT_EQ(refusal(arguments), std::string("fgtd: Options::tolerance = ") + text + ", must lie in [1e-14, 1)");
  }
  Arguments arguments;
  arguments.options.tolerance = 1e-15;
  EXPECT_EQ(message<fgtd::ToleranceError>([&] { arguments.plan(); }),
            "fgtd: Options::tolerance = 1e-15 cannot be promised in double precision, must lie in [1e-14, 1)");
  arguments.options.tolerance = fgtd::smallest_tolerance;
  EXPECT_NO_THROW(arguments.plan());
}

TEST(FgtdInput, OptionsAreInTheirRanges) {
  Arguments arguments;
  arguments.options.derivative_order = -1;
  EXPECT_EQ(refusal(arguments), "fgtd: Options::derivative_order = -1, must lie in 0 .. 16");
  arguments.options.derivative_order = 13;
  arguments.options.tolerance = 1e-3;
  EXPECT_EQ(message<fgtd::ToleranceError>([&] { arguments.plan(); }),
            "fgtd: Options::tolerance = 0.001 cannot be promised for derivatives above order 12, must be at most 1e-04 "
            "there");
  arguments.options = {};
  arguments.options.threads = -2;
  EXPECT_EQ(refusal(arguments), "fgtd: Options::threads = -2, must be positive, or 0 for all");
  arguments.options = {};
  arguments.options.expected_grid = fgtd::TensorGrid{{{0, 1}, {1, 0}}};
  EXPECT_EQ(
      refusal(arguments),
      "fgtd: Options::expected_grid, axis 1, node 1 = 0 does not exceed the node before it, 1; nodes must ascend");
}

TEST(FgtdInput, ParametersByHandAreInTheirRanges) {
  const auto refused = [](const fgtd::HermiteParameters& parameters, fgtd::Method method = fgtd::Method::automatic) {
    Arguments arguments;
    arguments.options.hermite = parameters;
    arguments.options.method = method;
    return refusal(arguments);
  };
  EXPECT_EQ(refused({.box_scale = 0}), "fgtd: HermiteParameters::box_scale = 0, must be positive and finite");
  EXPECT_EQ(refused({.expansion_order = 0}), "fgtd: HermiteParameters::expansion_order = 0, must lie in 1 .. 1000");
  EXPECT_EQ(refused({.neighbours = -2}),
            "fgtd: HermiteParameters::neighbours = -2, must be at least 0, or all_boxes (-1)");
  EXPECT_EQ(refused({}, fgtd::Method::direct),
            "fgtd: Options::hermite is given but Options::method = direct; leave the method to auto or hermite");
}

TEST(FgtdInput, TargetsAreFinite) {
  const auto plan = Arguments().plan();
  fgtd::Points<2> targets = naive::random_points<2>(5, 42);
  targets(0, 4) = nan;
  EXPECT_EQ(message<fgtd::InvalidArgument>([&] { plan.evaluate(targets); }),
            "fgtd: target 4, coordinate 0 is nan; targets must be finite");
}

TEST(FgtdInput, GridsHaveOneAscendingFiniteAxisADimension) {
  const auto plan = Arguments().plan();
  const auto refused = [&](const fgtd::TensorGrid& grid) {
    return message<fgtd::InvalidArgument>([&] { plan.evaluate(grid); });
  };
  EXPECT_EQ(refused({{{0, 1}}}), "fgtd: grid has 1 axes, must have 2");
  EXPECT_EQ(refused({{{0, 1}, {0, 0}}}),
            "fgtd: grid, axis 1, node 1 = 0 does not exceed the node before it, 0; nodes must ascend");
  EXPECT_EQ(refused({{{0, nan}, {0, 1}}}), "fgtd: grid, axis 0, node 1 is nan; nodes must be finite");
}

TEST(FgtdInput, DerivativesAreWithinThePlan) {
  Arguments arguments;
  arguments.options.derivative_order = 2;
  const auto plan = arguments.plan();
  const auto targets = naive::random_points<2>(5, 43);
  const auto refused = [&](const fgtd::Combination<2>& combination) {
    return message<fgtd::InvalidArgument>([&] { plan.evaluate_combination(targets, combination); });
  };
  EXPECT_EQ(refused({{{2, 1}, 1.0}}),
            "fgtd: derivative (2, 1) is of order 3, the plan was made for Options::derivative_order = 2");
  EXPECT_EQ(refused({{{-1, 0}, 1.0}}), "fgtd: derivative (-1, 0) has a negative entry");
  EXPECT_EQ(refused({{{1, 0}, nan}}), "fgtd: coefficient of derivative (1, 0) is nan, must be finite");

  arguments.sigma = 1e308;
  const auto sharp = arguments.plan();
  EXPECT_NE(message<fgtd::InvalidArgument>([&] {
              sharp.evaluate(targets, {2, 0});
            }).find("exceeds the range of double"),
            std::string::npos);
}

TEST(FgtdInput, ParametersByHandKeepTheDerivativeOrder) {
  Arguments arguments;
  arguments.options.hermite = fgtd::HermiteParameters{};
  const auto plan = arguments.plan();
  EXPECT_EQ(message<fgtd::InvalidArgument>([&] {
              plan.evaluate(naive::random_points<2>(5, 44), {1, 0});
            }),
            "fgtd: derivative (1, 0) is of order 1, the plan was made for Options::derivative_order = 0");
}

TEST(FgtdMemory, LimitIsKeptAndTheNumberIsSaid) {
  Arguments arguments;
  arguments.options.memory_limit = 100;
  EXPECT_EQ(message<fgtd::MemoryLimitError>([&] { arguments.plan(); }),
            "fgtd: the plan needs about 640 bytes, Options::memory_limit is 100 bytes");
  arguments.options.memory_limit = 100000;
  const auto plan = arguments.plan();
  const auto big = naive::cube_grid<2>(1000, 0, 1);
  EXPECT_NE(message<fgtd::MemoryLimitError>([&] { plan.evaluate(big); }).find("evaluation needs about 160006"),
            std::string::npos);
  // A grid whose result is beyond every machine is refused by arithmetic, not by the allocator.
  fgtd::TensorGrid enormous{{naive::nodes(1000000, 0, 1), naive::nodes(1000000, 0, 1)}};
  EXPECT_THROW(plan.evaluate(enormous), fgtd::MemoryLimitError);
}

TEST(FgtdMemory, AutomaticTakesAMethodThatFits) {
  const auto sources = naive::random_points<3>(3000, 45);
  fgtd::Options options{.tolerance = 1e-4, .expected_targets = 1000000};
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(3000, 1);
  ASSERT_NE(fgtd::Plan<3>(sources, weights, 2.0, options).choice().method, fgtd::Method::direct);
  options.memory_limit = 110000;
  EXPECT_EQ(fgtd::Plan<3>(sources, weights, 2.0, options).choice().method, fgtd::Method::direct);
  options.method = fgtd::Method::hermite;
  EXPECT_THROW(fgtd::Plan<3>(sources, weights, 2.0, options), fgtd::MemoryLimitError);
}

TEST(FgtdTime, IsRefusedBeforeTheWorkBegins) {
  Arguments arguments;
  for (const fgtd::Method method : fgtd::methods()) {
    arguments.options = {.tolerance = 1e-3, .method = method};
    const fgtd::Choice choice = arguments.plan().choice();
    arguments.options.most_seconds = choice.seconds;
    EXPECT_NO_THROW(arguments.plan()) << fgtd::to_string(method);
    arguments.options.most_seconds = choice.seconds / 2;
    try {
      arguments.plan();
      ADD_FAILURE() << fgtd::to_string(method);
    } catch (const fgtd::TimeLimitError& error) {
      EXPECT_EQ(error.seconds, choice.seconds);
      EXPECT_EQ(error.method, choice.method);
      EXPECT_EQ(std::string(error.what()).rfind("fgtd: " + fgtd::to_string(choice.method) + " would take about 1 s", 0),
                0u)
          << error.what();
    }
  }
  arguments.options = {.most_seconds = nan};
  EXPECT_EQ(refusal(arguments), "fgtd: Options::most_seconds = nan, must be at least 0");
}

TEST(FgtdMemory, DoesNotDependOnSigma) {
  const auto sources = naive::random_points<3>(100, 46);
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(100, 1);
  for (const double sigma : {1e-12, 1.0, 1e12, 1e20}) {
    fgtd::Options options{.tolerance = 1e-2, .method = fgtd::Method::hermite, .memory_limit = 10000000};
    EXPECT_NO_THROW(fgtd::Plan<3>(sources, weights, sigma, options).evaluate(naive::cube_grid<3>(8, -1, 2))) << sigma;
  }
}

}  // namespace
