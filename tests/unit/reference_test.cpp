// The exact density by characteristics, against closed forms.
#include "reference/characteristics.hpp"
#include "reference/formula.hpp"
#include "reference/norms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>

#include "field/density/radial_density.hpp"
#include "field/density/written_density.hpp"
#include "field/velocity/expression_field.hpp"

namespace gaussdrift {
namespace {

using std::numbers::pi;

Lattice lattice(int per_axis, int dimension = 2, double half = 1) {
  return make_lattice(dimension, {-half, -half, -half}, {half, half, half}, per_axis);
}

/// rho at the lattice points from a formula.
template <class Formula>
std::vector<double> sampled(const Lattice& at, const Formula& rho) {
  std::vector<double> values;
  for (std::size_t k = 0; k < at.points[2]; ++k)
    for (std::size_t j = 0; j < at.points[1]; ++j)
      for (std::size_t i = 0; i < at.points[0]; ++i)
        values.push_back(rho(at.coordinate(0, i), at.coordinate(1, j), at.dimension == 3 ? at.coordinate(2, k) : 0));
  return values;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

WrittenDensity written(const std::string& text, int dimension = 2) { return {text, dimension, {}}; }

const std::string hill = "exp(-8*((x-0.3)^2+y^2))";
double hill_at(double x, double y) { return std::exp(-8 * ((x - 0.3) * (x - 0.3) + y * y)); }

TEST(Characteristics, TurnTheDensityBackInASteadyRotation) {
  const ExpressionField rotation({"-y", "x"}, {});
  const auto density = written(hill);
  const Lattice grid = lattice(23);
  for (const bool steady : {true, false}) {
    const auto reference = characteristics(rotation, density, {}, grid, {.steady = steady, .end = 40});
    std::vector<double> rho;
    for (const double t : {0., 1.3, 1.4, 2 * pi, 40.}) {
      const ReferenceReport report = reference->evaluate(t, rho);
      EXPECT_EQ(report.untraced, 0u);
      const auto exact = sampled(grid, [&](double x, double y, double) {
        return hill_at(x * std::cos(t) + y * std::sin(t), -x * std::sin(t) + y * std::cos(t));
      });
      // Steps of at most 1e-12 of the side 2, about 5 a time unit, the estimate being 30 times the error
      EXPECT_LT(largest_difference(rho, exact), 1e-13 * (1 + 2 * t)) << t << (steady ? " steady" : "");
    }
  }
}

TEST(Characteristics, ComeBackInTheReversedSwirl) {
  const ExpressionField swirl({"sin(pi*x)^2*sin(2*pi*y)*cos(pi*t/8)", "-sin(pi*y)^2*sin(2*pi*x)*cos(pi*t/8)"}, {});
  const auto density = written("exp(-30*((x-0.5)^2+(y-0.75)^2))");
  const Lattice grid = make_lattice(2, {}, {1, 1, 0}, 21);
  std::vector<double> start, back, half;
  const auto reference = characteristics(swirl, density, {}, grid, {.end = 8});
  reference->evaluate(0, start);
  reference->evaluate(4, half);
  reference->evaluate(8, back);
  EXPECT_GT(largest_difference(start, half), 0.5);
  EXPECT_LT(largest_difference(start, back), 7e-12);  // 1e-12 a step, stretched on the way and back: 2.4e-12
}

TEST(Characteristics, ThinAndThickenWhereTheFlowDiverges) {
  // u = x: X(0) = x e^-t, div u = d.
  for (const int dimension : {2, 3}) {
    const ExpressionField outwards(
        dimension == 2 ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"}, {});
    const auto density = written(dimension == 2 ? "exp(-8*(x^2+y^2))" : "exp(-8*(x^2+y^2+z^2))", dimension);
    const Lattice grid = lattice(9, dimension);
    const ScalarRate divergence = [&](double, const PointsView& x, double* values) {
      for (std::size_t i = 0; i < x.count; ++i) values[i] += dimension;
    };
    for (const bool steady : {true, false}) {
      const auto reference = characteristics(outwards, density, divergence, grid, {.steady = steady, .end = 2});
      std::vector<double> rho;
      for (const double t : {0.7, 2.}) {
        reference->evaluate(t, rho);
        const auto exact = sampled(grid, [&](double x, double y, double z) {
          return std::exp(-8 * (x * x + y * y + z * z) * std::exp(-2 * t)) * std::exp(-dimension * t);
        });
        EXPECT_LT(largest_difference(rho, exact), 1.6e-14) << dimension << "D, t = " << t;
      }
    }
  }
}

TEST(Characteristics, FollowAGrowthThatDependsOnPlaceAndTime) {
  // u = (1, 0), g = x t:  int_0^t (x - (t - s)) s ds = x t^2/2 - t^3/6.
  const ExpressionField wind({"1", "0"}, {});
  const auto density = written(hill);
  const Lattice grid = lattice(15);
  const ScalarRate growth = [](double t, const PointsView& x, double* values) {
    for (std::size_t i = 0; i < x.count; ++i) values[i] += x.axis[0][i] * t;
  };
  const auto reference = characteristics(wind, density, growth, grid, {.end = 1.5});
  std::vector<double> rho;
  reference->evaluate(1.5, rho);
  const double t = 1.5;
  const auto exact = sampled(
      grid, [&](double x, double y, double) { return hill_at(x - t, y) * std::exp(-(x * t * t / 2 - t * t * t / 6)); });
  EXPECT_LT(largest_difference(rho, exact), 2.2e-16);  // exp of a polynomial along a straight way: rounding alone
}

// Backwards u = -k (x - 1/2) flees from the domain like e^kt. Steps of a quarter of the domain would be 10^40; half of
// the way back is a few hundred.
TEST(Characteristics, FleeFromTheDomainInFewSteps) {
  const ExpressionField sink({"-1000*(x-0.5)", "0"}, {});
  const auto density = written("exp(-8*((x-0.5)^2+y^2))");
  const Lattice grid = make_lattice(2, {}, {1, 1, 0}, 8);
  const ScalarRate divergence = [](double, const PointsView& x, double* values) {
    for (std::size_t i = 0; i < x.count; ++i) values[i] -= 1000;
  };
  const auto reference = characteristics(sink, density, divergence, grid, {.steady = true, .end = 0.2});
  std::vector<double> rho;
  const ReferenceReport report = reference->evaluate(0.2, rho);
  EXPECT_EQ(report.untraced, 0u);
  EXPECT_LT(report.rates, 64u * 12 * 2000);
  for (const double value : rho) EXPECT_EQ(value, 0);
  // Near the middle there is something still, e^3 times as much on an interval e^3 times as narrow.
  const Lattice near = make_lattice(2, {0.49, 0, 0}, {0.51, 0.02, 0}, 9);
  characteristics(sink, density, divergence, near, {.steady = true, .end = 0.003})->evaluate(0.003, rho);
  EXPECT_LT(largest_difference(rho, sampled(near,
                                            [](double x, double y, double) {
                                              const double from = (x - 0.5) * std::exp(3.0);
                                              return std::exp(3.0 - 8 * (from * from + y * y));
                                            })),
            1e-8);
}

// By fixed steps, as through kinks where exact paths are too dear: of the order of the method.
TEST(Characteristics, FollowPathsByFixedStepsToo) {
  const ExpressionField rotation({"-y", "x"}, {});
  const auto density = written(hill);
  const Lattice grid = lattice(15);
  const ScalarRate decay = [](double, const PointsView& x, double* values) {
    for (std::size_t i = 0; i < x.count; ++i) values[i] += 0.5;
  };
  std::vector<double> exact, rho;
  characteristics(rotation, density, decay, grid, {.steady = true, .end = 2})->evaluate(2, exact);
  std::vector<double> errors;
  for (const double step : {0.2, 0.1}) {
    const auto reference =
        characteristics(rotation, density, decay, grid,
                        {.steady = true, .end = 2, .steps_by = &time::find_tableau("rk4"), .step = step});
    const ReferenceReport first = reference->evaluate(1, rho), second = reference->evaluate(2, rho);
    EXPECT_EQ(first.rates + second.rates, grid.size() * 4 * static_cast<std::size_t>(std::lround(2 / step)));
    EXPECT_EQ(second.untraced, 0u);
    errors.push_back(largest_difference(rho, exact));
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4, 0.3);
  // Points do not see each other: what leaves the known is lost alone.
  const ExpressionField half({"x < 0 ? sqrt(-1-x^2) : 1", "0"}, {});
  const auto lost =
      characteristics(half, density, {}, grid, {.end = 0.5, .steps_by = &time::find_tableau("rk4"), .step = 0.01});
  const ReferenceReport report = lost->evaluate(0.5, rho);
  std::size_t expected = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const bool gone = grid.coordinate(0, i % grid.points[0]) < 0.5;
    expected += gone;
    EXPECT_EQ(std::isnan(rho[i]), gone) << i;
  }
  EXPECT_EQ(report.untraced, expected);
  EXPECT_FALSE(report.trouble.empty());
}

TEST(Characteristics, HoldAVastGrowthWithoutOverflowWhereThereIsNothing) {
  const ExpressionField rest({"0", "0"}, {});
  const RadialDensity disk(RadialDensity::Profile::disk, 2, {}, 0.5, 1);
  const ScalarRate growth = [](double, const PointsView& x, double* values) {
    for (std::size_t i = 0; i < x.count; ++i) values[i] -= 1e3;
  };
  const Lattice grid = lattice(5);
  const auto reference = characteristics(rest, disk, growth, grid, {.steady = true, .end = 1});
  std::vector<double> rho;
  reference->evaluate(0.5, rho);
  EXPECT_NEAR(rho[12] / std::exp(500.0), 1, 1e-9);  // 1e-12 of the exponent 500
  EXPECT_EQ(rho[0], 0);
  reference->evaluate(1, rho);  // e^1000 is more than a double holds
  EXPECT_EQ(rho[0], 0) << "0 times infinity";
}

TEST(Characteristics, CountThePointsThatHaveNoPast) {
  // u = 1/x: x^2 = x_0^2 + 2 t. What is within sqrt(2 t) of the line x = 0 came out of it later than 0.
  const ExpressionField source({"1/x", "0"}, {});
  const auto density = written("1 + 0*x");
  const Lattice grid = make_lattice(2, {-1, -0.1, 0}, {1, 0.1, 0}, 41);
  const double t = 0.1;
  for (const bool steady : {true, false}) {
    const auto reference = characteristics(source, density, {}, grid, {.steady = steady, .end = 1});
    std::vector<double> rho;
    for (int twice = 0; twice < 2; ++twice) {
      const ReferenceReport report = reference->evaluate(twice == 0 ? t : 2 * t, rho);
      std::size_t expected = 0;
      for (std::size_t i = 0; i < grid.size(); ++i) {
        const double x = grid.coordinate(0, i % grid.points[0]);
        const bool lost = x * x < 2 * (twice == 0 ? t : 2 * t);
        expected += lost;
        EXPECT_EQ(std::isnan(rho[i]), lost) << x;
      }
      EXPECT_EQ(report.untraced, expected);
      EXPECT_FALSE(report.trouble.empty());
      EXPECT_LT(std::abs(report.first_untraced[0]), std::sqrt(0.4));
    }
  }
}

class CountingField : public VelocityField {
 public:
  void add(double t, const PointsView& x, const VectorsView& u) const override {
    calls += x.count;
    rotation_.add(t, x, u);
  }
  void add_divergence(double t, const PointsView& x, double* values) const override {
    rotation_.add_divergence(t, x, values);
  }
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override {
    rotation_.add_gradient(t, x, gradients);
  }
  std::string describe() const override { return "counted"; }
  mutable std::atomic<std::size_t> calls{0};

 private:
  ExpressionField rotation_{{"-y", "x"}, {}};
};

TEST(Characteristics, GoOnFromTheirFeetWhereTheFlowIsSteady) {
  const auto density = written(hill);
  const auto evaluations = [&](bool steady, int outputs) {
    const CountingField field;
    const auto reference = characteristics(field, density, {}, lattice(10), {.steady = steady, .end = 20});
    std::vector<double> rho;
    for (int k = 1; k <= outputs; ++k) reference->evaluate(20. * k / outputs, rho);
    return static_cast<double>(field.calls);
  };
  EXPECT_LT(evaluations(true, 10), 2 * evaluations(true, 1)) << "linear in the end time";
  EXPECT_GT(evaluations(false, 10), 4 * evaluations(false, 1));
}

TEST(Characteristics, AreTheSameBitsForAnyThreads) {
  const ExpressionField swirl({"sin(pi*x)^2*sin(2*pi*y)*cos(t)", "-sin(pi*y)^2*sin(2*pi*x)*cos(t)"}, {});
  const auto density = written(hill);
  std::vector<double> one, several;
  characteristics(swirl, density, {}, lattice(40), {.end = 1, .threads = 1})->evaluate(1, one);
  for (const int threads : {2, 4}) {
    characteristics(swirl, density, {}, lattice(40), {.end = 1, .threads = threads})->evaluate(1, several);
    EXPECT_EQ(one, several);
  }
}

TEST(Formula, IsTheExpressionAtTheLatticePoints) {
  const Lattice grid = lattice(20, 3);
  const auto reference = formula("x + 10*y - z*t/a", {{"a", 2}}, grid);
  std::vector<double> rho;
  EXPECT_EQ(reference->evaluate(3, rho).untraced, 0u);
  EXPECT_EQ(rho, sampled(grid, [](double x, double y, double z) { return x + 10 * y - z * 3 / 2; }));
  const ReferenceReport report = formula("1/(x + 1)", {}, lattice(3))->evaluate(0, rho);
  EXPECT_EQ(report.untraced, 3u);
  EXPECT_EQ(report.first_untraced[0], -1);
  EXPECT_TRUE(std::isnan(rho[0]));
}

TEST(Compare, DividesEachNormByThatOfTheExactDensity) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ErrorNorms error = compare({1, 2, 3, 7}, {1, 4, 0, nan});
  EXPECT_DOUBLE_EQ(error.l1, 5. / 5);
  EXPECT_DOUBLE_EQ(error.l2, std::sqrt(13. / 17));
  EXPECT_DOUBLE_EQ(error.linf, 3. / 4);
  EXPECT_TRUE(std::isnan(compare({1, 2}, {0, 0}).l1)) << "nothing to compare with";
  EXPECT_DOUBLE_EQ(compare({3e200, 0}, {2e200, 0}).l2, 0.5) << "squares beyond the largest number";
}

TEST(Characteristics, AreTheSameAtSomePointsAsOnTheWholeGrid) {
  const ExpressionField turning({"-y*(1 + t)", "x*exp(-y)"}, {});
  const auto density = written(hill);
  const auto reference = characteristics(turning, density, {}, lattice(20), {.end = 1});
  std::vector<double> whole, some;
  reference->evaluate(1, whole);
  const std::vector<std::size_t> points{399, 0, 251, 330, 331, 17};
  reference->evaluate_at(1, points, some);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(some[i], whole[points[i]], 2e-15) << i;  // other neighbours, other steps; 1.1e-15 of 1
}

TEST(SampleOfGrid, HasAllPointsWhereThereAreNoMore) {
  const Lattice grid = lattice(5);
  const std::vector<double> rho(25, 1.0);
  const GridSample sample = sample_of_grid(grid, rho, 25);
  ASSERT_EQ(sample.points.size(), 25u);
  for (std::size_t i = 0; i < 25; ++i) EXPECT_EQ(sample.points[i], i);
}

TEST(SampleOfGrid, StandsForAllPointsAndHoldsTheLargest) {
  const Lattice grid = lattice(101);
  std::vector<double> rho(grid.size());
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const double x = grid.coordinate(0, i % 101), y = grid.coordinate(1, i / 101);
    rho[i] = std::max(0.0, 0.1 - std::hypot(x - 0.3, y - 0.4));
  }
  const GridSample sample = sample_of_grid(grid, rho, 300);
  EXPECT_NEAR(std::accumulate(sample.weight.begin(), sample.weight.end(), 0.0), double(rho.size()),
              6.5e-11);  // rounding of a sum of 10 000
  const auto top = static_cast<std::size_t>(std::max_element(rho.begin(), rho.end()) - rho.begin());
  EXPECT_EQ(std::count(sample.points.begin() + 300, sample.points.end(), top), 1);
  std::vector<double> exact;  // of a density that is a twentieth lower
  for (const std::size_t point : sample.points) exact.push_back(rho[point] / 1.05);
  const ErrorNorms norms = compare(rho, sample, exact);
  EXPECT_NEAR(norms.l1, 0.05, 2.1e-16);  // ten roundings of 0.05
  EXPECT_NEAR(norms.l2, 0.05, 2.1e-16);
  EXPECT_NEAR(norms.linf, 0.05, 2.1e-16);
}

TEST(SampleOfGrid, EstimatesTheNormsOfTheWholeGrid) {
  const Lattice grid = lattice(201);
  std::vector<double> rho(grid.size()), exact(grid.size());
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const double x = grid.coordinate(0, i % 201), y = grid.coordinate(1, i / 201);
    exact[i] = std::exp(-100 * ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5)));
    rho[i] = exact[i] + 0.01 * std::exp(-200 * ((x - 0.6) * (x - 0.6) + (y - 0.5) * (y - 0.5)));
  }
  const GridSample sample = sample_of_grid(grid, rho, 1000);
  std::vector<double> sampled;
  for (const std::size_t point : sample.points) sampled.push_back(exact[point]);
  const ErrorNorms whole = compare(rho, exact), estimated = compare(rho, sample, sampled);
  EXPECT_NEAR(estimated.l1, whole.l1, 0.017 * whole.l1);  // 500 points over a spot of 13 000: 0.0056
  EXPECT_NEAR(estimated.l2, whole.l2, 0.025 * whole.l2);  // 0.0083
  EXPECT_LE(estimated.linf, whole.linf);
  EXPECT_GE(estimated.linf, 0.9 * whole.linf);
}

}  // namespace
}  // namespace gaussdrift
