// Every kernel of the catalogue: its formula, derivatives, integral over Gaussians, and sum of Gaussians.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rbf/expansion/expansion.hpp"
#include "rbf/kernels/dispatch.hpp"
#include "rbf/naive.hpp"

namespace {

class EveryKernel : public testing::TestWithParam<rbf::Function> {};

constexpr double distances[] = {0, 1e-9, 0.01, 0.3, 0.6065, 1, 2.5};

TEST_P(EveryKernel, IsItsFormula) {
  for (const double r : distances) {
    const double scale = std::abs(static_cast<double>(naive::phi(GetParam(), r)));
    // 1e-15: two roundings
    EXPECT_NEAR(rbf::value(GetParam(), r), static_cast<double>(naive::phi(GetParam(), r)), 1e-15 * scale) << r;
    const double slope = static_cast<double>(naive::slopes(GetParam(), r).first);
    EXPECT_NEAR(rbf::derivative(GetParam(), r), slope, 1e-15 * std::abs(slope)) << r;
  }
}

TEST_P(EveryKernel, HasTheSlopesOfDifferences) {
  const rbf::detail::KernelEntry& entry = rbf::detail::entry_of(GetParam().kernel);
  for (const long double s : {0.01L, 0.3L, 2.0L}) {
    const long double h = 1e-5L * s;
    const auto at = [&](long double x) { return entry.profile(x, GetParam().shape); };
    const long double slope = (at(s + h).value - at(s - h).value) / (2 * h),
                      curvature = (at(s + h).slope - at(s - h).slope) / (2 * h);
    // 1e-8: differences are right to h^2 / s^2 times a third derivative
    EXPECT_NEAR(static_cast<double>(at(s).slope / slope), 1, 1e-8);
    EXPECT_NEAR(static_cast<double>(at(s).curvature / curvature), 1, 1e-8);
  }
}

// Odd derivatives of x -> phi(|x|) vanish at 0 where they are continuous. The first that jumps is that after the last
// continuous one; with r^2 ln r the second has no limit.
TEST_P(EveryKernel, HasAsManyContinuousDerivativesAsItSays) {
  const int continuous = rbf::continuous_derivatives(GetParam().kernel);
  const auto second = [&](long double r) { return naive::slopes(GetParam(), r).second; };
  const auto third = [&](long double r) { return (second(2 * r) - second(r)) / r; };
  const long double scale = std::abs(second(0)) / GetParam().shape, small = 1e-5L;
  if (continuous < 2) {
    EXPECT_EQ(GetParam().kernel, rbf::Kernel::thin_plate);  // 2 ln r + 3
    return;
  }
  if (continuous == 2) {
    EXPECT_GT(std::abs(third(small)), 0.5 * scale);
    return;
  }
  EXPECT_LT(std::abs(third(small)), 1e-2 * scale);
  const long double fifth = (third(2 * small) - 2 * third(small)) / (small * small);  // of even powers: nearly 0
  if (continuous == 4) {
    EXPECT_GT(std::abs(fifth), scale / (GetParam().shape * GetParam().shape));
  } else {
    EXPECT_EQ(continuous, std::numeric_limits<int>::max());
    EXPECT_LT(std::abs(fifth), 0.1 * scale / (GetParam().shape * GetParam().shape));
  }
}

// Bernstein: the derivative of order m is, up to sign, the integral of rho t^m exp(-t s).
TEST_P(EveryKernel, IsAnIntegralOverGaussians) {
  const rbf::detail::KernelEntry& entry = rbf::detail::entry_of(GetParam().kernel);
  if (!entry.density) {
    EXPECT_EQ(GetParam().kernel, rbf::Kernel::gaussian);
    return;
  }
  for (const long double s : {0.02L, 0.5L, 3.0L}) {
    const rbf::detail::Profile at = entry.profile(s, GetParam().shape);
    const long double exact[] = {at.value, at.slope, at.curvature};
    long double integral = 0;
    constexpr long double h = 1.0L / 64;
    for (long double u = -60; u < 60; u += h) {
      const long double t = std::exp(u);
      integral += h * t * entry.density(static_cast<double>(t), GetParam().shape) * std::pow(t, entry.positive_order) *
                  std::exp(-t * s);
    }
    // 1e-9: the trapezoidal rule in ln t is exact to exp(-pi^2/h), its ends to exp(-30)
    EXPECT_NEAR(static_cast<double>(integral / std::abs(exact[entry.positive_order])), 1, 1e-9);
  }
}

TEST_P(EveryKernel, IsFewGaussiansToTheAccuracy) {
  std::size_t before = 0;
  for (const double accuracy : {1e-2, 1e-4, 1e-7, 1e-10}) {
    const rbf::detail::Expansion sum = rbf::detail::expand(GetParam(), 3, 0, 0, accuracy);
    const long double largest = naive::scales(GetParam(), 3).value;
    long double worst = 0;
    for (int i = 0; i <= 3000; ++i) {
      const long double r = i == 0 ? 0 : 3 * std::pow(10.0L, -9 + 9.0L * i / 3000);
      worst = std::max(worst, std::abs(sum.profile(r * r).value - naive::phi(GetParam(), r)));
    }
    EXPECT_LE(static_cast<double>(worst / largest), 1.01 * accuracy);  // 1.01: other samples than those measured at
    EXPECT_LE(sum.error, accuracy);
    EXPECT_GE(sum.terms.size(), before);
    EXPECT_LE(sum.terms.size(), 40U);
    before = sum.terms.size();
  }
}

// One Gaussian costs more than the search for all of them. It must not stop early where accuracy or range are a little
// different.
TEST(Gaussians, AreFewWhateverAccuracyAndRangeExactlyAre) {
  struct Row {
    rbf::Function function;
    std::size_t most;  // the fewest that were ever found, and one
  };
  for (const Row& row : {Row{{rbf::Kernel::matern32, 0.1}, 13}, Row{{rbf::Kernel::thin_plate, 0}, 12},
                         Row{{rbf::Kernel::inverse_quadratic, 0.1}, 10}})
    for (const double range : {1.41, 1.414})
      for (const double accuracy : {5e-7, 6e-7, 7e-7})
        EXPECT_LE(rbf::detail::expand(row.function, range, 0, 0, accuracy).terms.size(), row.most)
            << rbf::to_string(row.function.kernel) << " on [0, " << range << "] to " << accuracy;
}

TEST_P(EveryKernel, TellsItsLargestValue) {
  for (const double range : {0.05, 0.7, 1.0, 4.0}) {
    const double exact = static_cast<double>(naive::scales(GetParam(), range).value);
    EXPECT_NEAR(rbf::largest_value(GetParam(), range), exact, 1e-5 * exact) << range;  // 1e-5: samples beside the turn
  }
}

TEST_P(EveryKernel, TellsItsLargestDerivatives) {
  const int highest = rbf::highest_derivative(GetParam().kernel);
  for (const double range : {0.05, 0.7, 4.0}) {
    const naive::Scales exact = naive::scales(GetParam(), range);
    const long double of[] = {exact.value, exact.first, exact.second};
    for (int order = 0; order <= highest; ++order)
      EXPECT_NEAR(rbf::largest_derivative(GetParam(), range, order) / static_cast<double>(of[order]), 1, 2e-3)
          << range << " " << order;  // samples of both
  }
  for (const int order : {-1, highest + 1})
    EXPECT_THROW(rbf::largest_derivative(GetParam(), 1, order), rbf::InvalidArgument);
}

TEST_P(EveryKernel, HasANameAndAFormula) {
  EXPECT_EQ(rbf::kernel_named(rbf::to_string(GetParam().kernel)), GetParam().kernel);
  EXPECT_NE(rbf::formula(GetParam().kernel).find('r'), std::string::npos);
}

TEST_P(EveryKernel, IsTheSameOnEveryInstructionSet) {
  const std::size_t sources = 300;
  const Eigen::MatrixXd points = naive::numbers(3, static_cast<Eigen::Index>(sources), 1);
  const Eigen::MatrixXd by_axis = points.transpose(),
                        weights = naive::numbers(static_cast<Eigen::Index>(sources), 1, 2);
  double target[3 * rbf::detail::group_size];
  for (std::size_t i = 0; i < rbf::detail::group_size; ++i)
    for (std::size_t l = 0; l < 3; ++l)
      target[l * rbf::detail::group_size + i] =
          by_axis(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(l)) + (i > 3 ? 0.01 : 0);
  const int order = rbf::highest_derivative(GetParam().kernel);
  const std::size_t outputs = rbf::detail::derivatives_up_to(3, order) * rbf::detail::group_size;
  std::vector<std::vector<double>> found;
  for (const rbf::detail::Kernels* kernels : rbf::detail::supported_kernels()) {
    found.emplace_back(outputs);
    kernels->pairs({.dimension = 3,
                    .kernel = GetParam().kernel,
                    .shape = GetParam().shape,
                    .order = order,
                    .sources = sources,
                    .position = by_axis.data(),
                    .weights = weights.data(),
                    .target = target,
                    .out = found.back().data()});
    for (std::size_t i = 0; i < outputs; ++i)
      EXPECT_NEAR(found.back()[i], found[0][i], 1e-12 * 300 * 30) << kernels->name;  // 300 terms of at most about 30
  }
}

INSTANTIATE_TEST_SUITE_P(Rbf, EveryKernel, testing::ValuesIn(naive::functions()),
                         [](const auto& of) { return naive::name(of.param); });

TEST(RbfKernels, AreDefiniteUpToTheirOrder) {
  EXPECT_EQ(rbf::positive_order(rbf::Kernel::multiquadric), 1);
  EXPECT_EQ(rbf::positive_order(rbf::Kernel::thin_plate), 2);
  EXPECT_EQ(rbf::positive_order(rbf::Kernel::matern32), 0);
  EXPECT_EQ(rbf::highest_derivative(rbf::Kernel::thin_plate), 1);
  EXPECT_FALSE(rbf::kernel_named("cubic"));
}

}  // namespace
