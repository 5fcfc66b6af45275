// Periodic and closed edges of the domain, by images.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "effect/apart.hpp"
#include "effect/scene.hpp"
#include "field/folded/folded.hpp"
#include "field/gridded/grid_data.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "particle/images.hpp"
#include "sim/borders/edges.hpp"
#include "sim/make_fields.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {
namespace {

constexpr double pi = std::numbers::pi;

// --- places

TEST(Folding, KeepsWhatIsInTheBoxAndBringsBackWhatIsNot) {
  const Folding folding({FoldedAxis{.periodic = true, .low = -1, .high = 2},
                         FoldedAxis{.mirror_low = true, .mirror_high = true, .low = 0, .high = 1},
                         FoldedAxis{.mirror_high = true, .low = 0, .high = 1}});
  EXPECT_EQ(folding.fold(0, 0.3).x, 0.3);
  EXPECT_EQ(folding.fold(0, 2).x, -1) << "both ends are one place";
  EXPECT_NEAR(folding.fold(0, 2.5).x, -0.5, 1e-15);
  EXPECT_NEAR(folding.fold(0, -1.25).x, 1.75, 1e-15);
  EXPECT_NEAR(folding.fold(0, -1.25 - 30).x, 1.75, 1e-14);
  EXPECT_EQ(folding.fold(0, -5).sign, 1);
  for (const auto& [x, inside, sign] : {std::tuple{0.25, 0.25, 1.0},
                                        {1.0, 1.0, 1.0},
                                        {1.25, 0.75, -1.0},
                                        {-0.25, 0.25, -1.0},
                                        {2.25, 0.25, 1.0},
                                        {-1.75, 0.25, 1.0},
                                        {7.25, 0.75, -1.0}}) {
    EXPECT_EQ(folding.fold(1, x).x, inside) << x;
    EXPECT_EQ(folding.fold(1, x).sign, sign) << x;
  }
  EXPECT_EQ(folding.fold(2, 1.5).x, 0.5);
  EXPECT_EQ(folding.fold(2, -3).x, -3) << "nothing is said of that end";
  EXPECT_TRUE(std::isnan(folding.fold(0, NAN).x));
  EXPECT_EQ(Folding().fold(1, 77).x, 77);
}

// --- fields

TEST(FoldedVelocity, IsMirroredWithItsGradientInEveryCopy) {
  const Case spec = scene_of({edges("\"periodic\", \"closed\""), "velocity.u=[\"sin(pi*x)*(2+y)\", \"(1-y^2)*(x+3)\"]",
                              "particles.per_axis=41"});
  const auto velocity = make_velocity(spec);
  const auto value = [&](Vector x) {
    Vector u{};
    velocity->add(0, {2, 1, {&x[0], &x[1], nullptr}}, {2, 1, {&u[0], &u[1], nullptr}});
    return u;
  };
  const auto in_box = [](double x, double y) { return Vector{std::sin(pi * x) * (2 + y), (1 - y * y) * (x + 3)}; };
  EXPECT_NEAR(value({0.3, 1.4, 0})[0], in_box(0.3, 0.6)[0], 1e-14);
  EXPECT_NEAR(value({0.3, 1.4, 0})[1], -in_box(0.3, 0.6)[1], 1e-14) << "mirrored";
  EXPECT_NEAR(value({2.3, -1.4, 0})[1], -in_box(0.3, -0.6)[1], 1e-14);
  EXPECT_NEAR(value({-3.7, 4.6, 0})[1], in_box(0.3, 0.6)[1], 1e-13);
  for (const Vector& x : {Vector{0.3, 0.2, 0}, Vector{0.3, 1.4, 0}, Vector{-1.6, -1.3, 0}, Vector{2.5, 2.6, 0}}) {
    std::array<double, 4> slopes{};
    double divergence = 0;
    const PointsView at{2, 1, {&x[0], &x[1], nullptr}};
    GradientsView gradient{2, 1, {}};
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 0; i < 2; ++i) gradient.slope[k][i] = &slopes[2 * k + i];
    velocity->add_gradient(0, at, gradient);
    velocity->add_divergence(0, at, &divergence);
    constexpr double h = 1e-5;
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 0; i < 2; ++i) {
        Vector above = x, below = x;
        above[i] += h, below[i] -= h;
        EXPECT_NEAR(slopes[2 * k + i], (value(above)[k] - value(below)[k]) / (2 * h), 1e-8) << x[0] << ", " << x[1];
      }
    EXPECT_NEAR(divergence, slopes[0] + slopes[3], 1e-13);
  }
}

TEST(FoldedVelocity, SaysWhereItDoesNotFitTheEdges) {
  const auto misfits = [](const std::string& u, const std::string& of_edges) {
    return make_scene(scene_of({edges(of_edges), "velocity.u=[" + u + "]", "particles.per_axis=41"})).misfits;
  };
  EXPECT_TRUE(misfits("\"sin(pi*x)\", \"1-y^2\"", "\"periodic\", \"closed\"").empty());
  const auto jump = misfits("\"1+x\", \"0\"", "\"periodic\", \"open\"");
  ASSERT_EQ(jump.size(), 1u);
  EXPECT_NE(jump[0].find("not periodic along x"), std::string::npos) << jump[0];
  EXPECT_NE(jump[0].find("differs by 2"), std::string::npos) << jump[0];
  const auto through = misfits("\"0\", \"t\"", "\"periodic\", [\"closed\", \"unbounded\"]");
  ASSERT_EQ(through.size(), 1u);
  EXPECT_NE(through[0].find("its component along y is 0.5"), std::string::npos) << through[0];
}

/// u = 1 + cos(2 pi x)/2 along x on [0, last] x [0, 1], at points 1/16 apart.
FileVelocitySpec wave_to(double last, const std::string& outside) {
  auto data = std::make_shared<GridData>();
  data->name = "u of wave.vti";
  data->components = 2;
  data->times = {0};
  for (int i = 0; i <= std::lround(16 * last); ++i) data->axis[0].push_back(i / 16.0);
  data->axis[1] = {0, 1};
  data->values.emplace_back();
  for (std::size_t p = 0; p < data->points(); ++p) {
    const double x = data->axis[0][p % data->axis[0].size()];
    data->values[0].insert(data->values[0].end(), {1 + std::cos(2 * pi * x) / 2, 0.0});
  }
  FileVelocitySpec spec;
  spec.interpolation = spec.time_interpolation = "linear";
  spec.outside = outside;
  spec.missing = "error";
  spec.data = data;
  return spec;
}

/// Carried by these data around a periodic axis.
Case carried_by(const FileVelocitySpec& data) {
  CaseTables tables = resting;
  tables.domain = unit_square;
  tables.density = shape_of("gaussian", "0.7, 0.5", "0.05");
  Case spec = scene_of({edges("\"periodic\", \"closed\""), "time.end=1.2", "time.step=0.01"}, case_text(tables));
  spec.velocity = {data};
  return spec;
}

TEST(FoldedVelocity, OfDataThatReachBothEndsGoesAround) {
  Simulation simulation(carried_by(wave_to(1, "error")), 1);
  const RunSummary summary = simulation.run();
  EXPECT_TRUE(summary.warnings.empty());
  EXPECT_EQ(simulation.particles().size(), summary.particles);
}

TEST(FoldedVelocity, OfDataWithoutTheColumnThatIsMetAgainSaysSo) {
  const std::string words =
      message_of<NumericalError>([] { Simulation(carried_by(wave_to(15 / 16.0, "error")), 1).run(); });
  EXPECT_NE(words.find("outside of u of wave.vti"), std::string::npos) << words;
  const RunSummary clamped = Simulation(carried_by(wave_to(15 / 16.0, "clamp")), 1).run();
  ASSERT_FALSE(clamped.warnings.empty());
  EXPECT_NE(clamped.warnings[0].find("not periodic along x"), std::string::npos) << clamped.warnings[0];
}

// --- paths

const std::vector<std::string> meandering = {
    "velocity.u=[\"1.3 + 0.5*sin(pi*(x-t))*cos(pi*y)\", \"-0.5*cos(pi*(x-t))*sin(pi*y)\"]", "time.end=2.5",
    "time.method=rk4", "particles.per_axis=41", "particles.threshold=0"};

// The formula is periodic along x and mirrored at y = -1 and 1 by itself, so paths in all of space are the unfolded ones.
TEST(FoldedPaths, AreThoseInAllOfSpaceFolded) {
  const Case folded = scene_of(with(meandering, {edges("\"periodic\", \"closed\""), "time.step=0.05"}));
  Case unbounded = folded;
  unbounded.domain.edges = {};
  // The same start: the lattice of the folded domain.
  Simulation one(folded, 1), other(folded, 2);
  one.run(), other.run();
  EXPECT_EQ(apart(one.particles(), other.particles()), 0) << "threads";
  const Scene scene = make_scene(folded);
  Particles expected = seed_scene(scene, 1);
  const auto velocity = make_velocity(unbounded);
  const auto rate = [&](double t, const std::vector<double>& x, const std::vector<double>& y) {
    std::vector<double> u(2 * x.size(), 0.0);
    velocity->add(t, {2, x.size(), {x.data(), y.data(), nullptr}},
                  {2, x.size(), {u.data(), u.data() + x.size(), nullptr}});
    return u;
  };
  const std::size_t n = expected.size();
  for (int step = 0; step < 50; ++step) {
    const double t = 0.05 * step, h = 0.05;
    const std::vector<double> x0 = expected.position[0], y0 = expected.position[1];
    const auto moved = [&](const std::vector<double>& k, double by) {
      std::pair<std::vector<double>, std::vector<double>> at{x0, y0};
      for (std::size_t j = 0; j < n; ++j) at.first[j] += by * k[j], at.second[j] += by * k[n + j];
      return at;
    };
    const auto k1 = rate(t, x0, y0);
    const auto [x1, y1] = moved(k1, h / 2);
    const auto k2 = rate(t + h / 2, x1, y1);
    const auto [x2, y2] = moved(k2, h / 2);
    const auto k3 = rate(t + h / 2, x2, y2);
    const auto [x3, y3] = moved(k3, h);
    const auto k4 = rate(t + h, x3, y3);
    for (std::size_t j = 0; j < n; ++j) {
      expected.position[0][j] = x0[j] + h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
      expected.position[1][j] = y0[j] + h / 6 * (k1[n + j] + 2 * k2[n + j] + 2 * k3[n + j] + k4[n + j]);
    }
  }
  std::size_t across = 0;
  for (const double x : expected.position[0]) across += x > 1;
  EXPECT_GT(across, n / 2) << "many have crossed";
  fold_positions(folding_of(folded.domain), expected);
  EXPECT_LT(apart(one.particles(), expected), 1e-12);
}

TEST(FoldedPaths, KeepTheOrderOfTheMethod) {
  const auto at_end = [](const char* step) {
    return particles_at_end(
        scene_of(with(meandering, {edges("\"periodic\", \"closed\""), std::string("time.step=") + step})), 1);
  };
  const Particles fine = at_end("0.00625");
  const double coarse = apart(at_end("0.1"), fine), half = apart(at_end("0.05"), fine);
  EXPECT_NEAR(std::log2(coarse / half), 4, 0.35) << coarse << ", " << half;
}

TEST(FoldedPaths, StayBesideAWallThatTheVelocityPresses) {
  // u = 1 towards a closed edge: what arrives stays there to one step.
  const Particles particles =
      particles_at_end(scene_of({edges("[\"open\", \"closed\"], \"closed\""), "velocity.u=[\"1\", \"0\"]", "time.end=3",
                                 "time.step=0.05", "particles.per_axis=41"}));
  EXPECT_GT(particles.size(), 1000u);
  for (const double x : particles.position[0]) {
    EXPECT_LE(x, 1);
    EXPECT_GE(x, 1 - 0.051);
  }
}

TEST(FoldedPaths, MeetTheReactionOfTheDomainAgain) {
  // Once around a periodic axis every weight has met the rate x^2 from -1 to 1; without folding it would grow on and on.
  const RunSummary summary = Simulation(scene_of({edges("\"periodic\", \"open\""), "velocity.u=[\"1\", \"0\"]",
                                                  "time.end=2", "time.step=0.01", "effects.reaction.rate=x^2"}))
                                 .run();
  EXPECT_NEAR(summary.frames.back().second.mass / summary.frames.front().second.mass, std::exp(-2.0 / 3), 1e-5);
}

TEST(FoldedPaths, NeighboursAcrossAPeriodicEdgeAreNear) {
  const RunSummary summary = Simulation(scene_of({edges("\"periodic\", \"periodic\""), "velocity.u=[\"0.7\", \"0.4\"]",
                                                  "time.end=1", "time.step=0.25"}))
                                 .run();
  EXPECT_NEAR(summary.frames.back().second.stretch, 1, 1e-9);
}

// --- sums

/// zeta of gauss2, without any cut: exp(-r^2/eps^2)/(pi^(d/2) eps^d), summed over images in so many periods to each side.
double sum_over_images(const Particles& particles, const Domain& domain, double eps, const Vector& x) {
  constexpr int periods = 6;
  std::array<std::vector<std::pair<double, double>>, 3> copies;  // offset, sign
  const Folding folding = folding_of(domain);
  for (int k = 0; k < 3; ++k) {
    auto& of_axis = copies[static_cast<std::size_t>(k)];
    const FoldedAxis& axis = folding.axis(k);
    const double length = axis.high - axis.low;
    if (axis.periodic) {
      for (int m = -periods; m <= periods; ++m) of_axis.emplace_back(m * length, 1);
    } else if (axis.mirror_low && axis.mirror_high) {
      for (int m = -periods; m <= periods; ++m)
        of_axis.emplace_back(2 * m * length, 1), of_axis.emplace_back(2 * axis.low + 2 * m * length, -1);
    } else {
      of_axis.emplace_back(0, 1);
      if (axis.mirror_low) of_axis.emplace_back(2 * axis.low, -1);
      if (axis.mirror_high) of_axis.emplace_back(2 * axis.high, -1);
    }
  }
  double sum = 0;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    double blob = particles.alpha[j];
    for (std::size_t k = 0; k < static_cast<std::size_t>(particles.dimension); ++k) {
      double along = 0;
      for (const auto& [offset, sign] : copies[k])
        along += std::exp(-std::pow((x[k] - offset - sign * particles.position[k][j]) / eps, 2));
      blob *= along / (std::sqrt(pi) * eps);
    }
    sum += blob;
  }
  return sum;
}

void expect_sum_over_images(const Case& spec, double tolerance) {
  const Scene scene = make_scene(spec);
  Simulation simulation(spec, 1);
  DensityGrid density;
  simulation.observe("test", [&](const Frame& frame) { density = *frame.density; });
  simulation.run();
  const Lattice& lattice = density.lattice;
  double largest = 0, worst = 0;
  for (const double rho : density.rho) largest = std::max(largest, std::abs(rho));
  for (std::size_t i = 0; i < lattice.size(); i += 7) {
    const Vector x{lattice.coordinate(0, i % lattice.points[0]),
                   lattice.coordinate(1, i / lattice.points[0] % lattice.points[1]),
                   lattice.coordinate(2, i / lattice.points[0] / lattice.points[1])};
    const double exact = sum_over_images(simulation.particles(), spec.domain, scene.core_radius, x);
    worst = std::max(worst, std::abs(density.rho[i] - exact));
  }
  EXPECT_LT(worst, tolerance * largest) << spec.domain.dimension;
}

TEST(FoldedDensity, IsTheSumOverImagesToTheTolerance) {
  for (const char* list : {"\"periodic\", \"periodic\"", "\"closed\", \"periodic\"", "\"closed\", \"closed\"",
                           "[\"closed\", \"open\"], [\"unbounded\", \"closed\"]"})
    for (const char* tolerance : {"1e-5", "1e-10"})
      expect_sum_over_images(
          scene_of({edges(list), "density.center=[0.93, -0.9]", "velocity.u=[\"0.2\", \"-0.1\"]",
                    std::string("evaluate.tolerance=") + tolerance, "particles.per_axis=41", "time.end=0.1"}),
          std::stod(tolerance));
}

TEST(FoldedDensity, TakesAsManyPeriodsAsBlobsReach) {
  // eps = 0.8 in a box of 2: blobs are felt for two and a half lengths of the box to each side.
  expect_sum_over_images(scene_of({edges("\"periodic\", \"closed\""), "particles.per_axis=11", "particles.overlap=4",
                                   "evaluate.tolerance=1e-10", "density.center=[0.9, 0.5]"}),
                         1e-10);
  // Too many of them are refused with their numbers.
  const std::string words = message_of<InputError>([] {
    Simulation(scene_of({edges("\"periodic\", \"closed\""), "particles.per_axis=11", "particles.overlap=20"})).run();
  });
  EXPECT_NE(words.find("more than 8 times the length 2"), std::string::npos) << words;
  EXPECT_NE(words.find("particles.per_axis"), std::string::npos) << words;
}

const CaseTables ball{.domain = cube,
                      .velocity = velocity_of({"0.3", "0", "0.1"}),
                      .density = shape_of("gaussian", "0.9, -0.9, 0.8", "0.4"),
                      .particles = "per_axis = 17",
                      .evaluate = "per_axis = 13\ntolerance = 1e-9"};

TEST(FoldedDensity, IsTheSumOverImagesInSpaceToo) {
  expect_sum_over_images(scene_of({edges("\"periodic\", \"closed\", [\"closed\", \"open\"]")}, case_text(ball)), 1e-9);
}

/// The trapezoidal rule over the grid, whose points on two faces are half as much each: right to the last digits for what
/// is periodic or even at its ends.
double mass_on_grid(const DensityGrid& density) {
  const Lattice& lattice = density.lattice;
  double sum = 0;
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    double weight = std::pow(lattice.spacing, lattice.dimension);
    std::size_t rest = i;
    for (std::size_t k = 0; k < static_cast<std::size_t>(lattice.dimension); ++k) {
      const std::size_t index = rest % lattice.points[k];
      rest /= lattice.points[k];
      if (index == 0 || index + 1 == lattice.points[k]) weight /= 2;
    }
    sum += weight * density.rho[i];
  }
  return sum;
}

TEST(FoldedDensity, KeepsItsMassOnTheGrid) {
  for (const char* list : {"\"periodic\", \"closed\"", "\"closed\", \"closed\""}) {
    const bool closed = std::string(list) == "\"closed\", \"closed\"";
    Simulation simulation(scene_of(
        {edges(list), "density.center=[0.7, 0.9]",
         closed ? "velocity.u=[\"sin(pi*x)*cos(pi*y)\", \"-cos(pi*x)*sin(pi*y)\"]" : "velocity.u=[\"1-y^2\", \"0\"]",
         "time.end=2", "output.frames=5", "evaluate.tolerance=1e-10", "evaluate.per_axis=65"}));
    std::vector<double> on_grid, carried;
    simulation.observe("test", [&](const Frame& frame) {
      on_grid.push_back(mass_on_grid(*frame.density)), carried.push_back(frame.numbers.mass);
      EXPECT_NEAR(*frame.numbers.inside, frame.numbers.mass, 1e-15);
    });
    simulation.run();
    ASSERT_EQ(on_grid.size(), 5u);
    for (std::size_t i = 0; i < on_grid.size(); ++i)
      EXPECT_NEAR(on_grid[i], carried[i], 1e-9 * carried[i]) << list << i;
    EXPECT_EQ(carried.front(), carried.back());
  }
}

TEST(FoldedDensity, OfOneIsOneUpToTheFaces) {
  // Particles and images are one lattice: a constant stays constant to what blobs ripple, here exp(-(4 pi)^2 / 4) and less.
  Simulation simulation(scene_of({edges("\"periodic\", [\"closed\", \"closed\"]"), "density.expression=1",
                                  "particles.overlap=3", "particles.per_axis=21", "velocity.u=[\"0.3\", \"0\"]"},
                                 [] {
                                   CaseTables tables = resting;
                                   tables.density = "expression = \"1\"";
                                   return case_text(tables);
                                 }()));
  simulation.observe("test", [&](const Frame& frame) {
    for (const double rho : frame.density->rho) ASSERT_NEAR(rho, 1, 1e-8);
  });
  simulation.run();
}

TEST(FoldedDensity, DiffusesWithoutFluxThroughWalls) {
  CaseTables tables = resting;
  tables.density = "expression = \"1 + 0.5*cos(pi*x)*cos(pi*y)\"";
  tables.reference = "kind = \"exact\"\nrho = \"1 + 0.5*cos(pi*(x-0.3*t))*cos(pi*y)*exp(-2*pi^2*0.05*t)\"";
  const RunSummary summary =
      Simulation(scene_of({edges("\"periodic\", \"closed\""), "velocity.u=[\"0.3\", \"0\"]", "effects.diffusion.D=0.05",
                           "particles.per_axis=81", "particles.cutoff=gauss4"},
                          case_text(tables)))
          .run();
  EXPECT_LT(summary.frames.back().second.error->linf, 2e-4);
}

// --- the exact density

TEST(ExactDensity, FollowsPathsThroughFoldedEdges) {
  CaseTables tables = resting;
  tables.density = "expression = \"exp(-8*(1-cos(pi*(x-0.4))) - (y-0.9)^2)\"";
  tables.reference = "kind = \"characteristics\"";
  const Case spec = scene_of(
      {edges("\"periodic\", \"closed\""), "velocity.u=[\"1-y^2\", \"0\"]", "time.end=3", "evaluate.per_axis=21"},
      case_text(tables));
  Simulation simulation(spec);
  double worst = 0;
  simulation.observe("test", [&](const Frame& frame) {
    const Lattice& lattice = frame.density->lattice;
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      const double x = lattice.coordinate(0, i % lattice.points[0]), y = lattice.coordinate(1, i / lattice.points[0]);
      const double foot = x - (1 - y * y) * frame.time;
      worst = std::max(
          worst, std::abs((*frame.exact)[i] - std::exp(-8 * (1 - std::cos(pi * (foot - 0.4))) - std::pow(y - 0.9, 2))));
    }
  });
  simulation.run();
  EXPECT_LT(worst, 1e-10);
}

TEST(ExactDensity, IsNothingWhereThePathComesFromOutside) {
  CaseTables tables = resting;
  tables.density = "expression = \"2 + x\"";
  tables.reference = "kind = \"characteristics\"";
  const Case spec = scene_of({edges("\"open\", \"open\""), "velocity.u=[\"-y\", \"x\"]", "time.end=1.2",
                              "output.frames=4", "evaluate.per_axis=41"},
                             case_text(tables));
  Simulation simulation(spec);
  std::size_t outside = 0, back_inside = 0;
  simulation.observe("test", [&](const Frame& frame) {
    const Lattice& lattice = frame.density->lattice;
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      const double x = lattice.coordinate(0, i % lattice.points[0]), y = lattice.coordinate(1, i / lattice.points[0]);
      const double radius = std::hypot(x, y), angle = std::atan2(y, x);
      double farthest = 0;  // of the way back
      for (int s = 0; s <= 4000; ++s) {
        const double at = angle - frame.time * s / 4000;
        farthest = std::max({farthest, std::abs(radius * std::cos(at)), std::abs(radius * std::sin(at))});
      }
      if (std::abs(farthest - 1) < 1e-6) continue;  // which side of the face is for rounding to say
      const double foot = radius * std::cos(angle - frame.time);
      EXPECT_NEAR((*frame.exact)[i], farthest > 1 ? 0 : 2 + foot, 1e-10) << x << ", " << y << ", " << frame.time;
      outside += farthest > 1;
      back_inside += farthest > 1 && std::abs(foot) < 1 && std::abs(radius * std::sin(angle - frame.time)) < 1;
    }
  });
  simulation.run();
  EXPECT_GT(outside, 100u);
  EXPECT_GT(back_inside, 20u) << "some left the domain and came back on the way";
}

}  // namespace
}  // namespace gaussdrift
