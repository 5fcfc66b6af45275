// Interpolation of data on grids: exact where it should be, its order, its divergence, and what stands outside.
#include "field/gridded/grid_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "field/gridded/gridded.hpp"

namespace gaussdrift {
namespace {

using Function = std::function<double(double x, double y, double z)>;

/// Components on [0, 1]^d with n points an axis; `stretch` makes the spacing uneven.
std::shared_ptr<const GridData> sampled(int dimension, std::size_t n, const std::vector<Function>& components,
                                        bool stretch = false) {
  auto data = std::make_shared<GridData>();
  data->name = "u of test.vti";
  data->dimension = dimension;
  data->components = components.size();
  data->times = {0};
  for (int k = 0; k < dimension; ++k)
    for (std::size_t i = 0; i < n; ++i) {
      const double s = static_cast<double>(i) / static_cast<double>(n - 1);
      data->axis[k].push_back(stretch ? s * (0.7 + 0.3 * s) : s);
    }
  data->values.emplace_back();
  for (std::size_t p = 0; p < data->points(); ++p) {
    const double x = data->axis[0][p % n], y = data->axis[1][p / n % n],
                 z = dimension == 3 ? data->axis[2][p / n / n] : 0;
    for (const Function& f : components) data->values[0].push_back(f(x, y, z));
  }
  return data;
}

double value(const GridInterpolator& grid, double t, const Vector& x) {
  PointsView view{grid.data().dimension, 1, {&x[0], &x[1], &x[2]}};
  double sum = 0;
  double* sums[] = {&sum};
  grid.add(t, view, 1, sums);
  return sum;
}

double divergence(const GridInterpolator& grid, const Vector& x) {
  PointsView view{grid.data().dimension, 1, {&x[0], &x[1], &x[2]}};
  double sum = 0;
  grid.add_divergence(0, view, &sum);
  return sum;
}

TEST(GridInterpolator, GivesTwoComponentsAtOnceAsOneByOne) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.2, 1.2), moment(-1, 4);
  for (const bool stretch : {false, true})
    for (const Outside outside : {Outside::error, Outside::clamp, Outside::zero})
      for (const Interpolation in_time : {Interpolation::linear, Interpolation::cubic}) {
        auto data =
            std::make_shared<GridData>(*sampled(2, 7,
                                                {[](double x, double y, double) { return std::sin(9 * x) + y; },
                                                 [](double x, double y, double) { return std::cos(7 * y) * x; }},
                                                stretch));
        for (int t = 1; t < 4; ++t) {
          data->times.push_back(t + 0.1 * t * t);
          data->values.push_back(data->values[0]);
          for (double& number : data->values.back()) number = std::sin(number + t);
        }
        const GridInterpolator grid(data, Interpolation::linear, outside, in_time);
        for (int trial = 0; trial < 200; ++trial) {
          const Vector x{place(random), place(random), 0};
          const double t = moment(random);
          const PointsView view{2, 1, {&x[0], &x[1], nullptr}};
          double u = 0, v = 0, alone = 0;
          double* const both[] = {&u, &v};
          double* const one[] = {&alone};
          grid.add(t, view, 2, both);
          grid.add(t, view, 1, one);
          EXPECT_TRUE(u == alone || (std::isnan(u) && std::isnan(alone))) << u << " " << alone;
          EXPECT_EQ(std::isnan(u), std::isnan(v));
        }
      }
}

TEST(GridInterpolator, IsExactForParabolasInTimeWithCubics) {
  auto data = std::make_shared<GridData>(*sampled(2, 2, {[](double, double, double) { return 0; }}));
  data->times = {0, 1, 1.5, 4};
  const auto parabola = [](double t) { return 1 - 3 * t + 2 * t * t; };
  data->values.clear();
  for (const double t : data->times) data->values.emplace_back(4, parabola(t));
  const GridInterpolator cubic(data, Interpolation::linear, Outside::error, Interpolation::cubic);
  for (const double t : {0., 0.3, 1., 1.2, 1.5, 3.9, 4.})
    EXPECT_NEAR(value(cubic, t, {0.5, 0.5, 0}), parabola(t), 1e-13);
  EXPECT_EQ(value(cubic, 5, {0.5, 0.5, 0}), parabola(4));
}

TEST(GridInterpolator, ReproducesWhatItsOrderPromises) {
  const Function linear = [](double x, double y, double z) { return 1 + x - 2 * y + 3 * z + x * y; };
  const Function square = [](double x, double y, double z) { return x * x - y * y * x + z * z; };
  std::mt19937 random(3);
  for (const int d : {2, 3})
    for (const bool stretch : {false, true})
      for (int trial = 0; trial < 50; ++trial) {
        Vector x{};
        for (int k = 0; k < d; ++k) x[k] = std::uniform_real_distribution(0.0, 1.0)(random);
        const GridInterpolator a(sampled(d, 6, {linear}, stretch), Interpolation::linear, Outside::error);
        const GridInterpolator b(sampled(d, 6, {square}, stretch), Interpolation::cubic, Outside::error);
        EXPECT_NEAR(value(a, 0, x), linear(x[0], x[1], x[2]), 2.7e-15);  // three roundings of numbers below 7
        EXPECT_NEAR(value(b, 0, x), square(x[0], x[1], x[2]), 2.7e-15);
      }
}

TEST(GridInterpolator, HasTheGradientOfSquares) {
  const Function first = [](double x, double y, double z) { return x * x - y * y * x + z * z; };
  const Function second = [](double x, double y, double z) { return 2 * x * y + y - z * x; };
  const Function third = [](double x, double y, double z) { return z * z * x - y; };
  const GridInterpolator grid(sampled(3, 6, {first, second, third}, true), Interpolation::cubic, Outside::error);
  const double x = 0.37, y = 0.81, z = 0.22;
  std::array<std::array<double, 3>, 3> slopes{};
  std::array<std::array<double*, 3>, 3> view{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) view[k][i] = &slopes[k][i];
  grid.add_gradient(0, {3, 1, {&x, &y, &z}}, view);
  const double expected[3][3] = {
      {2 * x - y * y, -2 * y * x, 2 * z}, {2 * y - z, 2 * x + 1, -x}, {z * z, -1, 2 * z * x}};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(slopes[k][i], expected[k][i], 1e-13) << k << i;
}

TEST(GridInterpolator, ConvergesWithItsOrder) {
  const Function wave = [](double x, double y, double) { return std::sin(5 * x) * std::cos(4 * y); };
  const auto error = [&](std::size_t n, Interpolation interpolation) {
    const GridInterpolator grid(sampled(2, n, {wave}), interpolation, Outside::error);
    double largest = 0;
    std::mt19937 random(5);
    for (int i = 0; i < 2000; ++i) {
      const Vector x{std::uniform_real_distribution(0.0, 1.0)(random), std::uniform_real_distribution(0.0, 1.0)(random),
                     0};
      largest = std::max(largest, std::abs(value(grid, 0, x) - wave(x[0], x[1], 0)));
    }
    return largest;
  };
  const auto order = [&](Interpolation interpolation) {
    return std::log2(error(41, interpolation) / error(81, interpolation));
  };
  EXPECT_NEAR(order(Interpolation::linear), 2, 0.15);  // 2000 points do not always meet the worst
  EXPECT_NEAR(order(Interpolation::cubic), 3, 0.3);    // the outer cells decide; the inner ones are better
}

TEST(GridInterpolator, HasTheDivergenceOfItsOwnFunction) {
  const std::vector<Function> flow{[](double x, double y, double z) { return std::sin(3 * x) * y + z; },
                                   [](double x, double y, double z) { return std::cos(2 * y) + x * z; },
                                   [](double x, double y, double z) { return z * z * x - y; }};
  for (const int d : {2, 3})
    for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cubic}) {
      const auto data = sampled(d, 7, {flow.begin(), flow.begin() + d}, true);
      const GridInterpolator grid(data, interpolation, Outside::error);
      const Vector x{0.43, 0.31, 0.77};
      const double h = 1e-5;  // stays in the cell, where the function is a cubic: no error of truncation at order 4
      double numerical = 0;
      for (int k = 0; k < d; ++k) {
        const auto u = [&](double shift) {
          Vector y = x;
          y[k] += shift;
          double sums[3] = {0, 0, 0};
          double* out[] = {&sums[0], &sums[1], &sums[2]};
          grid.add(0, {d, 1, {&y[0], &y[1], &y[2]}}, static_cast<std::size_t>(d), out);
          return sums[k];
        };
        numerical += (8 * (u(h) - u(-h)) - (u(2 * h) - u(-2 * h))) / (12 * h);
      }
      EXPECT_NEAR(divergence(grid, x), numerical, 9e-11);  // rounding / h: 3e-11
    }
}

TEST(GridInterpolator, DoesOutsideWhatWasChosen) {
  const auto data = sampled(2, 3, {[](double x, double y, double) { return 1 + x + 10 * y; }});
  const Vector outside{2, 0.5, 0}, inside{1, 0.5, 0}, rounding{1 + 1e-14, 0.5, 0};
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cubic}) {
    EXPECT_TRUE(std::isnan(value({data, interpolation, Outside::error}, 0, outside)));
    EXPECT_NEAR(value({data, interpolation, Outside::clamp}, 0, outside), 7, 9e-16);  // one rounding
    EXPECT_EQ(value({data, interpolation, Outside::zero}, 0, outside), 0);
    for (const Outside choice : {Outside::error, Outside::clamp, Outside::zero}) {
      EXPECT_NEAR(value({data, interpolation, choice}, 0, inside), 7, 9e-16);  // the surface is inside
      EXPECT_NEAR(value({data, interpolation, choice}, 0, rounding), 7, 9e-16);
      EXPECT_TRUE(choice == Outside::zero || std::isnan(value({data, interpolation, choice}, 0, {NAN, 0, 0})) ||
                  choice == Outside::clamp);
    }
    EXPECT_TRUE(std::isnan(value({data, interpolation, Outside::clamp}, 0, {NAN, 0, 0})));
    EXPECT_TRUE(std::isnan(value({data, interpolation, Outside::zero}, 0, {NAN, 0, 0})));
  }
}

TEST(GridInterpolator, IsLinearInTimeAndHoldsTheEnds) {
  auto data = std::make_shared<GridData>(*sampled(2, 2, {[](double, double, double) { return 1; }}));
  data->times = {1, 3, 4};
  data->values = {std::vector<double>(4, 1.0), std::vector<double>(4, 5.0), std::vector<double>(4, 0.0)};
  const GridInterpolator grid(data, Interpolation::cubic, Outside::error);
  const Vector x{0.2, 0.9, 0};
  for (const auto& [t, expected] : {std::pair{0.0, 1.0}, {1.0, 1.0}, {1.5, 2.0}, {3.0, 5.0}, {3.75, 1.25}, {9.0, 0.0}})
    EXPECT_NEAR(value(grid, t, x), expected, 4.5e-16) << t;  // two roundings
  EXPECT_FALSE(GriddedVelocity(grid).is_steady());
}

TEST(GridInterpolator, RefusesDataThatDoNotFit) {
  auto data = std::make_shared<GridData>(*sampled(2, 3, {[](double, double, double) { return 1; }}));
  data->values[0].pop_back();
  EXPECT_THROW(GridInterpolator(data, Interpolation::linear, Outside::error), std::invalid_argument);
}

}  // namespace
}  // namespace gaussdrift
