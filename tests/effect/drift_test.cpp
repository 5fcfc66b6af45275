// Particles that move each other, against closed forms: charges under mobility drift, vortices in their own flow.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "effect/charge.hpp"
#include "effect/vortex.hpp"
#include "field/velocity/expression_field.hpp"
#include "gaussdrift/error.hpp"
#include "scene.hpp"
#include "sim/carrier.hpp"
#include "sim/scene.hpp"
#include "sim/stepper.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {
namespace {

using std::numbers::pi;

Case disc(const std::vector<std::string>& overrides) {
  std::vector<std::string> all{"particles.per_axis=81", "time.end=1",         "time.step=0.1",
                               "output.times=[1]",      "density.shape=disk", "density.radius=0.4"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return scene_of(all);
}

double mean_square_radius(const Particles& particles) {
  double sum = 0, mass = 0;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    for (int k = 0; k < particles.dimension; ++k)
      sum += particles.alpha[j] * particles.position[k][j] * particles.position[k][j];
    mass += particles.alpha[j];
  }
  return sum / mass;
}

Particles at_start(const Case& spec) { return seed_scene(make_scene(spec), 0); }

// rho = rho_0 / (1 + t/tau), tau = 1/(2 pi mu rho_0), R^2 = R_0^2 (1 + t/tau). docs/method.md, section 8.4.
TEST(Charge, AnEvenDiscStaysEvenAndGrows) {
  const double mu = 0.3, growth = 1 + 2 * pi * mu;
  const Case spec = disc({"effects.charge.mobility=0.3"});
  Simulation simulation(spec);
  const RunSummary summary = simulation.run();
  // Blobs do not see the part (eps/R)^2 = 1.6 % of the charge that is nearer than eps: less than 1 % of the growth
  // by 1.9.
  EXPECT_NEAR(mean_square_radius(simulation.particles()) / mean_square_radius(at_start(spec)), growth, 1e-2 * growth);
  EXPECT_NEAR(summary.frames.back().second.maximum, 1 / growth, 0.05 / growth);  // ripples at the edge
}

// R^3 = R_0^3 (1 + t/tau), tau = 1/(4 pi mu rho_0). docs/method.md, section 8.4.
TEST(Charge, AnEvenBallStaysEvenAndGrows) {
  const std::string text = case_text({.domain = cube,
                                      .velocity = velocity_of({"0", "0", "0"}),
                                      .density = "expression = \"x^2 + y^2 + z^2 < 0.16 ? 1 : 0\"",
                                      .particles = "per_axis = 41",
                                      .time = "end = 1\nstep = 0.1",
                                      .output = output_at("1")}) +
                           "[effects.charge]\nmobility = 0.1\n";
  const Case spec = scene_of({}, text);
  Simulation simulation(spec);
  simulation.run();
  const double growth = std::pow(1 + 4 * pi * 0.1, 2.0 / 3);
  // 1 %: a ball of 2000 points on a lattice is not quite round
  EXPECT_NEAR(mean_square_radius(simulation.particles()) / mean_square_radius(at_start(spec)), growth, 1e-2 * growth);
}

// r^2 = r_0^2 + 2 mu Q(<r_0) t for every radius: shells do not cross. docs/method.md, section 8.4.
TEST(Charge, ShellsOfARoundCloudMoveWithTheChargeInside) {
  const double mu = 0.3, mass = 0.04 * pi;  // of exp(-r^2/0.04)
  const Case spec =
      scene_of({"particles.per_axis=81", "time.end=1", "output.times=[1]", "effects.charge.mobility=0.3"});
  const Particles start = at_start(spec), end = particles_at_end(spec);
  double worst = 0;
  for (std::size_t j = 0; j < end.size(); ++j) {
    const double before = std::hypot(start.position[0][j], start.position[1][j]);
    const double after = std::hypot(end.position[0][j], end.position[1][j]);
    const double inside = mass * (1 - std::exp(-before * before / 0.04));
    worst = std::max(worst, std::abs(after - std::sqrt(before * before + 2 * mu * inside)));
  }
  // eps = 0.05 makes the cloud's field that of exp(-r^2/(0.04 + eps^2)): at r = 0.2 and Q = 0.13 about 2 % of a shift
  // of 0.07
  EXPECT_LT(worst, 2e-3);
}

TEST(Charge, ErrorFallsWithTheSquareOfTheCoreRadius) {
  const double mu = 0.3;
  std::vector<double> errors;
  for (const int per_axis : {41, 81, 161}) {
    const Case spec = scene_of({"particles.per_axis=" + std::to_string(per_axis), "time.end=0.5", "time.step=0.1",
                                "output.times=[0.5]", "effects.charge.mobility=0.3"});
    const Particles start = at_start(spec), end = particles_at_end(spec);
    double worst = 0;
    for (std::size_t j = 0; j < end.size(); ++j) {
      const double before = std::hypot(start.position[0][j], start.position[1][j]);
      const double inside = 0.04 * pi * (1 - std::exp(-before * before / 0.04));
      worst = std::max(worst, std::abs(std::hypot(end.position[0][j], end.position[1][j]) -
                                       std::sqrt(before * before + 2 * mu * inside * 0.5)));
    }
    errors.push_back(worst);
  }
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const double order = std::log2(errors[i - 1] / errors[i]);
    EXPECT_GT(order, 1.7);
    EXPECT_LT(order, 2.3);
  }
}

TEST(Charge, OfItsOwnDensityActsOnThatAlone) {
  // Charge in the right half only: the left half is pushed too, with no charge it stays.
  const Case none = disc({"effects.charge.mobility=0.3", "effects.charge.density=0"});
  const Particles start = at_start(none), same = particles_at_end(none);
  for (int k = 0; k < 2; ++k) EXPECT_EQ(start.position[k], same.position[k]);
  const Case weights = disc({"effects.charge.mobility=0.3"}),
             written = disc({"effects.charge.mobility=0.3", "effects.charge.density=x^2 + y^2 < 0.16 ? 1 : 0"});
  const Particles a = particles_at_end(weights), b = particles_at_end(written);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t j = 0; j < a.size(); ++j) EXPECT_NEAR(a.position[0][j], b.position[0][j], 1e-12);
}

/// The resting scene with another density.
std::string with_density(const std::string& expression) {
  CaseTables tables = resting;
  tables.density = "expression = \"" + expression + "\"";
  return case_text(tables);
}

// Charge in x > 0.5 pushes the disc, which has none: whether it sits on a trace of density or on nothing must not
// matter.
TEST(Charge, IsCarriedWhereThereIsNoDensity) {
  const auto centre = [](const std::string& beyond) {
    const Case spec =
        scene_of({"particles.per_axis=21", "effects.charge.mobility=0.1", "effects.charge.density=x > 0.5 ? 1 : 0"},
                 with_density("x^2 + y^2 < 0.04 ? 1 : " + beyond));
    const Particles particles = particles_at_end(spec);
    double moved = 0, mass = 0;
    for (std::size_t j = 0; j < particles.size(); ++j) {
      if (particles.alpha[j] < 1e-6 * 0.01) continue;  // of the disc alone: h^2 = 0.01
      moved += particles.alpha[j] * particles.position[0][j], mass += particles.alpha[j];
    }
    return moved / mass;
  };
  const double on_nothing = centre("0"), on_a_trace = centre("1e-10");
  // A charge of 1 for each of area 1.1 at distances around 0.8: E = 2 q / r or so pushes it by 0.1 E t = 0.05 and more.
  EXPECT_LT(on_nothing, -0.05);
  EXPECT_NEAR(on_nothing, on_a_trace, 1e-6);  // the tolerance of the field; another cloud, other clusters
}

TEST(Charge, ThatIsNotFiniteIsRefusedWithItsPlace) {
  const Case spec =
      scene_of({"effects.charge.mobility=0.1", "effects.charge.density=1/x^2"}, with_density("x > 0.5 ? 1 : 0"));
  try {
    at_start(spec);
    FAIL() << "an infinite charge where there is no density was not noticed";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("effects.charge.density is inf at (0, "), std::string::npos)
        << error.what();
  }
}

/// Two blobs far smaller than their distance.
Particles pair_of(double distance, double first, double second) {
  Particles particles;
  particles.position[0] = {-distance / 2, distance / 2};
  particles.position[1] = {0, 0};
  particles.alpha = {first, second};
  particles.id = {0, 1};
  return particles;
}

Particles carried(Particles particles, double end, double step) {
  const ExpressionField rest({"0", "0"}, {});
  Vortex vortex({.core_radius = 1e-3, .cell = 1, .tolerance = 1e-12});
  vortex.begin(particles, 0);
  const time::Interval interval(0, end, step);
  Stepper(rest, time::find_tableau("rk4"), 1, {}, {vortex.drift()})
      .advance(particles, interval, 0, interval.steps(), 0);
  return particles;
}

// Around their common centre at the rate (Gamma_1 + Gamma_2) / (2 pi d^2). [Lam32, 155]
TEST(Vortex, TwoEqualOnesTurnAroundEachOther) {
  const double distance = 0.5, gamma = 3, rate = 2 * gamma / (2 * pi * distance * distance);
  std::vector<double> errors;
  for (const int steps : {20, 40, 80}) {
    const double end = pi / rate;  // half a turn
    const Particles found = carried(pair_of(distance, gamma, gamma), end, end / steps);
    errors.push_back(std::hypot(found.position[0][0] - distance / 2, found.position[1][0]));
  }
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 4, 0.13);  // the next term: 0.043
  EXPECT_LT(errors.back(), 1.6e-7);
}

TEST(Vortex, TwoOppositeOnesMoveStraight) {
  const double distance = 0.5, gamma = 3, speed = gamma / (2 * pi * distance);
  const Particles found = carried(pair_of(distance, gamma, -gamma), 0.2, 0.02);
  for (const std::size_t j : {0U, 1U}) {
    EXPECT_NEAR(found.position[0][j], (j == 0 ? -0.5 : 0.5) * distance, 1e-15);  // straight and even: a rounding a step
    EXPECT_NEAR(std::abs(found.position[1][j]), 0.2 * speed, 1e-15);
  }
  EXPECT_GT(found.position[1][0] * found.position[1][1], 0);
}

// Omega = omega a b / (a + b)^2, and the shape is kept. [Lam32, 159]
TEST(Vortex, KirchhoffsEllipseTurnsAsABody) {
  const double a = 0.5, b = 0.25, omega = 4, rate = omega * a * b / ((a + b) * (a + b));
  const std::string text = case_text({.domain = "min = [-0.8, -0.8]\nmax = [0.8, 0.8]",
                                      .velocity = at_rest,
                                      .density = "expression = \"(x/0.5)^2 + (y/0.25)^2 < 1 ? 4 : 0\"",
                                      .particles = "per_axis = 81",
                                      .time = "end = 1\nstep = 0.1",
                                      .output = output_at("1")}) +
                           "[effects.vortex]\n";
  const Case spec = scene_of({}, text);
  const auto axes = [](const Particles& particles) {
    const Moments m = moments_of(particles);
    const Eigen::Matrix2d covariance{{m.xx, m.xy}, {m.xy, m.yy}};
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance);
  };
  const Particles end = particles_at_end(spec);
  const auto before = axes(at_start(spec)), after = axes(end);
  const auto direction = after.eigenvectors().col(1);
  const double angle = std::atan(direction[1] / direction[0]);
  EXPECT_NEAR(angle, rate, 0.01 * rate);  // blobs round the edge off: a part of (eps/b)^2 = 0.025
  EXPECT_NEAR(after.eigenvalues()[1] / after.eigenvalues()[0], before.eigenvalues()[1] / before.eigenvalues()[0], 4e-5);
}

// The angular velocity of a Gaussian vortex, Gamma / (2 pi r^2) (1 - exp(-r^2/(R^2 + eps^2 + 4 D t))), blobs and
// diffusion widening it alike.
TEST(Vortex, AGaussianOneTurnsItselfAndSpreads) {
  const double gamma = 0.04 * pi, eps = 0.1, D = 0.01, end = 0.5;
  const Case spec = scene_of({"effects.vortex.tolerance=1e-9", "effects.diffusion.D=0.01", "time.step=0.05"});
  const Particles start = at_start(spec), found = particles_at_end(spec);
  for (std::size_t j = 0; j < found.size(); ++j) {
    const double r = std::hypot(start.position[0][j], start.position[1][j]);
    if (r == 0 || r > 0.5) continue;
    EXPECT_NEAR(std::hypot(found.position[0][j], found.position[1][j]), r, 1.5e-10);
    double turned = 0;  // by Simpson's rule
    constexpr int n = 20;
    for (int i = 0; i <= n; ++i) {
      const double width = 0.04 + eps * eps + 4 * D * end * i / n;
      turned += (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) * gamma / (2 * pi * r * r) * (1 - std::exp(-r * r / width));
    }
    turned *= end / n / 3;
    const double angle =
        std::atan2(start.position[0][j] * found.position[1][j] - start.position[1][j] * found.position[0][j],
                   start.position[0][j] * found.position[0][j] + start.position[1][j] * found.position[1][j]);
    EXPECT_NEAR(angle, turned, 2e-9);  // quadrature of the lattice at overlap 2: 7e-10
  }
  EXPECT_NEAR(found.spread, 4 * D * end, 1e-15);
}

TEST(Drift, IsTheSameForAnyThreadsAndForChosenSteps) {
  for (const std::vector<std::string>& effect :
       {std::vector<std::string>{"effects.charge.mobility=0.3"}, {"effects.vortex.tolerance=1e-6"}}) {
    std::vector<std::string> chosen = effect;
    const Particles one = particles_at_end(disc(effect), 1), two = particles_at_end(disc(effect), 2);
    for (int k = 0; k < 2; ++k) EXPECT_EQ(one.position[k], two.position[k]);
    chosen.insert(chosen.end(), {"time.method=dopri5", "time.tolerance=1e-7"});
    const Particles adaptive = particles_at_end(disc(chosen));
    for (std::size_t j = 0; j < one.size(); ++j)
      EXPECT_NEAR(one.position[0][j], adaptive.position[0][j], 1.4e-7);  // rk4 with ten steps: 4.8e-8
  }
}

TEST(Drift, FollowsTheFlowAsWell) {
  // A uniform stream carries everything on.
  const Case at_rest = disc({"effects.charge.mobility=0.3"}),
             carried_on = disc({"effects.charge.mobility=0.3", "velocity.u=[\"0.1\", \"0\"]"});
  const Particles a = particles_at_end(at_rest), b = particles_at_end(carried_on);
  for (std::size_t j = 0; j < a.size(); ++j) EXPECT_NEAR(b.position[0][j] - a.position[0][j], 0.1, 2e-15);
}

TEST(Drift, IsNotThereUnlessACaseNamesIt) {
  const Case plain = scene_of({}), spec = disc({"effects.charge.mobility=0.3"});
  const Scene scene = make_scene(plain), charges = make_scene(spec);
  EXPECT_TRUE(Carrier(plain, scene, 1).drifts().empty());
  EXPECT_EQ(Carrier(spec, charges, 1).drifts().size(), 1U);
  Simulation charged(spec);
  const RunSummary summary = charged.run();
  ASSERT_EQ(summary.effects.size(), 2U);
  EXPECT_EQ(summary.effects[1].name, "charge");
  EXPECT_GT(summary.effects[1].seconds, 0);
  EXPECT_EQ(summary.effects[1].numbers[0].first, "evaluations");
  EXPECT_GE(summary.effects[1].numbers[0].second, 40);  // ten steps of four stages
}

// (1 - exp(-r^2/(eps^2 + 4 D t))) / r between two blobs that have spread.
TEST(Charge, OfABlobSpreadsWithIt) {
  const double r = 0.1, eps = 0.05, spreading = 0.04, mu = 0.5;
  Charge charge({.mobility = mu, .core_radius = eps, .spreading = spreading, .cell = 1, .tolerance = 1e-9});
  Particles particles;
  particles.position[0] = {0, r};
  particles.position[1] = {0, 0};
  particles.alpha = {2, 2};
  particles.id = {0, 1};
  charge.begin(particles, 0);
  for (const double t : {0.0, 0.3}) {
    std::vector<double> ux(2, 0.0), uy(2, 0.0);
    charge.drift()->add(t, particles, particles.view(), VectorsView{2, 2, {ux.data(), uy.data(), nullptr}});
    EXPECT_NEAR(ux[1], mu * 2 / r * (1 - std::exp(-r * r / (eps * eps + spreading * t))),
                5.3e-15);  // three roundings of 10
  }
}

TEST(Charge, WarnsWhereEqualChargesFallTogether) {
  const auto warning = [](const std::string& mobility) {
    Simulation simulation(disc({"effects.charge.mobility=" + mobility, "time.end=0.1", "output.times=[0.1]"}));
    return simulation.run().effects[1].warning;
  };
  EXPECT_EQ(warning("0.3"), "");
  EXPECT_NE(warning("-0.3").find("tau = 0.531"), std::string::npos) << warning("-0.3");  // 1/(2 pi 0.3)
}

TEST(Drift, RefusesStepsThatAreTooLong) {
  try {
    Simulation(disc({"effects.charge.mobility=30"})).run();
    FAIL() << "the density would fall by its own size many times in a step";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("not stable with [effects.charge]"), std::string::npos) << error.what();
  }
}

TEST(Drift, RefusesWhatItDoesNotGoWith) {
  const auto said = [](const std::vector<std::string>& overrides) {
    try {
      disc(overrides);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has(said({"effects.vortex.tolerance=1e-6", "particles.cutoff=gauss4"}), "needs particles.cutoff"));
  EXPECT_TRUE(has(
      said({"effects.vortex.tolerance=1e-6", "effects.diffusion.D=0.01", "effects.diffusion.method=particle-exchange"}),
      "does not go with [effects.diffusion]"));
  EXPECT_TRUE(
      has(said({"effects.charge.mobility=1", "effects.reaction.rate=1"}), "does not go with [effects.reaction]"));
  EXPECT_EQ(said({"effects.charge.mobility=1", "effects.reaction.rate=1", "effects.charge.density=1"}), "");
  EXPECT_TRUE(has(said({"effects.charge.mobility=1", "effects.charge.density=1", "effects.remesh.every=1"}),
                  "does not go with [effects.remesh]"));
  EXPECT_TRUE(has(said({"effects.charge.tolerance=1e-6"}), "mobility"));
  EXPECT_TRUE(
      has(said({"effects.vortex.tolerance=1e-6", "reference.kind=characteristics"}), "cannot be traced along paths"));
}

}  // namespace
}  // namespace gaussdrift
