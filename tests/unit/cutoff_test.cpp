// Moment conditions of [Sch06, Definition 5.2.1], by the trapezoidal rule, which is exact to rounding for Gaussians
// times polynomials once the lattice is finer than about half a width.
#include "particle/cutoff.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace gaussdrift {
namespace {

double hermite(int n, double t) {  // H_n: d^n/dt^n exp(-t^2) = (-1)^n H_n(t) exp(-t^2)
  double before = 0, now = 1;
  for (int k = 0; k < n; ++k) before = std::exchange(now, 2 * t * now - 2 * k * before);
  return now;
}

double value(const Cutoff& cutoff, const Vector& x) {
  double sum = 0;
  for (const CutoffTerm& term : cutoff) {
    double product = term.coefficient;
    for (int k = 0; k < 3; ++k) {
      const double t = x[k] / term.width;
      const int n = term.derivative[k];
      product *= std::pow(-1 / term.width, n) * hermite(n, t) * std::exp(-t * t);
    }
    sum += product;
  }
  return sum;
}

// int x^a y^b z^c zeta_eps over `dimension` axes. Each term is a product over axes, and so is its sum over the lattice.
double moment(const Cutoff& cutoff, int dimension, double eps, const std::array<int, 3>& power) {
  const int half = 28;  // 14 eps each way, 7 widths of the wider Gaussian of two-gauss: what is cut off is below 1e-20
  const double spacing = 0.5 * eps;
  double sum = 0;
  for (const CutoffTerm& term : cutoff) {
    double product = term.coefficient;
    for (int k = 0; k < dimension; ++k) {
      double line = 0;
      for (int i = -half; i <= half; ++i) {
        const double x = i * spacing, t = x / term.width;
        line += std::pow(x, power[k]) * std::pow(-1 / term.width, term.derivative[k]) * hermite(term.derivative[k], t) *
                std::exp(-t * t);
      }
      product *= line * spacing;
    }
    sum += product;
  }
  return sum;
}

struct Named {
  const char* name;
  int cutoff_order;
};
class EveryCutoff : public ::testing::TestWithParam<Named> {};

TEST_P(EveryCutoff, IntegratesToOneAndHasVanishingMoments) {
  const double eps = 0.7;
  for (const int dimension : {1, 2, 3}) {
    const Cutoff cutoff = make_cutoff(GetParam().name, dimension, eps);
    EXPECT_NEAR(moment(cutoff, dimension, eps, {0, 0, 0}), 1,
                1.4e-12);  // trapezoidal rule at half a width: 2 exp(-4 pi^2) a dimension; measured 4.8e-13
    for (int a = 0; a < GetParam().cutoff_order; ++a)
      for (int b = 0; a + b < GetParam().cutoff_order && (dimension > 1 || b == 0); ++b)
        for (int c = 0; a + b + c < GetParam().cutoff_order && (dimension > 2 || c == 0); ++c)
          if (a + b + c > 0) {
            EXPECT_NEAR(moment(cutoff, dimension, eps, {a, b, c}), 0, 1.7e-9)  // the same times the moments: 5.6e-10
                << a << b << c << " in " << dimension << "D";
          }
  }
}

TEST_P(EveryCutoff, HasExactlyItsOrder) {
  // The moment of order k does not vanish: the name promises no more than it keeps.
  const Cutoff cutoff = make_cutoff(GetParam().name, 2, 1.0);
  EXPECT_GT(std::abs(moment(cutoff, 2, 1.0, {GetParam().cutoff_order, 0, 0})), 0.1);
  EXPECT_EQ(find_cutoff(GetParam().name).order, GetParam().cutoff_order);
}

INSTANTIATE_TEST_SUITE_P(, EveryCutoff,
                         ::testing::Values(Named{"gauss2", 2}, Named{"gauss4", 4}, Named{"gauss6", 6},
                                           Named{"gauss8", 8}, Named{"two-gauss", 4}),
                         [](const auto& named) {
                           std::string name = named.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(CutoffTwoGauss, IsThePublishedPairInTwoDimensions) {
  for (const double a : {0.5, 2.0, 3.0}) {
    const Cutoff cutoff = make_cutoff("two-gauss", 2, 1.0, {{"width_ratio", {a}}});
    for (const double r : {0.0, 0.4, 1.0, 2.5}) {
      const double pi = std::numbers::pi, square = a * a;  // [Sch06, 5.2.2]
      const double published =
          square / (pi * (square - 1)) * std::exp(-r * r) + std::exp(-r * r / square) / (pi * square * (1 - square));
      EXPECT_NEAR(value(cutoff, {0, r, 0}), published, 1e-15);
    }
  }
}

TEST(CutoffTwoGauss, HasItsMomentsForEveryRatioAndDimension) {
  for (const double a : {0.7, 1.5})
    for (const int dimension : {1, 2, 3}) {
      const Cutoff cutoff = make_cutoff("two-gauss", dimension, 1.0, {{"width_ratio", {a}}});
      EXPECT_NEAR(moment(cutoff, dimension, 0.7, {0, 0, 0}), 1, 2.6e-15);  // widths from 0.7: rounding of the sum
      EXPECT_NEAR(moment(cutoff, dimension, 0.7, {2, 0, 0}), 0, 2.4e-15);
    }
  EXPECT_THROW(make_cutoff("two-gauss", 2, 1.0, {{"width_ratio", {1.0}}}), std::invalid_argument);
  EXPECT_THROW(make_cutoff("two-gauss", 2, 1.0, {{"width_ratio", {-2.0}}}), std::invalid_argument);
}

TEST_P(EveryCutoff, SpreadIsTheConvolutionWithAGaussian) {
  // Moments of a convolution: the zeroth stays, the second of an axis gains spread/2 (times the integral 1).
  const double eps = 1.0, spread = 0.8;
  for (const int dimension : {1, 2, 3}) {
    const Cutoff before = make_cutoff(GetParam().name, dimension, eps);
    const Cutoff after = spread_cutoff(before, dimension, spread);
    EXPECT_NEAR(moment(after, dimension, 1.3, {0, 0, 0}), 1,
                2.4e-14);  // 1.3: wide enough for the wider Gaussians; measured 8e-15
    const double second = GetParam().cutoff_order == 2 ? 0.5 : 0;
    EXPECT_NEAR(moment(after, dimension, 1.3, {2, 0, 0}), second + spread / 2, 5e-13);  // measured 1.7e-13
  }
}

TEST(CutoffGauss4, IsTheClosedFormInTwoDimensions) {
  const Cutoff cutoff = make_cutoff("gauss4", 2, 1.0);
  for (const double r : {0.0, 0.3, 1.0, 1.7, 3.0})
    EXPECT_NEAR(value(cutoff, {r, 0, 0}), (2 - r * r) * std::exp(-r * r) / std::numbers::pi, 1e-15);
}

TEST(Cutoff, EveryNameCanBeMadeAndOthersCannot) {
  for (const NamedCutoff& cutoff : cutoffs()) EXPECT_FALSE(make_cutoff(cutoff.name, 3, 0.1).empty());
  EXPECT_THROW(make_cutoff("gauss3", 2, 0.1), std::out_of_range);
}

// zeta^ = e^{-q} (1 + q + ... + q^{m-1}/(m-1)!) for order 2m, (a^2 e^{-q} - e^{-a^2 q}) / (a^2 - 1) for the pair of
// widths 1 and a, at q = (k eps)^2 / 4.
TEST(Fourier, IsTheClosedForm) {
  const double eps = 0.4;
  for (const int dimension : {1, 2, 3})
    for (const double q : {0.0, 0.2, 1.0, 7.0}) {
      const double k = 2 * std::sqrt(q) / eps;
      double sum = 0, term = 1;
      int order = 0;
      for (const char* name : {"gauss2", "gauss4", "gauss6", "gauss8"}) {
        sum += term;
        term *= q / ((order += 2) / 2);
        EXPECT_NEAR(fourier(make_cutoff(name, dimension, eps), dimension, k), sum * std::exp(-q), 2e-14) << name << q;
      }
      const double pair = (2.25 * std::exp(-q) - std::exp(-2.25 * q)) / 1.25;
      const Cutoff two = make_cutoff("two-gauss", dimension, eps, {{"width_ratio", {1.5}}});
      EXPECT_NEAR(fourier(two, dimension, k), pair, 2e-14) << q;
      EXPECT_EQ(narrowest_width(two), eps);
    }
  EXPECT_DOUBLE_EQ(narrowest_width(make_cutoff("two-gauss", 2, eps, {{"width_ratio", {0.5}}})), 0.2);
}

TEST(Peak, IsTheLargestValueOfEveryCutoff) {
  for (const NamedCutoff& named : cutoffs())
    for (const int dimension : {2, 3})
      for (const double ratio : {0.5, 2.0}) {
        Arguments arguments;
        for (const NamedParameter& parameter : named.parameters)
          arguments.emplace_back(parameter.name, std::vector{ratio});
        const Cutoff cutoff = make_cutoff(named.name, dimension, 0.3, arguments);
        const double top = peak(cutoff);
        EXPECT_NEAR(value(cutoff, {0, 0, 0}), top, 1e-12 * top) << named.name;
        for (int i = 1; i < 40; ++i)
          EXPECT_LT(std::abs(value(cutoff, {0.03 * i, 0.02 * i, 0})), top) << named.name << " at " << i;
      }
}

TEST(Reach, IsWhereEveryCutoffHasFallenToThatPart) {
  for (const NamedCutoff& named : cutoffs())
    for (const int dimension : {2, 3})
      for (const double part : {1e-3, 1e-14}) {
        const Cutoff cutoff = make_cutoff(named.name, dimension, 0.3);
        const double distance = reach(cutoff, part), allowed = part * peak(cutoff);
        for (int i = 0; i < 50; ++i) {
          const double r = distance * (1 + 0.02 * i);
          EXPECT_LE(std::abs(value(cutoff, {r, 0, 0})), allowed) << named.name;
          EXPECT_LE(std::abs(value(cutoff, {0.6 * r, 0.8 * r, 0})), allowed) << named.name;
        }
        double before = 0;  // the bound is coarse where polynomials are high, and still not much further than needed
        for (int i = 25; i < 50; ++i) before = std::max(before, std::abs(value(cutoff, {0.02 * i * distance, 0, 0})));
        EXPECT_GT(before, allowed) << named.name << " " << part;
      }
}

}  // namespace
}  // namespace gaussdrift
