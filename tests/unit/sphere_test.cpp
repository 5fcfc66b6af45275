// Blobs, velocities, shapes and data on a sphere, each against a formula of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/sphere.hpp"
#include "field/density/radial_density.hpp"
#include "field/gridded/around_sphere.hpp"
#include "field/gridded/gridded.hpp"
#include "field/named/named_fields.hpp"
#include "field/spherical/around_centre.hpp"
#include "field/spherical/on_sphere.hpp"
#include "field/velocity/expression_field.hpp"
#include "field/velocity/streamfunction_field.hpp"
#include "gaussdrift/particles.hpp"
#include "particle/chord.hpp"
#include "particle/seeding.hpp"
#include "particle/tiles.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {
namespace {

constexpr double pi = std::numbers::pi, radius = earth_radius;

Particles scattered(std::size_t count) {
  Particles particles;
  for (std::size_t j = 0; j < count; ++j) {
    const double a = std::fmod(0.5 + static_cast<double>(j) * std::numbers::phi, 1.0),
                 b = (static_cast<double>(j) + 0.5) / static_cast<double>(count);
    particles.position[0].push_back(std::remainder(170 + 40 * a, 360.0));  // on both sides of 180 degrees
    particles.position[1].push_back(60 + 25 * b);
    particles.alpha.push_back(1e10 * (1 + std::sin(7 * a)));
    particles.id.push_back(static_cast<std::int64_t>(j));
  }
  return particles;
}

/// zeta_eps of a distance, as in method.md, section 3, for the plane.
double blob(const std::string& cutoff, double eps, double distance) {
  const double s = std::pow(distance / eps, 2), g = std::exp(-s) / (pi * eps * eps);
  if (cutoff == "gauss2") return g;
  if (cutoff == "gauss4") return g * (2 - s);
  if (cutoff == "gauss6") return g * (3 - 3 * s + s * s / 2);
  if (cutoff == "gauss8") return g * (4 - 6 * s + 2 * s * s - s * s * s / 6);
  if (cutoff == "two-gauss") return 4. / 3 * g - std::exp(-s / 4) / (pi * 4 * eps * eps) / 3;
  throw std::logic_error(cutoff);
}

double chord(const Vector& a, const Vector& b) { return 2 * radius * std::sin(angle_between(a, b) / 2); }

TEST(Sphere, HasDistancesThatAreKnown) {
  EXPECT_NEAR(angle_between({0, 0, 0}, {90, 0, 0}), pi / 2, 1e-15);
  EXPECT_NEAR(angle_between({179.5, 30, 0}, {-179.5, 30, 0}), 2 * std::asin(std::cos(pi / 6) * std::sin(pi / 360)),
              1e-16);
  constexpr double little = 1. / (1 << 24);
  EXPECT_NEAR(angle_between({10, 20, 0}, {10, 20 + little, 0}), radians(little), 1e-15 * radians(little));
  const Vector place = longitude_and_latitude(on_unit_sphere(-123.25, 71.5));
  EXPECT_NEAR(place[0], -123.25, 3e-14);
  EXPECT_NEAR(place[1], 71.5, 3e-14);
}

TEST(Chord, CutoffsHaveTheValuesOfThePlaneAndTheirIntegral) {
  const double eps = 2e5;
  for (const std::string name : {"gauss2", "gauss4", "gauss6", "gauss8", "two-gauss"}) {
    const Cutoff cutoff = on_sphere(make_cutoff(name, 2, eps), radius);
    Particles one;
    one.position = {{{30}, {80}, {}}};
    one.alpha = {1};
    one.id = {0};
    const double peak = blob(name, eps, 0);
    for (const double degrees : {0.0, 0.5, 1.0, 2.0, 4.0, 7.0}) {
      const double x = 30 + 3 * degrees, y = 80 + degrees;
      const PointsView at{2, 1, {&x, &y, nullptr}};
      EXPECT_NEAR(sum_blobs(one, cutoff, at, 1)[0], blob(name, eps, chord({30, 80, 0}, {x, y, 0})), 1e-13 * peak)
          << name;
    }
    // Over the sphere: rings of 2 pi c dc, for a chord c. By Simpson's rule.
    double sum = 0;
    constexpr int n = 8000;
    for (int i = 0; i <= n; ++i) {
      const double c = 14 * eps * i / n, theta = 2 * std::asin(c / (2 * radius));
      const double x = 30, y = 80 - degrees(theta);
      const PointsView at{2, 1, {&x, &y, nullptr}};
      sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * 2 * pi * c * sum_blobs(one, cutoff, at, 1)[0];
    }
    EXPECT_NEAR(sum * 14 * eps / n / 3, 1, 1e-10) << name;  // Simpson's rule: 6e-12
  }
}

TEST(Chord, IsRefusedForBlobsThatAreNotRound) {
  constexpr Tensor longer{{{1, 0, 0}, {0, 0.5, 0}, {0, 0, 0}}};
  EXPECT_THROW(in_space(spread_cutoff(make_cutoff("gauss2", 2, 1), 2, 1, longer)), std::logic_error);
  EXPECT_THROW(in_space({{.width = 1, .derivative = {2, 0, 0}}}), std::logic_error);
  EXPECT_THROW(in_space({{.width = 1, .derivative = {1, 0, 0}}}), std::logic_error);
}

class OnTheSphere : public testing::TestWithParam<std::string> {};

TEST_P(OnTheSphere, TheDensityIsTheSumOfAllBlobsWrittenOut) {
  const Particles particles = scattered(400);
  const double eps = 3e5, tolerance = 1e-8;
  const Cutoff cutoff = on_sphere(make_cutoff(GetParam(), 2, eps), radius);
  Lattice lattice = make_lattice(2, {165, 55, 0}, {225, 88, 0}, 40);
  lattice.sphere = radius;
  DensityReport report;
  const DensityGrid once =
      evaluate_density(particles, cutoff, lattice, {.tolerance = tolerance, .threads = 1}, &report);
  const DensityGrid again = evaluate_density(particles, cutoff, lattice, {.tolerance = tolerance, .threads = 2});
  EXPECT_EQ(once.rho, again.rho);
  double largest = 0, worst = 0, from_arcs = 0;
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    const Vector x{lattice.coordinate(0, i % lattice.points[0]), lattice.coordinate(1, i / lattice.points[0]), 0};
    double sum = 0, by_arcs = 0;
    for (std::size_t j = 0; j < particles.size(); ++j) {
      const Vector y = particles.view().at(j);
      sum += particles.alpha[j] * blob(GetParam(), eps, chord(x, y));
      by_arcs += particles.alpha[j] * blob(GetParam(), eps, radius * angle_between(x, y));
    }
    largest = std::max(largest, std::abs(sum));
    worst = std::max(worst, std::abs(sum - once.rho[i]));
    from_arcs = std::max(from_arcs, std::abs(sum - by_arcs));
  }
  EXPECT_LT(worst, tolerance * largest);
  EXPECT_LT(report.measured_error, tolerance);
  // Of one blob the arc in place of the chord changes at most 0.05 to 1.2 (eps/R)^2 of the peak; eps/R = 0.047.
  EXPECT_LT(from_arcs, std::pow(eps / radius, 2) * largest);
  EXPECT_GT(from_arcs, 1e-3 * std::pow(eps / radius, 2) * largest);
}

INSTANTIATE_TEST_SUITE_P(Cutoffs, OnTheSphere, testing::Values("gauss2", "gauss4", "gauss6", "gauss8", "two-gauss"));

/// Particles all over the sphere but for the poles' surroundings, on a grid that meets itself at 180 degrees.
TEST(TilesOfASphere, GetEveryParticleThatReachesThemOnce) {
  Particles particles = scattered(3000);
  for (std::size_t j = 0; j < particles.size(); ++j) {
    particles.position[0][j] = std::remainder(360 * std::fmod(static_cast<double>(j) * std::numbers::phi, 1.0), 360.0);
    particles.position[1][j] = -88 + 176 * (static_cast<double>(j) + 0.5) / 3000;
  }
  for (const Vector& corner : {Vector{-180, -85, 0}, Vector{-60, 20, 0}}) {
    Lattice lattice = make_lattice(2, corner, {-corner[0], 85, 0}, 181);
    lattice.sphere = radius;
    for (const double reach : {3e5, 9e5, 2.5e6}) {
      const Tiles tiles(lattice, reach, particles.view(), {.particles = 50, .points = 400, .reaches = 0.5});
      ASSERT_GT(tiles.list().size(), 3u) << reach;
      const auto gathered = tiles.gather(particles.view(), std::vector<char>(tiles.list().size(), 1), 1);
      for (std::size_t t = 0; t < tiles.list().size(); ++t) {
        const Tile& tile = tiles.list()[t];
        EXPECT_TRUE(std::adjacent_find(gathered[t].begin(), gathered[t].end()) == gathered[t].end()) << "once";
        std::vector<char> has(particles.size(), 0);
        for (const std::size_t j : gathered[t]) has[j] = 1;
        std::vector<Vector> points;
        for (std::size_t i = 0; i < tile.size(); ++i)
          points.push_back(on_unit_sphere(lattice.coordinate(0, tile.first[0] + i % tile.points[0]),
                                          lattice.coordinate(1, tile.first[1] + i / tile.points[0])));
        for (std::size_t j = t % 29; j < particles.size(); j += 29) {
          const Vector x = on_unit_sphere(particles.position[0][j], particles.position[1][j]);
          const bool reaches = std::any_of(points.begin(), points.end(), [&](const Vector& y) {
            return radius * std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) <= reach;
          });
          EXPECT_TRUE(has[j] || !reaches)
              << reach << " " << particles.position[0][j] << " " << particles.position[1][j];
        }
      }
    }
  }
}

TEST(TilesOfASphere, SumToTheDensityOfTheWhole) {
  const Particles particles = scattered(400);
  const Cutoff cutoff = on_sphere(make_cutoff("gauss4", 2, 1e5), radius);
  Lattice lattice = make_lattice(2, {-180, 40, 0}, {180, 89, 0}, 361);
  lattice.sphere = radius;
  constexpr double tolerance = 1e-8;
  DensityReport report;
  const DensityGrid whole = evaluate_at_once(particles, cutoff, lattice, {.tolerance = tolerance, .threads = 1}),
                    tiled = evaluate_density(particles, cutoff, lattice,
                                             {.tolerance = tolerance,
                                              .threads = 1,
                                              .tiles = TileLimits{.particles = 40, .points = 400, .reaches = 1}},
                                             &report);
  EXPECT_EQ(report.choice.find("1 tiles"), std::string::npos);
  EXPECT_NE(report.choice.find(" tiles"), std::string::npos) << report.choice;
  double largest = 0;
  for (const double rho : whole.rho) largest = std::max(largest, std::abs(rho));
  for (std::size_t i = 0; i < lattice.size(); ++i) EXPECT_NEAR(tiled.rho[i], whole.rho[i], 2 * tolerance * largest);
  EXPECT_LT(report.measured_error, tolerance);
}

// --- velocities

Vector at(const VelocityField& field, const Vector& x) {
  Vector u{};
  field.add(0, {2, 1, {&x[0], &x[1], nullptr}}, {2, 1, {&u[0], &u[1], nullptr}});
  return u;
}

double divergence_at(const VelocityField& field, const Vector& x) {
  double value = 0;
  field.add_divergence(0, {2, 1, {&x[0], &x[1], nullptr}}, &value);
  return value;
}

std::array<Vector, 2> gradient_at(const VelocityField& field, const Vector& x) {
  std::array<Vector, 2> slopes{};
  GradientsView view{2, 1, {}};
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < 2; ++i) view.slope[k][i] = &slopes[k][i];
  field.add_gradient(0, {2, 1, {&x[0], &x[1], nullptr}}, view);
  return slopes;
}

/// Central differences of order 4 along an axis of the coordinates.
Vector difference(const VelocityField& field, Vector x, std::size_t axis) {
  constexpr double h = 0.02;
  const auto u = [&](double shift) {
    Vector y = x;
    y[axis] += shift;
    return at(field, y);
  };
  Vector slope{};
  for (std::size_t k = 0; k < 2; ++k) slope[k] = (8 * (u(h)[k] - u(-h)[k]) - (u(2 * h)[k] - u(-2 * h)[k])) / (12 * h);
  return slope;
}

std::unique_ptr<VelocityField> wind() {
  return std::make_unique<DegreesVelocity>(
      std::make_unique<ExpressionField>(std::vector<std::string>{"3*sin(x/20) + y/10", "2*cos(x/15)*sin(y/25)"},
                                        Params{}),
      DegreesVelocity::Of::components, 100.0);
}

const std::vector<Vector> places{{10, 20, 0}, {-170, -65, 0}, {95, 80, 0}, {30, 0, 0}};

TEST(DegreesVelocity, IsTheWindInDegrees) {
  const auto field = wind();
  for (const Vector& x : places) {
    const double east = 3 * std::sin(x[0] / 20) + x[1] / 10, north = 2 * std::cos(x[0] / 15) * std::sin(x[1] / 25);
    const Vector u = at(*field, x);
    EXPECT_NEAR(u[0], east / (100 * std::cos(x[1] * pi / 180)) * 180 / pi, 1e-13 * std::abs(u[0]) + 1e-15);
    EXPECT_NEAR(u[1], north / 100 * 180 / pi, 1e-13);
    const auto slopes = gradient_at(*field, x);
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t k = 0; k < 2; ++k)
        EXPECT_NEAR(slopes[k][i], difference(*field, x, i)[k], 1e-7);  // h^4 times a fifth derivative of up to 0.1
    EXPECT_NEAR(divergence_at(*field, x), slopes[0][0] + slopes[1][1], 1e-15);
    // The sphere's: (d u/dx + d (v cos y)/dy) / (R cos y).
    const SphereVelocity sphere(wind(), 100, false);
    const double y = x[1] * pi / 180, u_x = 3. / 20 * std::cos(x[0] / 20) * 180 / pi,
                 v_y = 2. / 25 * std::cos(x[0] / 15) * std::cos(x[1] / 25) * 180 / pi;
    const double exact = (u_x + v_y * std::cos(y) - north * std::sin(y)) / (100 * std::cos(y));
    EXPECT_NEAR(divergence_at(sphere, x), exact, 1e-14);
    EXPECT_NEAR(divergence_at(sphere.in_lengths(), x), exact, 1e-14);
    EXPECT_NEAR(at(sphere.in_lengths(), x)[0], east, 1e-13);
    EXPECT_NEAR(at(sphere.shown(), x)[1], north, 1e-13);
  }
}

TEST(DegreesVelocity, OfAStreamfunctionHasNoDivergenceOnTheSphere) {
  // psi = R a sin y turns the sphere about its axis: u = a cos y.
  const std::string psi = "100*2*sin(pi*y/180) + 3*sin(x/20)*cos(y/15)";
  const auto make = [&] {
    return std::make_unique<DegreesVelocity>(std::make_unique<StreamfunctionField>(psi, Params{}, 360),
                                             DegreesVelocity::Of::streamfunction, 100.0);
  };
  const SphereVelocity sphere(make(), 100, false);  // so that the divergence is computed
  for (const Vector& x : places) {
    const double y = x[1] * pi / 180, degree = pi / 180;
    const double psi_y = 200 * std::cos(y) - 3. / 15 / degree * std::sin(x[0] / 20) * std::sin(x[1] / 15),
                 psi_x = 3. / 20 / degree * std::cos(x[0] / 20) * std::cos(x[1] / 15);
    EXPECT_NEAR(at(sphere.in_lengths(), x)[0], psi_y / 100, 1e-13);
    EXPECT_NEAR(at(sphere.in_lengths(), x)[1], -psi_x / (100 * std::cos(y)), 1e-13);
    EXPECT_NEAR(divergence_at(sphere, x), 0, 1e-15);
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t k = 0; k < 2; ++k)
        EXPECT_NEAR(gradient_at(sphere, x)[k][i], difference(sphere, x, i)[k], 1e-5) << x[1];  // at 80 degrees
  }
}

TEST(LengthsVelocity, OfASolidBodyTurnsAndDoesNotStrain) {
  const double rate = 0.3;
  const Arguments about{{"pole", {40, 55}}, {"rate", {rate}}};
  const SphereVelocity sphere(make_named_field("sphere_rotation", {2, {}, {}}, about), 50, true);
  const Vector pole = on_unit_sphere(40, 55);
  for (const Vector& x : places) {
    const auto g = gradient_at(sphere.in_lengths(), x);
    const Vector p = on_unit_sphere(x[0], x[1]);
    EXPECT_NEAR(g[0][0], 0, 1e-14);
    EXPECT_NEAR(g[1][1], 0, 1e-14);
    EXPECT_NEAR(g[0][1] + g[1][0], 0, 1e-14);
    EXPECT_NEAR(g[1][0] - g[0][1], 2 * rate * (pole[0] * p[0] + pole[1] * p[1] + pole[2] * p[2]), 1e-14);
    const Vector u = at(sphere.in_lengths(), x);
    EXPECT_NEAR(std::hypot(u[0], u[1]), 50 * rate * std::sin(angle_between({40, 55, 0}, x)), 1e-13);
  }
}

TEST(SphereVelocity, RefusesPlacesAtThePoles) {
  const SphereVelocity sphere(wind(), 100, false);
  EXPECT_TRUE(std::isfinite(at(sphere, {0, 89.8, 0})[0]));
  EXPECT_TRUE(std::isnan(at(sphere, {0, 89.95, 0})[0]));
  EXPECT_TRUE(std::isnan(at(sphere, {0, -91, 0})[1]));
  EXPECT_NE(sphere.why_not_finite(0, {0, 89.95, 0}).find("within 0.1 degrees of a pole"), std::string::npos);
  EXPECT_EQ(sphere.why_not_finite(0, {0, 50, 0}), "");
}

// --- densities and lattices

TEST(DensityAroundCentre, KeepsDistancesAndDirections) {
  const Vector centre{175, 62, 0};
  const DensityAroundCentre cone(std::make_unique<RadialDensity>(RadialDensity::Profile::cone, 2, Vector{}, 2e6, 3),
                                 centre, radius);
  for (const Vector& x : {centre, Vector{-178, 65, 0}, Vector{182, 65, 0}, Vector{175, 50, 0}, Vector{170, 75, 0}}) {
    double rho = 0;
    cone.add({2, 1, {&x[0], &x[1], nullptr}}, &rho);
    EXPECT_NEAR(rho, 3 * std::max(0.0, 1 - radius * angle_between(centre, x) / 2e6), 1e-12);
  }
  EXPECT_FALSE(cone.mass());
  EXPECT_EQ(cone.describe().find("mass"), std::string::npos) << "that of the plane is not that of the sphere";
  // A shape that tells east from north.
  const DensityAroundCentre half(
      std::make_unique<RadialDensity>(RadialDensity::Profile::disk, 2, Vector{2e5, 0, 0}, 3e4, 1), centre, radius);
  const double degrees_east = degrees(2e5 / radius) / std::cos(radians(62));
  for (const double side : {-1.0, 1.0}) {
    const double x = centre[0] + side * degrees_east * 0.99, y = 62;
    double rho = 0;
    half.add({2, 1, {&x, &y, nullptr}}, &rho);
    EXPECT_EQ(rho, side > 0 ? 1 : 0);
  }
}

TEST(Lattice, HasAreasOnASphere) {
  Lattice lattice = make_lattice(2, {-180, -60, 0}, {180, 60, 0}, 361);
  lattice.sphere = radius;
  EXPECT_DOUBLE_EQ(lattice.unit(), radius * pi / 180);
  // The trapezoidal rule gives the area of the zone between the parallels, 4 pi R^2 sin 60, to (pi/360)^2/3.
  double sum = 0;
  for (std::size_t j = 0; j < lattice.points[1]; ++j)
    sum += 360 * (j == 0 || j + 1 == lattice.points[1] ? 0.5 : 1) * lattice.cell(lattice.coordinate(1, j));
  EXPECT_NEAR(sum / (4 * pi * radius * radius * std::sin(pi / 3)), 1, 3e-5);
  lattice.sphere = 0;
  EXPECT_EQ(lattice.cell(50), 1);
  EXPECT_EQ(lattice.unit(), 1);
}

TEST(Seeding, WeighsByAreasAndFindsNeighboursAcross180) {
  Lattice lattice = make_lattice(2, {175, 40, 0}, {185, 50, 0}, 11);
  lattice.sphere = radius;
  Particles particles = seed(
      lattice, [](const PointsView& x, double* v) { std::fill_n(v, x.count, 2.0); }, 1);
  ASSERT_EQ(particles.size(), lattice.size());
  for (std::size_t j = 0; j < particles.size(); ++j)
    EXPECT_DOUBLE_EQ(particles.alpha[j],
                     2 * std::pow(radius * pi / 180, 2) * std::cos(particles.position[1][j] * pi / 180));
  for (double& x : particles.position[0])
    if (x > 180) x -= 360;
  EXPECT_NEAR(largest_stretch(particles, lattice), 1, 1e-12);  // of those above each other: a degree
}

// --- data

std::shared_ptr<GridData> longitudes(double first, double spacing, std::size_t count) {
  auto data = std::make_shared<GridData>();
  data->name = "wind.nc";
  data->times = {0};
  for (std::size_t i = 0; i < count; ++i) data->axis[0].push_back(first + spacing * static_cast<double>(i));
  data->axis[1] = {-50, 0, 50};
  data->components = 2;
  data->values.emplace_back();
  for (const double y : data->axis[1])
    for (const double x : data->axis[0]) {
      data->values[0].push_back(std::sin(x * pi / 180) + y);
      data->values[0].push_back(std::cos(2 * x * pi / 180));
    }
  return data;
}

TEST(AroundSphere, ClosesDataThatGoAllTheWayRound) {
  for (const bool twice : {false, true})
    for (const double middle : {0.0, 180.0, -37.0, 359.0}) {
      const auto data = around_sphere(longitudes(0, 10, twice ? 37 : 36), middle);
      const GriddedVelocity field(GridInterpolator(data, Interpolation::cubic, Outside::error));
      for (double x = middle - 180; x <= middle + 180; x += 7) {
        const Vector u = at(field, {x, 0, 0});
        EXPECT_NEAR(u[0], std::sin(x * pi / 180), 1e-3) << x;  // h^3/10 of a third derivative of 1
        EXPECT_NEAR(u[1], std::cos(2 * x * pi / 180), 8e-3) << x;
      }
      const Vector low = at(field, {middle - 180, 20, 0}), high = at(field, {middle + 180, 20, 0});
      EXPECT_NEAR(low[0], high[0], 1e-13);
      EXPECT_NEAR(low[1], high[1], 1e-13);
    }
}

TEST(AroundSphere, MovesDataOfARegionByWholeTurns) {
  const auto data = around_sphere(longitudes(340, 2, 11), -10);
  EXPECT_EQ(data->axis[0].front(), -20);
  EXPECT_EQ(data->axis[0].size(), 11u);
  const auto same = longitudes(-20, 2, 11);
  EXPECT_EQ(around_sphere(same, -10), same);
}

TEST(AroundSphere, ReadsOnTheWayTheSameNumbers) {
  const auto held = longitudes(0, 30, 12);
  auto read = std::make_shared<GridData>(*held);
  read->values.clear();
  read->levels = std::make_shared<const GridLevels>(1, [held](std::size_t) { return held->values[0]; });
  const auto a = around_sphere(held, 10), b = around_sphere(read, 10);
  EXPECT_EQ(a->values[0], *b->levels->at(0));
  EXPECT_EQ(a->axis, b->axis);
  EXPECT_EQ(a->axis[0].size(), 16u);
}

TEST(AroundSphere, RefusesWhatAreNoDegrees) {
  EXPECT_THROW(around_sphere(longitudes(0, 100, 6), 0), std::invalid_argument);
  auto data = longitudes(0, 10, 5);
  data->axis[1] = {0, 100, 200};
  EXPECT_THROW(around_sphere(data, 0), std::invalid_argument);
}

}  // namespace
}  // namespace gaussdrift
