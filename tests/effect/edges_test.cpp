// Edges of the domain: periodic and closed ones by images, open ones by counting what leaves.
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

#include "effect/scene.hpp"
#include "field/folded/folded.hpp"
#include "field/gridded/grid_data.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "particle/images.hpp"
#include "sim/edges.hpp"
#include "sim/make_fields.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {
namespace {

constexpr double pi = std::numbers::pi;

std::string edges(const std::string& list) { return "domain.edges=[" + list + "]"; }

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

/// Largest distance of particles, by id; both runs have the same ones.
double apart(const Particles& a, const Particles& b) {
  EXPECT_EQ(a.id, b.id);
  double largest = 0;
  for (int k = 0; k < a.dimension; ++k)
    for (std::size_t j = 0; j < a.size(); ++j) {
      const auto axis = static_cast<std::size_t>(k);
      largest = std::max(largest, std::abs(a.position[axis][j] - b.position[axis][j]));
    }
  return largest;
}

const std::vector<std::string> meandering = {
    "velocity.u=[\"1.3 + 0.5*sin(pi*(x-t))*cos(pi*y)\", \"-0.5*cos(pi*(x-t))*sin(pi*y)\"]", "time.end=2.5",
    "time.method=rk4", "particles.per_axis=41", "particles.threshold=0"};

std::vector<std::string> with(std::vector<std::string> some, const std::vector<std::string>& more) {
  some.insert(some.end(), more.begin(), more.end());
  return some;
}

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

// --- what leaves

const std::vector<std::string> drifting = {edges("\"open\", \"open\""),
                                           "velocity.u=[\"1\", \"-0.5\"]",
                                           "time.end=1",
                                           "time.step=0.05",
                                           "particles.threshold=0",
                                           "output.frames=5"};

TEST(OpenEdges, CountWhatLeavesByEachFace) {
  const Case spec = scene_of(with(drifting, {"particles.per_axis=40"}));
  const Particles start = seed_scene(make_scene(spec), 1);
  Simulation simulation(spec, 1), threads(spec, 3);
  const RunSummary summary = simulation.run();
  EXPECT_EQ(summary.particles, start.size());
  for (const auto& [time, numbers] : summary.frames) {
    ASSERT_EQ(numbers.left.size(), 4u);
    double inside = 0;
    std::array<std::uint64_t, 4> count{};
    std::array<double, 4> mass{};
    for (std::size_t j = 0; j < start.size(); ++j) {
      // The step at whose end it is beyond; both at once: the farther one.
      int face = -1;
      for (int step = 1; step <= 20 && face < 0 && 0.05 * step < time + 1e-9; ++step) {
        const double over = start.position[0][j] + 0.05 * step - 1, under = -1 - (start.position[1][j] - 0.025 * step);
        if (over > 1e-8 || under > 1e-8) face = over > under ? 1 : 2;
      }
      if (face < 0) {
        inside += start.alpha[j];
        continue;
      }
      ++count[static_cast<std::size_t>(face)];
      mass[static_cast<std::size_t>(face)] += start.alpha[j];
    }
    const char* names[] = {"x_min", "x_max", "y_min", "y_max"};
    for (std::size_t f = 0; f < 4; ++f) {
      EXPECT_EQ(numbers.left[f].reason, names[f]);
      EXPECT_EQ(numbers.left[f].particles, count[f]) << names[f] << " at " << time;
      EXPECT_NEAR(numbers.left[f].mass, mass[f], 1e-16);
    }
    EXPECT_NEAR(*numbers.inside, inside, 1e-16);
    EXPECT_EQ(*numbers.inside, numbers.mass);
    EXPECT_EQ(numbers.outside, 0);
    EXPECT_NEAR(numbers.mass + numbers.left[1].mass + numbers.left[2].mass, summary.frames.front().second.mass, 1e-15);
  }
  EXPECT_GT(summary.frames.back().second.left[1].particles, 500u);
  EXPECT_GT(summary.frames.back().second.left[2].particles, 200u);
  const RunSummary other = threads.run();
  for (std::size_t f = 0; f < 4; ++f)
    EXPECT_EQ(other.frames.back().second.left[f].mass, summary.frames.back().second.left[f].mass);
  EXPECT_EQ(apart(simulation.particles(), threads.particles()), 0);
}

TEST(OpenEdges, CountTheWeightThatIsLeftOfADecayingParticle) {
  const auto left = [](const char* rate) {
    const RunSummary summary =
        Simulation(scene_of(with(drifting, {"particles.per_axis=41", std::string("effects.reaction.rate=") + rate,
                                            "velocity.u=[\"1\", \"0\"]", "density.center=[0.6, 0]",
                                            "density.radius=0.02", "particles.threshold=1e-12"})))
            .run();
    return summary.frames.back().second.left[1].mass / summary.frames.front().second.mass;
  };
  EXPECT_NEAR(left("0"), 1, 1e-12);
  // A particle that starts at x = 0.6 is beyond x = 1 at t = 0.45 (0.4 is on the face).
  // Its neighbours, with exp(-(0.05/0.02)^2) of its weight, leave a step before and after.
  const double light = std::exp(-6.25);
  EXPECT_NEAR(left("2"), std::exp(-2 * 0.45) * (1 + 2 * light * std::cosh(0.1)) / (1 + 2 * light), 1e-9);
}

TEST(OpenEdges, AllMayLeave) {
  CaseTables tables = resting;
  tables.reference = "kind = \"characteristics\"";
  Simulation simulation(scene_of(with(drifting, {"time.end=5", "velocity.u=[\"1\", \"0\"]"}), case_text(tables)));
  const RunSummary summary = simulation.run();
  EXPECT_EQ(simulation.particles().size(), 0u);
  EXPECT_EQ(summary.frames.back().second.mass, 0);
  EXPECT_EQ(summary.frames.back().second.maximum, 0);
  EXPECT_NEAR(summary.frames.back().second.left[1].mass, summary.frames.front().second.mass, 1e-15);
  EXPECT_NE(summary.frames.back().second.no_norms.find("all of the mass has left"), std::string::npos);
}

TEST(OpenEdges, ChargesThatLeavePushNoMore) {
  // The effect keeps charges of its own by particle: they go with the particles.
  const std::vector<std::string> charged = {edges("\"open\", \"open\""),
                                            "effects.charge.mobility=4",
                                            "effects.charge.density=exp(-x^2)",
                                            "time.end=1",
                                            "time.step=0.02",
                                            "density.radius=0.5",
                                            "particles.per_axis=21",
                                            "particles.threshold=1e-3"};
  Simulation once(scene_of(charged), 1);
  const RunSummary summary = once.run();
  EXPECT_LT(once.particles().size(), summary.particles);
  Simulation half(scene_of(charged), 1), rest(scene_of(charged), 1);
  half.on_progress([](const Progress& progress) { return progress.time < 0.7; });
  half.run();
  ASSERT_LT(half.particles().size(), summary.particles);
  rest.restore(half.particles(), half.state());
  rest.run();
  EXPECT_EQ(apart(once.particles(), rest.particles()), 0);
}

TEST(OpenEdges, TakeTheKnownPartOfACloudInAShear) {
  // The checks of the case are that part, from the normal distribution.
  const Case spec =
      gaussdrift::read_case(SOURCE_DIR "/cases/outflow.toml", {"output.images=[]", "evaluate.per_axis=11"}).spec;
  const RunSummary summary = Simulation(spec).run();
  ASSERT_EQ(summary.checks.size(), 4u);
  for (const CheckResult& check : summary.checks) EXPECT_TRUE(check.passed) << check.text;
  EXPECT_EQ(summary.frames.back().second.left[0].particles, 0u) << "nothing leaves where the wind comes in";
}

TEST(OpenEdges, AreCheckedByWhatLeft) {
  const std::string check =
      "\n[[check]]\nwhat = \"left\"\nby = \"x_max\"\nmin = 0.2\nmax = 0.9\nat = 1\n"
      "[[check]]\nwhat = \"left\"\nby = \"x_min\"\nmax = 0\n"
      "[[check]]\nwhat = \"inside\"\nmin = 0.99\n";
  const RunSummary summary = Simulation(scene_of(drifting, resting_gaussian + check)).run();
  ASSERT_EQ(summary.checks.size(), 3u);
  const double left = summary.frames.back().second.left[1].mass / summary.frames.front().second.mass;
  EXPECT_EQ(summary.checks[0].value, left);
  EXPECT_EQ(summary.checks[0].passed, left >= 0.2 && left <= 0.9);
  EXPECT_NE(summary.checks[0].text.find("left by x_max = "), std::string::npos) << summary.checks[0].text;
  EXPECT_TRUE(summary.checks[1].passed);
  EXPECT_FALSE(summary.checks[2].passed);
}

}  // namespace
}  // namespace gaussdrift
