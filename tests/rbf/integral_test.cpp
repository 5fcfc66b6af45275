// Integrals of kernels and interpolants over boxes, against closed forms and quadrature that knows nothing of Gaussians.
#include "rbf/integral.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rbf/naive.hpp"

namespace {

using Index = Eigen::Index;

template <int d>
using Vector = Eigen::Matrix<double, d, 1>;

using naive::cube;

/// The integral of phi from 0 to x >= 0 on the line.
long double closed_form(const rbf::Function& function, long double x) {
  const long double c = function.shape;
  switch (function.kernel) {
    case rbf::Kernel::gaussian:
      return c * std::sqrt(std::acos(-1.0L)) / 2 * std::erf(x / c);
    case rbf::Kernel::multiquadric:
      return (x * std::sqrt(x * x + c * c) + c * c * std::asinh(x / c)) / 2;
    case rbf::Kernel::inverse_multiquadric:
      return std::asinh(x / c);
    case rbf::Kernel::inverse_quadratic:
      return std::atan(x / c) / c;
    case rbf::Kernel::thin_plate:
      return x > 0 ? x * x * x * (std::log(x) / 3 - 1.0L / 9) : 0;
    case rbf::Kernel::matern32: {
      const long double k = std::sqrt(3.0L) / c, a = k * x;
      return (2 - (2 + a) * std::exp(-a)) / k;
    }
    case rbf::Kernel::matern52: {
      const long double k = std::sqrt(5.0L) / c, a = k * x;
      return (8.0L / 3 - (8.0L / 3 + 5 * a / 3 + a * a / 3) * std::exp(-a)) / k;
    }
  }
  return 0;
}

long double between(const rbf::Function& function, long double p, long double q) {
  const auto odd = [&](long double x) { return x < 0 ? -closed_form(function, -x) : closed_form(function, x); };
  return odd(q) - odd(p);
}

class EveryIntegral : public testing::TestWithParam<rbf::Kernel> {};

TEST_P(EveryIntegral, OnTheLineIsTheClosedForm) {
  const rbf::Function function{GetParam(), rbf::takes_shape(GetParam()) ? 0.1 : 0};
  const rbf::Points<1> points = cube<1>(12, 1);
  const Eigen::MatrixXd values = naive::numbers(12, 2, 2);
  const rbf::Interpolant<1> fit(function, points, values);
  for (const auto& [low, high] :
       std::vector<std::pair<double, double>>{{0.0, 1.0}, {-0.5, 0.3}, {0.41, 0.43}, {2.0, 2.5}, {0.7, 0.7}}) {
    const rbf::Integral found = rbf::integral<1>(fit, Vector<1>(low), Vector<1>(high));
    const double middle = (points.minCoeff() + points.maxCoeff()) / 2,
                 unit = (points.maxCoeff() - points.minCoeff()) / 2;
    for (Index k = 0; k < 2; ++k) {
      long double exact = 0, terms = 0;
      for (Index j = 0; j < 12; ++j) {
        const long double term = fit.weights()(j, k) * between(function, low - points(0, j), high - points(0, j));
        exact += term;
        terms += std::abs(term);
      }
      if (fit.polynomial().rows() > 0) exact += fit.polynomial()(0, k) * (high - low);
      if (fit.polynomial().rows() > 1)
        exact += fit.polynomial()(1, k) * (high - low) * ((low + high) / 2 - middle) / unit;
      EXPECT_LE(std::abs(static_cast<double>(found.values[k] - exact)),
                found.errors[k] + 1e-14 * static_cast<double>(terms + std::abs(exact)) + 1e-15)
          << low << " to " << high;
      EXPECT_LE(found.errors[k], 1e-8 * (high - low) * fit.weights().col(k).cwiseAbs().sum());
    }
  }
}

/// The integral of phi(|y - x|) over the box, along lines: outward from the centre by the trapezoidal rule in a variable
/// that makes everything smooth at the ends (tanh-sinh), in each dimension and on both sides of the centre.
template <int d>
long double by_quadrature(const rbf::Function& function, const Vector<d>& x, const Vector<d>& low,
                          const Vector<d>& high) {
  std::vector<std::pair<long double, long double>> rule[3];  // distance along an axis, and weight
  for (int l = 0; l < d; ++l) {
    const double ends[] = {low[l] - x[l], std::clamp(0.0, low[l] - x[l], high[l] - x[l]), high[l] - x[l]};
    for (int side = 0; side < 2; ++side) {
      const long double middle = (static_cast<long double>(ends[side]) + ends[side + 1]) / 2,
                        half = (static_cast<long double>(ends[side + 1]) - ends[side]) / 2;
      constexpr long double step = 0.12L;
      for (int i = -30; i <= 30; ++i) {
        const long double u = std::acos(-1.0L) / 2 * std::sinh(i * step), cosine = std::cosh(u);
        rule[l].emplace_back(middle + half * std::tanh(u),
                             half * step * std::acos(-1.0L) / 2 * std::cosh(i * step) / (cosine * cosine));
      }
    }
  }
  long double sum = 0;
  for (const auto& [a, wa] : rule[0])
    if constexpr (d == 2) {
      for (const auto& [b, wb] : rule[1]) sum += wa * wb * naive::phi(function, std::sqrt(a * a + b * b));
    } else {
      for (const auto& [b, wb] : rule[1])
        for (const auto& [c, wc] : rule[2])
          sum += wa * wb * wc * naive::phi(function, std::sqrt(a * a + b * b + c * c));
    }
  return sum;
}

template <int d>
void equals_quadrature(rbf::Kernel kernel) {
  const rbf::Function function{kernel, rbf::takes_shape(kernel) ? 0.4 : 0};
  const rbf::Points<d> points = cube<d>(d == 2 ? 8 : 5, 3);
  const Eigen::VectorXd values = naive::numbers(points.cols(), 1, 4);
  const rbf::Interpolant<d> fit(function, points, values);
  Vector<d> low = Vector<d>::Constant(-0.1), high = Vector<d>::Constant(0.8);
  high[d - 1] = 1.3;
  long double exact = 0;
  for (Index j = 0; j < points.cols(); ++j)
    exact += fit.weights()(j, 0) * by_quadrature<d>(function, points.col(j), low, high);
  const rbf::Points<d> middle = (low + high) / 2;
  const Eigen::MatrixXd at_middle = fit.evaluate(middle);
  // The polynomial is what the sum of kernels leaves of s in the middle.
  long double polynomial = at_middle(0, 0);
  for (Index j = 0; j < points.cols(); ++j)
    polynomial -= fit.weights()(j, 0) * naive::phi(function, (middle - points.col(j)).norm());
  exact += polynomial * (high - low).prod();
  const rbf::Integral found = rbf::integral<d>(fit, low, high);
  const double scale = fit.weights().cwiseAbs().sum() * (high - low).prod();
  // 1e-9: the quadrature, at centres where kernels are not smooth; and of evaluation, 1e-7
  EXPECT_LE(std::abs(static_cast<double>(found.values[0] - exact)), found.errors[0] + 1e-9 * scale + 2e-7);
  EXPECT_LE(found.errors[0], 1e-8 * scale);
}

TEST_P(EveryIntegral, InSpaceEqualsQuadrature) {
  equals_quadrature<2>(GetParam());
  equals_quadrature<3>(GetParam());
}

TEST_P(EveryIntegral, IsASumOfTheValuesWithWeights) {
  const rbf::Function function{GetParam(), rbf::takes_shape(GetParam()) ? 0.15 : 0};
  const rbf::Points<2> nodes = cube<2>(90, 5);
  const Eigen::MatrixXd values = naive::numbers(90, 3, 6);
  const Vector<2> low(0.1, -0.2), high(0.9, 0.7);
  for (const double regularisation : {0.0, 0.01}) {
    const rbf::FitOptions options{.accuracy = 1e-10, .regularisation = regularisation};
    const Eigen::VectorXd weights = rbf::quadrature_weights<2>(function, nodes, low, high, options);
    const rbf::Interpolant<2> fit(function, nodes, values, options);
    const Eigen::VectorXd integral = rbf::integral<2>(fit, low, high).values;
    EXPECT_LE((values.transpose() * weights - integral).cwiseAbs().maxCoeff(),
              1e-7 * (1 + integral.cwiseAbs().maxCoeff()));
    if (rbf::positive_order(GetParam()) > 0) {
      EXPECT_NEAR(weights.sum(), 0.8 * 0.9, 1e-12);
    }
    if (rbf::positive_order(GetParam()) > 1) {
      EXPECT_NEAR(weights.dot(nodes.row(0)), 0.8 * 0.9 * 0.5, 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Rbf, EveryIntegral, testing::ValuesIn(rbf::kernels()), [](const auto& of) {
  return naive::name({of.param, 0});
});

TEST(RbfIntegral, ApproachesThatOfTheFunction) {
  const auto error = [](Index count) {
    const rbf::Points<2> nodes = cube<2>(count, 7);
    const Eigen::VectorXd weights =
        rbf::quadrature_weights<2>({rbf::Kernel::thin_plate}, nodes, Vector<2>::Zero(), Vector<2>::Ones());
    double sum = 0;
    for (Index i = 0; i < count; ++i) sum += weights[i] * std::sin(3 * nodes(0, i)) * std::exp(nodes(1, i));
    return std::abs(sum - (1 - std::cos(3.0)) / 3 * (std::exp(1.0) - 1));
  };
  EXPECT_LE(error(1700), 2e-4);  // by iteration; 1700 random nodes without weights have about 1e-2
  EXPECT_LE(error(1700), error(60) / 25);
}

TEST(RbfIntegral, RefusesBoxesThatAreNone) {
  const rbf::Points<2> points = cube<2>(20, 8);
  const rbf::Interpolant<2> fit({rbf::Kernel::thin_plate}, points, Eigen::VectorXd::Ones(20));
  EXPECT_THROW(rbf::integral<2>(fit, Vector<2>(0, 1), Vector<2>(1, 0)), rbf::InvalidArgument);
  EXPECT_THROW(rbf::integral<2>(fit, Vector<2>(0, 0), Vector<2>(1, INFINITY)), rbf::InvalidArgument);
  EXPECT_THROW(rbf::quadrature_weights<2>({rbf::Kernel::gaussian}, points, Vector<2>::Zero(), Vector<2>::Ones()),
               rbf::InvalidArgument);
}

}  // namespace
