// Laws that every named velocity field keeps: its stated divergence, its exact flow, finite values where formulas
// divide.
#include "field/named/named_fields.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "time/adaptive.hpp"

namespace gaussdrift {
namespace {

struct Sample {
  std::string name;
  int dimension;
  Arguments given;
};

/// Every named field in each dimension that it has, with parameters that are not its defaults.
std::vector<Sample> samples() {
  std::vector<Sample> list;
  for (const NamedField& field : named_fields())
    for (int d = field.about.least_dimension; d <= field.about.most_dimension; ++d) {
      Arguments given;
      for (const NamedParameter& parameter : field.about.parameters) {
        const std::string name(parameter.name);
        const auto axes = static_cast<std::size_t>(d);
        if (name == "min")
          given.push_back({name, std::vector<double>{-1, -0.5, 0}});
        else if (name == "max")
          given.push_back({name, std::vector<double>{1.5, 1, 2}});
        else if (name == "period")
          given.push_back({name, {3}});
        else if (name == "decay")
          given.push_back({name, {0.3}});
        else if (parameter.kind == NamedParameter::Kind::point)
          given.push_back({name, std::vector<double>{0.3, -0.2, 0.1}});
        else if (parameter.range.contains(-1))
          given.push_back({name, {-0.7}});
        else
          given.push_back({name, {0.9}});
        if (parameter.kind == NamedParameter::Kind::point) given.back().second.resize(axes);
      }
      list.push_back({std::string(field.about.name), d, given});
    }
  return list;
}

constexpr Vector corner{-1, -0.5, 0}, far_corner{1.5, 1, 2};

std::unique_ptr<VelocityField> make(const Sample& sample) {
  return make_named_field(sample.name, {sample.dimension, corner, far_corner}, sample.given);
}

Vector velocity(const VelocityField& field, int dimension, double t, const Vector& x) {
  Vector u{};
  PointsView points{dimension, 1, {}};
  VectorsView values{dimension, 1, {}};
  for (int k = 0; k < dimension; ++k) points.axis[k] = &x[k], values.axis[k] = &u[k];
  field.add(t, points, values);
  return u;
}

double divergence(const VelocityField& field, int dimension, double t, const Vector& x) {
  double value = 0;
  PointsView points{dimension, 1, {}};
  for (int k = 0; k < dimension; ++k) points.axis[k] = &x[k];
  field.add_divergence(t, points, &value);
  return value;
}

std::vector<Vector> places(int dimension, int count) {
  std::mt19937 random(4);
  std::vector<Vector> list;
  for (int i = 0; i < count; ++i) {
    Vector x{};
    for (int k = 0; k < dimension; ++k) x[k] = std::uniform_real_distribution(corner[k], far_corner[k])(random);
    list.push_back(x);
  }
  return list;
}

Vector integrated(const VelocityField& field, int dimension, double from, double to, const Vector& x) {
  std::vector<double> state(x.begin(), x.begin() + dimension);
  time::AdaptiveOptions options;
  options.components.assign(static_cast<std::size_t>(dimension), {1e-14, 1e-14, 0.5});
  options.longest_step = 0.1;
  const auto rate = [&](double t, const double* y, double* k) {
    Vector at{};
    std::copy_n(y, dimension, at.begin());
    const Vector u = velocity(field, dimension, t, at);
    std::copy_n(u.begin(), dimension, k);
  };
  EXPECT_TRUE(time::integrate_adaptively(rate, from, to, 1, options, state.data()).reached);
  Vector y{};
  std::copy_n(state.begin(), dimension, y.begin());
  return y;
}

class EveryNamedField : public ::testing::TestWithParam<Sample> {};

TEST_P(EveryNamedField, HasTheDivergenceThatItStates) {
  const auto field = make(GetParam());
  const int d = GetParam().dimension;
  for (const Vector& x : places(d, 50))
    for (const double t : {0.0, 0.4}) {
      double numerical = 0, size = 1;
      for (int k = 0; k < d; ++k) {  // central differences of order 4
        const double h = 1e-3;
        const auto u = [&](double shift) {
          Vector y = x;
          y[k] += shift;
          return velocity(*field, d, t, y)[k];
        };
        const double slope = (8 * (u(h) - u(-h)) - (u(2 * h) - u(-2 * h))) / (12 * h);
        numerical += slope;
        size += std::abs(slope);
      }
      EXPECT_NEAR(divergence(*field, d, t, x), numerical,
                  2.7e-10 * size);  // h^4 times a fifth derivative of about 1e3: 9e-11
      if (field->is_solenoidal()) {
        EXPECT_EQ(divergence(*field, d, t, x), 0);
      }
    }
}

TEST_P(EveryNamedField, HasTheGradientOfItsVelocity) {
  const auto field = make(GetParam());
  const int d = GetParam().dimension;
  for (const Vector& x : places(d, 20))
    for (const double t : {0.0, 0.4}) {
      std::array<std::array<double, 3>, 3> slopes{};
      PointsView points{d, 1, {}};
      GradientsView view{d, 1, {}};
      for (int k = 0; k < d; ++k) {
        points.axis[k] = &x[k];
        for (int i = 0; i < d; ++i) view.slope[k][i] = &slopes[k][i];
      }
      field->add_gradient(t, points, view);
      double trace = 0;
      for (int i = 0; i < d; ++i) {
        const double h = 1e-3;
        const auto u = [&](double shift) {
          Vector y = x;
          y[i] += shift;
          return velocity(*field, d, t, y);
        };
        const Vector near = u(h), back = u(-h), far = u(2 * h), far_back = u(-2 * h);
        for (int k = 0; k < d; ++k) {
          const double numerical = (8 * (near[k] - back[k]) - (far[k] - far_back[k])) / (12 * h);
          EXPECT_NEAR(slopes[k][i], numerical, 2.7e-10 * (1 + std::abs(numerical))) << k << i;
        }
        trace += slopes[i][i];
      }
      EXPECT_NEAR(trace, divergence(*field, d, t, x), 1e-14 * 20);
    }
}

TEST(GaussianSwirl, HasASlopeWhoseFormsMeet) {
  const auto slope = [](double s) {
    const double h = 1e-3;
    const auto f = [](double at) { return -std::expm1(-at) / at; };
    return (8 * (f(s + h) - f(s - h)) - (f(s + 2 * h) - f(s - 2 * h))) / (12 * h);
  };
  const auto field = make_named_field("lamb_oseen", {2, corner, far_corner}, {{"circulation", {2 * std::numbers::pi}}});
  for (const double s : {0.05, 0.5, 0.999, 1.001, 3.0}) {
    // At (0, r) the slope of u along y is -(omega + 2 r^2 omega'), omega = f(r^2).
    const double x = 0, y = std::sqrt(s);
    double slopes[2][2] = {};
    const PointsView points{2, 1, {&x, &y, nullptr}};
    GradientsView view{2, 1, {}};
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < 2; ++i) view.slope[k][i] = &slopes[k][i];
    field->add_gradient(0, points, view);
    EXPECT_NEAR(slopes[0][1], std::expm1(-s) / s - 2 * s * slope(s), 1e-11) << s;
  }
}

TEST_P(EveryNamedField, FlowsAsAnIntegrationToFullPrecisionSays) {
  const auto field = make(GetParam());
  const int d = GetParam().dimension;
  int known = 0;
  for (const Vector& x : places(d, 6))
    for (const auto& [from, to] :
         {std::pair{0.0, 2.0}, std::pair{1.5, 0.25}, std::pair{0.0, 3.0}, std::pair{0.5, 2.5}}) {
      const auto flown = field->flow(from, to, x);
      if (!flown) continue;
      ++known;
      const Vector y = integrated(*field, d, from, to, x);
      for (int k = 0; k < d; ++k)
        EXPECT_NEAR((*flown)[k], y[k],
                    6e-14 * (1 + std::abs(y[k])));  // errors of a rounding grow with the gradient: 2e-14
      const auto back = field->flow(to, from, *flown);
      ASSERT_TRUE(back);
      for (int k = 0; k < d; ++k)
        EXPECT_NEAR((*back)[k], x[k], 2.4e-15 * (1 + std::abs(y[k])));  // conditioning of the flow: 8e-16
    }
  const bool stated = find_named_field(GetParam().name).exact_flow.substr(0, 9) != "not known";
  EXPECT_EQ(known > 0, stated);
}

TEST_P(EveryNamedField, IsFiniteAtItsCentreItsCornersAndFarAway) {
  const auto field = make(GetParam());
  const int d = GetParam().dimension;
  const Vector center{0.3, -0.2, 0.1};
  for (const double scale : {0.0, 1e-320, 1e-200, 1e-160, 1e-8, 1.0, 1e3, 1e150})
    for (const Vector& direction : {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{1, -1, 1}}) {
      Vector x{};
      for (int k = 0; k < d; ++k) x[k] = center[k] + scale * direction[k];
      const Vector u = velocity(*field, d, 0.1, x);
      for (int k = 0; k < d; ++k) EXPECT_TRUE(std::isfinite(u[k])) << scale;
      if (scale > 1e3) continue;
      if (const auto y = field->flow(0, 1, x)) {
        for (int k = 0; k < d; ++k) EXPECT_TRUE(std::isfinite((*y)[k])) << scale;
      }
    }
  for (const Vector& x : {corner, far_corner}) {
    const Vector u = velocity(*field, d, 0, x);
    for (int k = 0; k < d; ++k) EXPECT_TRUE(std::isfinite(u[k]));
  }
}

TEST_P(EveryNamedField, IsAsSteadyAsItSays) {
  const auto field = make(GetParam());
  const int d = GetParam().dimension;
  bool changes = false;
  for (const Vector& x : places(d, 5)) changes = changes || velocity(*field, d, 0, x) != velocity(*field, d, 0.7, x);
  EXPECT_EQ(field->is_steady(), !changes);
}

TEST_P(EveryNamedField, AddsToWhatIsThere) {
  const auto field = make(GetParam());
  const int d = GetParam().dimension;
  const Vector x = places(d, 1)[0], u = velocity(*field, d, 0.2, x);
  Vector sum{10, 20, 30};
  PointsView points{d, 1, {}};
  VectorsView values{d, 1, {}};
  for (int k = 0; k < d; ++k) points.axis[k] = &x[k], values.axis[k] = &sum[k];
  field->add(0.2, points, values);
  for (int k = 0; k < d; ++k) EXPECT_NEAR(sum[k], 10 * (k + 1) + u[k], 1.5e-14);  // one rounding of numbers below 100
}

TEST_P(EveryNamedField, DescribesItselfAndItsParameters) {
  const NamedField& facts = find_named_field(GetParam().name);
  for (const auto text : {facts.about.meaning, facts.about.formula, facts.divergence, facts.exact_flow})
    EXPECT_FALSE(text.empty());
  const std::string text = make(GetParam())->describe();
  for (const NamedParameter& parameter : facts.about.parameters) {
    EXPECT_FALSE(parameter.meaning.empty());
    EXPECT_NE(text.find(std::string(parameter.name) + " = "), std::string::npos) << text;
  }
}

INSTANTIATE_TEST_SUITE_P(, EveryNamedField, ::testing::ValuesIn(samples()), [](const auto& tested) {
  return tested.param.name + "_" + std::to_string(tested.param.dimension) + "d";
});

TEST(NamedField, TaylorGreenComesBackAfterFourKAndKeepsToItsWalls) {
  const auto field = make_named_field("taylor_green", {2, {}, {}});
  const Vector x{1.0, 0.4, 0};
  const double psi = std::sin(x[0]) * std::sin(x[1]), turn = 4 * std::comp_ellint_1(std::sqrt(1 - psi * psi));
  const Vector y = *field->flow(0, turn, x);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(y[k], x[k], 1e-14);          // a few roundings
  for (const double wall : {1e-3, 1e-8, 1e-12, 1e-18, 1e-200, 0.0}) {  // close to a wall the turn takes ever longer
    const Vector z = *field->flow(0, 5, {wall, 2.0, 0});
    EXPECT_NEAR(std::sin(z[0]) * std::sin(z[1]), std::sin(wall) * std::sin(2.0), 3.3e-16 * wall + 1e-30) << wall;
    const Vector exact = integrated(*field, 2, 0, 5, {wall, 2.0, 0});
    for (int k = 0; k < 2; ++k)
      EXPECT_NEAR(z[k], exact[k], 1.2e-14) << wall;  // less than a rounding times e^5 = 148: 4.3e-15
  }
  const Vector middle = *field->flow(0, 5, {std::numbers::pi / 2, std::numbers::pi / 2, 0});
  EXPECT_NEAR(middle[0], std::numbers::pi / 2, 1e-15);
}

TEST(NamedField, BurgersKeepsItsAngleNearTheAxis) {
  const auto field = make_named_field("burgers", {3, {}, {}}, {{"viscosity", {0.1}}});
  for (const double r : {1e-170, 1e-150, 1e-5, 3.0, 100.0}) {
    const Vector x = *field->flow(0, 0.7, {r, 0, 1});
    const Vector exact = integrated(*field, 3, 0, 0.7, {r, 0, 1});
    EXPECT_NEAR(std::atan2(x[1], x[0]), std::atan2(exact[1], exact[0]), 5.4e-14)
        << r;  // of log(s) ~ 700, which has a rounding of 1.1e-13: 1.8e-14
  }
}

TEST(NamedField, DoswellsWindIsStrongestWhereItShouldBe) {
  const auto field = make_named_field("doswell", {2, {}, {}}, {{"radius", {2}}, {"speed", {3}}});
  const double r = 2 * std::atanh(1 / std::numbers::sqrt3);
  EXPECT_NEAR(velocity(*field, 2, 0, {r, 0, 0})[1], 3, 1.3e-15);  // a few roundings
  for (const double other : {0.99 * r, 1.01 * r}) EXPECT_LT(velocity(*field, 2, 0, {other, 0, 0})[1], 3);
}

TEST(NamedField, RefusesArgumentsThatItDoesNotKnow) {
  const Box box{2, {}, {1, 1, 0}};
  EXPECT_THROW(make_named_field("rotaton", box), std::out_of_range);
  EXPECT_THROW(make_named_field("rotation", box, {{"speed", {1}}}), std::invalid_argument);
  EXPECT_THROW(make_named_field("rotation", box, {{"center", {1}}}), std::invalid_argument);
  EXPECT_THROW(make_named_field("translation", box), std::invalid_argument);
}

}  // namespace
}  // namespace gaussdrift
