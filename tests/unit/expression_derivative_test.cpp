// Forward derivatives of expressions, against analytic ones and against differences, and the velocities made of them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "expression/expression.hpp"
#include "field/velocity/expression_field.hpp"
#include "field/velocity/streamfunction_field.hpp"

namespace gaussdrift {
namespace {

/// d/dx and d/dy at one point.
std::pair<double, double> slopes(const std::string& text, double x, double y) {
  const Expression expression(text, {"x", "y"}, {{"a", 1.7}});
  const double* arguments[] = {&x, &y};
  double dx = 0, dy = 0, value = 0;
  double* const out[] = {&dx, &dy};
  expression.differentiate(arguments, 1, {0, 1}, &value, out);
  const double plain = expression.evaluate({x, y});
  EXPECT_TRUE(value == plain || (std::isnan(value) && std::isnan(plain))) << text;
  return {dx, dy};
}

TEST(Derivative, EqualsTheAnalyticOne) {
  const double x = 0.6, y = 0.3;
  const struct {
    const char* text;
    double dx, dy;
  } known[] = {
      {"x", 1, 0},
      {"3", 0, 0},
      {"-x + 2*y", -1, 2},
      {"x*y - y", y, x - 1},
      {"x/y", 1 / y, -x / (y * y)},
      {"x^2*y^3", 2 * x * y * y * y, 3 * x * x * y * y},
      {"x^4", 4 * x * x * x, 0},
      {"x^a", 1.7 * std::pow(x, 0.7), 0},
      {"a^y", 0, std::pow(1.7, y) * std::log(1.7)},
      {"x^y", y * std::pow(x, y - 1), std::pow(x, y) * std::log(x)},
      {"sin(x*y)", y * std::cos(x * y), x * std::cos(x * y)},
      {"exp(-x^2-y^2)", -2 * x * std::exp(-x * x - y * y), -2 * y * std::exp(-x * x - y * y)},
      {"x > 0.5 ? x^2 : y", 2 * x, 0},
      {"x < 0.5 ? x^2 : y", 0, 1},
      {"min(x, y) + max(2*x, y)", 2, 1},  // x = 0.6 is above y = 0.3
      {"(x > y) + floor(x) + (x && y)", 0, 0},
      {"hypot(x, y)", x / std::hypot(x, y), y / std::hypot(x, y)},
      {"mod(x, y) ", 1, -2},
  };
  for (const auto& one : known) {
    const auto [dx, dy] = slopes(one.text, x, y);
    EXPECT_NEAR(dx, one.dx, 1e-15) << one.text;  // a few roundings
    EXPECT_NEAR(dy, one.dy, 1e-15) << one.text;
  }
}

TEST(Derivative, OfEveryFunctionAgreesWithDifferences) {
  for (const FunctionInfo& function : expression_functions()) {
    const std::string name(function.name);
    const std::string shift = name == "acosh" ? "1.5 + " : "";  // its domain
    const std::string text =
        function.arguments == 1 ? name + "(" + shift + "x*x + 0.3*y)" : name + "(" + shift + "x*x + 0.3*y, 0.7*y + x)";
    const Expression expression(text, {"x", "y"}, {});
    for (const auto& [x, y] : {std::pair{0.31, 0.42}, std::pair{0.57, 0.11}, std::pair{0.7, 0.9}}) {
      const auto [dx, dy] = slopes(text, x, y);
      const double h = 1e-4;
      const auto difference = [&, x0 = x, y0 = y](double hx, double hy) {  // of order 4
        const auto f = [&](double k) { return expression.evaluate({x0 + k * hx, y0 + k * hy}); };
        return (8 * (f(1) - f(-1)) - (f(2) - f(-2))) / (12 * h);
      };
      EXPECT_NEAR(dx, difference(h, 0), 4e-12 * (1 + std::abs(dx))) << text;  // rounding / h, and h^4: 1.5e-12
      EXPECT_NEAR(dy, difference(0, h), 4e-12 * (1 + std::abs(dy))) << text;
    }
  }
}

TEST(Derivative, TakesWhatTheRoughSpotsSay) {
  EXPECT_EQ(slopes("abs(x)", 0, 1).first, 0);
  EXPECT_EQ(slopes("hypot(x, y)", 0, 0), std::pair(0.0, 0.0));
  EXPECT_EQ(slopes("sqrt(x^2 + y^2)", 0, 0), std::pair(0.0, 0.0));
  EXPECT_EQ(slopes("min(x, y)", 1, 1), std::pair(1.0, 0.0));
  EXPECT_EQ(slopes("floor(3*x)", 1, 1).first, 0);
  const auto spots = [](const char* text) { return Expression(text, {"x", "y"}, {}).rough_spots(); };
  EXPECT_TRUE(spots("sin(x)*exp(y)^2/x").empty());
  ASSERT_EQ(spots("abs(x) + abs(y)").size(), 1u);
  EXPECT_EQ(spots("abs(x)")[0].taken, "abs has a corner at 0, where slope 0 is taken");
  EXPECT_EQ(spots("x > 0 ? 1 : 2").size(), 2u);
}

TEST(Derivative, IsTheSameForEveryLengthOfARow) {
  const Expression expression("sin(x*y)*cos(t) + (x > 0.5 ? x^2 : y*t) + cos(3)", {"x", "y", "t"}, {});
  std::mt19937 random(1);
  std::vector<double> x(1000), y(1000), t(1000, 0.3), dx(1000), dy(1000), values(1000);
  for (auto* column : {&x, &y})
    for (double& value : *column) value = std::uniform_real_distribution(0.0, 1.0)(random);
  const double* arguments[] = {x.data(), y.data(), t.data()};
  double* const out[] = {dx.data(), dy.data()};
  expression.differentiate(arguments, 1000, {0, 1}, values.data(), out);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double* one[] = {&x[i], &y[i], &t[i]};
    double ox = 0, oy = 0, value = 0;
    double* const single[] = {&ox, &oy};
    expression.differentiate(one, 1, {0, 1}, &value, single);
    ASSERT_EQ(ox, dx[i]);
    ASSERT_EQ(oy, dy[i]);
    ASSERT_EQ(value, values[i]);
  }
}

TEST(ExpressionField, HasTheDivergenceOfItsFormula) {
  const ExpressionField field({"x^2*y + sin(t)", "exp(y*t)", "x*y*z^3"}, {});
  const double x = 0.3, y = -0.4, z = 1.2, t = 0.7;
  const PointsView at{3, 1, {&x, &y, &z}};
  double value = 1;
  field.add_divergence(t, at, &value);
  EXPECT_NEAR(value, 1 + 2 * x * y + t * std::exp(y * t) + 3 * x * y * z * z, 1e-15);  // a few roundings
  EXPECT_FALSE(field.is_steady());
  EXPECT_TRUE(ExpressionField({"x", "y"}, {}).is_steady());
}

/// slopes[k][i] = d u_k / d x_i at a point of the plane.
std::array<std::array<double, 2>, 2> gradient(const VelocityField& field, double t, double x, double y) {
  std::array<std::array<double, 2>, 2> slopes{};
  GradientsView view{2, 1, {}};
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < 2; ++i) view.slope[k][i] = &slopes[k][i];
  field.add_gradient(t, {2, 1, {&x, &y, nullptr}}, view);
  return slopes;
}

TEST(ExpressionField, HasTheGradientOfItsFormula) {
  const ExpressionField field({"x^2*y + sin(t)", "exp(y*t)*x"}, {});
  const double x = 0.3, y = -0.4, t = 0.7;
  const auto slopes = gradient(field, t, x, y);
  EXPECT_NEAR(slopes[0][0], 2 * x * y, 1e-15);
  EXPECT_NEAR(slopes[0][1], x * x, 1e-15);
  EXPECT_NEAR(slopes[1][0], std::exp(y * t), 1e-15);
  EXPECT_NEAR(slopes[1][1], t * x * std::exp(y * t), 1e-15);
}

TEST(StreamfunctionField, HasTheGradientOfTheSameFlowByHand) {
  const StreamfunctionField field("sin(pi*x)^2*sin(pi*y)^2/pi*cos(pi*t/8)", {}, 1);
  const ExpressionField hand({"sin(pi*x)^2*sin(2*pi*y)*cos(pi*t/8)", "-sin(pi*y)^2*sin(2*pi*x)*cos(pi*t/8)"}, {});
  for (const double x : {0.0, 0.1, 0.45, 0.9})
    for (const double y : {0.05, 0.5, 0.77}) {
      const auto slopes = gradient(field, 1.3, x, y), expected = gradient(hand, 1.3, x, y);
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t i = 0; i < 2; ++i)
          EXPECT_NEAR(slopes[k][i], expected[k][i], 3e-12);  // 1024 times the rounding of slopes, some ten times
      EXPECT_NEAR(slopes[0][0] + slopes[1][1], 0, 1e-15);
    }
}

TEST(StreamfunctionField, IsTheTurnedGradient) {
  // psi of the vortex in a box, against the velocity written by hand.
  const StreamfunctionField field("sin(pi*x)^2*sin(pi*y)^2/pi*cos(pi*t/8)", {});
  const ExpressionField hand({"sin(pi*x)^2*sin(2*pi*y)*cos(pi*t/8)", "-sin(pi*y)^2*sin(2*pi*x)*cos(pi*t/8)"}, {});
  for (const double x : {0.0, 0.1, 0.45, 0.9})
    for (const double y : {0.05, 0.5, 0.77}) {
      const PointsView at{2, 1, {&x, &y, nullptr}};
      double u[2] = {0, 0}, v[2] = {0, 0}, divergence = 0;
      field.add(1.3, at, {2, 1, {&u[0], &u[1], nullptr}});
      hand.add(1.3, at, {2, 1, {&v[0], &v[1], nullptr}});
      EXPECT_NEAR(u[0], v[0], 1e-15);  // a few roundings
      EXPECT_NEAR(u[1], v[1], 1e-15);
      hand.add_divergence(1.3, at, &divergence);
      EXPECT_NEAR(divergence, 0, 1e-15);
    }
  EXPECT_TRUE(field.is_solenoidal());
  EXPECT_FALSE(field.is_steady());
}

}  // namespace
}  // namespace gaussdrift
