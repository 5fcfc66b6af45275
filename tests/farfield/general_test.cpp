// Sums for general kernels: the promise against sums in long double, over clouds that are hard for clusters; what is
// refused; storage, orders and threads.
#include "farfield/general.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "farfield/clouds.hpp"
#include "farfield/naive.hpp"
#include "message_of.hpp"
#include "share_from.hpp"

namespace {

using Eigen::VectorXd;
using farfield::GeneralMethod;
using farfield::GeneralOptions;
using farfield::GeneralPlan;
using farfield::KernelFunction;
using farfield::Points;

struct Named {
  std::string name;
  KernelFunction kernel;
  long double (*value)(long double r);  // at r > 0
  long double at_zero;
};

std::vector<Named> kernels() {
  const auto each = [](double (*value)(double r)) {
    return KernelFunction::of_distance([value](const double* r, std::size_t count, double* values) {
      for (std::size_t i = 0; i < count; ++i) values[i] = value(r[i]);
    });
  };
  return {{"yukawa", KernelFunction::yukawa(2.5), [](long double r) { return std::exp(-2.5L * r) / r; }, 0},
          {"1/r^4", KernelFunction::inverse_power(4), [](long double r) { return std::pow(r, -4.0L); }, 0},
          {"gaussian", KernelFunction::gaussian(7), [](long double r) { return std::exp(-7.0L * r * r); }, 1},
          {"log", each([](double r) { return std::log(r); }), [](long double r) { return std::log(r); }, 0},
          {"multiquadric", each([](double r) { return std::sqrt(r * r + 0.04); }),
           [](long double r) { return std::sqrt(r * r + 0.04L); }, std::sqrt(0.04L)}};
}

/// The sums, and the sums without signs.
template <int d>
struct Exact {
  VectorXd sums, sizes;
};

template <int d>
Exact<d> exact_sums(const Named& named, const Points<d>& sources, const Points<d>& targets, const VectorXd& charges) {
  Exact<d> exact{VectorXd(targets.cols()), VectorXd(targets.cols())};
  for (Eigen::Index i = 0; i < targets.cols(); ++i) {
    long double sum = 0, size = 0;
    for (Eigen::Index j = 0; j < sources.cols(); ++j) {
      long double squared = 0;
      for (int l = 0; l < d; ++l) {
        const long double along = static_cast<long double>(targets(l, i)) - static_cast<long double>(sources(l, j));
        squared += along * along;
      }
      const long double term = charges[j] * (squared == 0 ? named.at_zero : named.value(std::sqrt(squared)));
      sum += term;
      size += std::abs(term);
    }
    exact.sums[i] = static_cast<double>(sum);
    exact.sizes[i] = static_cast<double>(size);
  }
  return exact;
}

double mean_square_root(const VectorXd& values) { return values.stableNorm() / std::sqrt(1.0 * values.size()); }

/// The error of an evaluation, in units in which the promise is the tolerance. Rounding is taken off.
template <int d>
double error_of(const GeneralPlan<d>& plan, const Exact<d>& exact, const VectorXd& charges) {
  const double error = mean_square_root(plan.evaluate(charges) - exact.sums) - 1e-14 * mean_square_root(exact.sizes);
  return std::max(0.0, error) /
         (plan.choice().kernel_size * std::sqrt(static_cast<double>(charges.size())) * charges.stableNorm());
}

template <int d>
void expect_promise(double tolerance, Eigen::Index count) {
  for (const Named& named : kernels())
    for (const clouds::Cloud<d>& cloud : clouds::all<d>(count, 5)) {
      SCOPED_TRACE(named.name + ", " + cloud.name);
      const GeneralPlan<d> plan(
          named.kernel, cloud.points,
          {.tolerance = tolerance, .method = GeneralMethod::interpolation, .threads = 1, .leaf_size = 5});
      EXPECT_LE(plan.choice().measured, tolerance);
      for (const clouds::Charges& charges : clouds::charges(count, 3))
        EXPECT_LE(error_of<d>(plan, exact_sums<d>(named, cloud.points, cloud.points, charges.values), charges.values),
                  tolerance)
            << charges.name << ", " << plan.choice();
    }
}

TEST(FarfieldGeneral, KeepsItsPromiseInThePlane) { expect_promise<2>(1e-4, 160); }

TEST(FarfieldGeneral, KeepsItsPromiseInSpace) { expect_promise<3>(1e-2, 120); }

TEST(FarfieldGeneral, KeepsItsPromiseToManyDigits) {
  for (const Named& named : kernels()) {
    const Points<2> points = naive::cube<2>(200, 1);
    const VectorXd charges = naive::charges(200, 2);
    const Exact<2> exact = exact_sums<2>(named, points, points, charges);
    for (const double tolerance : {1e-6, 1e-10}) {
      const GeneralPlan<2> plan(named.kernel, points,
                                {.tolerance = tolerance, .method = GeneralMethod::interpolation, .leaf_size = 6});
      EXPECT_GT(plan.choice().levels.size(), 0U) << named.name;
      EXPECT_LE(error_of<2>(plan, exact, charges), tolerance) << named.name << ", " << plan.choice();
    }
  }
}

TEST(FarfieldGeneral, TakesTargetsThatAreNotTheSources) {
  for (const Named& named : {kernels()[0], kernels()[3]}) {
    const Points<3> sources = naive::cube<3>(300, 1), targets = naive::cube<3>(150, 2, 0.3, 1.6);
    const VectorXd charges = naive::charges(300, 2);
    const GeneralPlan<3> plan(named.kernel, sources, targets,
                              {.tolerance = 1e-3, .method = GeneralMethod::interpolation, .leaf_size = 6});
    EXPECT_EQ(plan.choice().targets, 150U);
    EXPECT_LT(plan.choice().pairs, 0.9 * 300 * 150);
    EXPECT_LE(error_of<3>(plan, exact_sums<3>(named, sources, targets, charges), charges), 1e-3) << named.name;
  }
}

TEST(FarfieldGeneral, TakesKernelsWithoutSymmetry) {
  // Odd in one axis, and steeper along another.
  const auto value = [](double x, double y) { return (1 + x) * std::exp(-x * x - 3 * y * y); };
  const KernelFunction kernel =
      KernelFunction::of_difference([&](const double* const* difference, std::size_t count, double* values) {
        for (std::size_t i = 0; i < count; ++i) values[i] = value(difference[0][i], difference[1][i]);
      });
  const Points<2> points = naive::cube<2>(400, 4);
  const VectorXd charges = naive::charges(400, 2);
  VectorXd exact = VectorXd::Zero(400);
  for (Eigen::Index i = 0; i < 400; ++i)
    for (Eigen::Index j = 0; j < 400; ++j)
      exact[i] += charges[j] * value(points(0, i) - points(0, j), points(1, i) - points(1, j));
  const GeneralPlan<2> plan(kernel, points,
                            {.tolerance = 1e-6, .method = GeneralMethod::interpolation, .leaf_size = 6});
  EXPECT_LT(plan.choice().pairs, 0.9 * 400 * 400);
  EXPECT_LE(error_of<2>(plan, {exact, exact.cwiseAbs()}, charges), 1e-6);
}

TEST(FarfieldGeneral, SumsAllPairsAsTheDefinition) {
  for (const Named& named : kernels()) {
    Points<3> points = naive::cube<3>(90, 8);
    points.col(1) = points.col(0);
    points.col(3) = points.col(2) + Eigen::Vector3d(0, 1e-19 * points(1, 2), 0);
    points.col(5) = Eigen::Vector3d(1e-20, 0, 0);  // 1e-20 apart: beyond what vectors of the processor take
    points.col(6).setZero();
    const VectorXd charges = naive::charges(90, 1);
    const GeneralPlan<3> plan(named.kernel, points, {.method = GeneralMethod::direct});
    EXPECT_EQ(plan.choice().method, GeneralMethod::direct);
    const Exact<3> exact = exact_sums<3>(named, points, points, charges);
    const VectorXd sums = plan.evaluate(charges);
    for (Eigen::Index i = 0; i < 90; ++i)
      EXPECT_NEAR(sums[i], exact.sums[i], 1e-13 * exact.sizes[i]) << named.name << ", target " << i;
  }
}

TEST(FarfieldGeneral, CountsAPairAtDistanceZeroWhereTheKernelIsFinite) {
  const Points<2> points = Points<2>::Constant(2, 7, 0.3);
  const VectorXd charges = VectorXd::Ones(7);
  for (const GeneralMethod method : {GeneralMethod::direct, GeneralMethod::interpolation}) {
    EXPECT_DOUBLE_EQ(GeneralPlan<2>(KernelFunction::gaussian(3), points, {.method = method}).evaluate(charges)[2], 7);
    EXPECT_DOUBLE_EQ(GeneralPlan<2>(KernelFunction::yukawa(3), points, {.method = method}).evaluate(charges)[2], 0);
  }
}

TEST(FarfieldGeneral, ManyEqualPointsCostOneValue) {
  // Two places with 20 000 points each: 1.6e9 pairs of points.
  const Eigen::Index count = 40000;
  Points<2> points(2, count);
  for (Eigen::Index j = 0; j < count; ++j) points.col(j).setConstant(j % 2 == 0 ? 0.25 : 0.75);
  const GeneralPlan<2> plan(KernelFunction::yukawa(1), points,
                            {.tolerance = 1e-4, .method = GeneralMethod::interpolation});
  EXPECT_EQ(plan.choice().pairs, 0);
  const double r = std::sqrt(0.5), exact = count / 2 * std::exp(-r) / r;
  EXPECT_NEAR(plan.evaluate(VectorXd::Ones(count))[0], exact, 1e-4 * exact);
}

TEST(FarfieldGeneral, TakesFewPointsAndNone) {
  for (const GeneralMethod method : {GeneralMethod::automatic, GeneralMethod::interpolation}) {
    const GeneralOptions options{.method = method};
    EXPECT_EQ(GeneralPlan<3>(KernelFunction::yukawa(1), Points<3>(3, 0), options).evaluate(VectorXd(0)).size(), 0);
    EXPECT_EQ(GeneralPlan<3>(KernelFunction::yukawa(1), Points<3>(3, 0), Points<3>(Points<3>::Ones(3, 2)), options)
                  .evaluate(VectorXd(0)),
              VectorXd::Zero(2));
    Points<3> two = Points<3>::Zero(3, 2);
    two(0, 1) = 2;
    EXPECT_NEAR(GeneralPlan<3>(KernelFunction::inverse_power(1), two, options).evaluate(VectorXd::Ones(2))[1], 0.5,
                1e-15);
  }
}

TEST(FarfieldGeneral, ResultsDoNotDependOnTheNumberOfThreads) {
  const ShareFrom all_work(0);
  const Points<3> points = naive::plummer<3>(600, 3);
  const VectorXd charges = naive::charges(600, 4);
  const auto sums = [&](int threads) {
    return GeneralPlan<3>(
               KernelFunction::yukawa(0.3), points,
               {.tolerance = 1e-2, .method = GeneralMethod::interpolation, .threads = threads, .leaf_size = 8})
        .evaluate(charges);
  };
  const VectorXd one = sums(1);
  EXPECT_EQ(one, sums(2));
  EXPECT_EQ(one, sums(5));
}

TEST(FarfieldGeneral, RecompressionLowersStorageAtEqualError) {
  const Points<3> points = naive::cube<3>(1500, 3);
  const auto choice_of = [&](double tolerance, bool recompress) {
    return GeneralPlan<3>(KernelFunction::yukawa(1), points,
                          {.tolerance = tolerance,
                           .method = GeneralMethod::interpolation,
                           .leaf_size = 12,
                           .recompress = recompress})
        .choice();
  };
  const farfield::GeneralChoice plain = choice_of(1e-3, false), small = choice_of(plain.measured, true);
  EXPECT_LE(small.measured, plain.measured);
  EXPECT_LT(3 * (small.basis_bytes + small.coupling_bytes), plain.basis_bytes + plain.coupling_bytes);
}

TEST(FarfieldGeneral, OrdersRiseWithTheSizeOfClustersAndSaveFunctions) {
  const Points<2> points = naive::cube<2>(4000, 3);
  const auto choice_of = [&](bool variable) {
    return GeneralPlan<2>(KernelFunction::inverse_power(1), points,
                          {.tolerance = 1e-6,
                           .method = GeneralMethod::interpolation,
                           .leaf_size = 6,
                           .recompress = false,
                           .variable_order = variable})
        .choice();
  };
  const farfield::GeneralChoice variable = choice_of(true), fixed = choice_of(false);
  ASSERT_GE(variable.levels.size(), 4U);
  EXPECT_GT(variable.levels.front().order, variable.levels.back().order);
  for (std::size_t k = 1; k < variable.levels.size(); ++k)
    EXPECT_LE(variable.levels[k].order, variable.levels[k - 1].order);
  for (const farfield::GeneralLevel& level : fixed.levels) EXPECT_EQ(level.order, variable.levels.front().order);
  EXPECT_LE(variable.measured, 1e-6);
  EXPECT_LT(1.3 * variable.basis_bytes, fixed.basis_bytes);
}

TEST(FarfieldGeneral, KeepsItsPromiseForEveryEta) {
  const Points<2> points = naive::cube<2>(900, 3);
  const VectorXd charges = naive::charges(900, 4);
  const Named yukawa = kernels()[0];
  const Exact<2> exact = exact_sums<2>(yukawa, points, points, charges);
  int separation = 1;
  for (const double eta : {1.5, 0.8, 0.5, 0.36}) {
    const GeneralPlan<2> plan(yukawa.kernel, points,
                              {.tolerance = 1e-5, .method = GeneralMethod::interpolation, .eta = eta, .leaf_size = 5});
    EXPECT_EQ(plan.choice().separation, separation++);
    EXPECT_LE(error_of<2>(plan, exact, charges), 1e-5) << "eta " << eta;
  }
}

TEST(FarfieldGeneral, RefusesKernelsThatAreNotSmoothEnough) {
  const auto refusal = [](double (*value)(double r), GeneralMethod method, Eigen::Index count) {
    const KernelFunction kernel = KernelFunction::of_distance([value](const double* r, std::size_t n, double* values) {
      for (std::size_t i = 0; i < n; ++i) values[i] = value(r[i]);
    });
    return GeneralPlan<2>(kernel, naive::cube<2>(count, 3), {.tolerance = 1e-4, .method = method, .leaf_size = 6});
  };
  const auto oscillates = [](double r) { return std::cos(300 * r); };
  const auto jumps = [](double r) { return r < 0.6 ? 1.0 : 0.0; };
  EXPECT_THROW(refusal(oscillates, GeneralMethod::interpolation, 500), farfield::ToleranceError);
  EXPECT_THROW(refusal(jumps, GeneralMethod::interpolation, 500), farfield::ToleranceError);
  EXPECT_NE(gaussdrift::message_of<farfield::ToleranceError>([&] {
              refusal(jumps, GeneralMethod::interpolation, 500);
            }).find("not smooth enough"),
            std::string::npos);
  // Left to itself the library sums all pairs, as long as that is no question of minutes.
  EXPECT_EQ(refusal(oscillates, GeneralMethod::automatic, 2500).choice().method, GeneralMethod::direct);
}

TEST(FarfieldGeneral, RefusesBadArguments) {
  const Points<2> points = naive::cube<2>(50, 3);
  const KernelFunction yukawa = KernelFunction::yukawa(1);
  const auto plan = [&](const GeneralOptions& options) { return GeneralPlan<2>(yukawa, points, options); };
  EXPECT_THROW(plan({.tolerance = 0}), farfield::InvalidArgument);
  EXPECT_THROW(plan({.tolerance = 1e-11}), farfield::InvalidArgument);
  EXPECT_THROW(plan({.tolerance = NAN}), farfield::InvalidArgument);
  EXPECT_THROW(plan({.threads = -1}), farfield::InvalidArgument);
  EXPECT_THROW(plan({.eta = 0.3}), farfield::InvalidArgument);
  EXPECT_THROW(plan({.memory_limit = 100}), farfield::MemoryLimitError);
  EXPECT_THROW(plan({}).evaluate(VectorXd::Ones(49)), farfield::InvalidArgument);
  EXPECT_THROW(plan({}).evaluate(VectorXd::Constant(50, NAN)), farfield::InvalidArgument);
  EXPECT_THROW(plan({}).evaluate(VectorXd::Constant(50, 1e308)), farfield::RangeError);
  Points<2> wrong = points;
  wrong(1, 7) = HUGE_VAL;
  EXPECT_THROW(GeneralPlan<2>(yukawa, wrong), farfield::InvalidArgument);
  EXPECT_THROW(KernelFunction::yukawa(-1), farfield::InvalidArgument);
  EXPECT_THROW(KernelFunction::gaussian(0), farfield::InvalidArgument);
  EXPECT_THROW(KernelFunction::inverse_power(0), farfield::InvalidArgument);
  EXPECT_THROW(KernelFunction::of_distance({}), farfield::InvalidArgument);
  EXPECT_THROW(KernelFunction::of_difference({}), farfield::InvalidArgument);
  const KernelFunction infinite = KernelFunction::of_distance([](const double* r, std::size_t count, double* values) {
    for (std::size_t i = 0; i < count; ++i) values[i] = r[i] > 0.5 ? NAN : 1.0;
  });
  EXPECT_THROW(GeneralPlan<2>(infinite, points, {.method = GeneralMethod::interpolation}), farfield::InvalidArgument);
}

}  // namespace
