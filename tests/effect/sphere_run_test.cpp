// Runs on longitudes and latitudes: exact paths of a rotation about a tilted axis, densities per area, the way across 180
// degrees, the same bits for threads, stops and ranks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/sphere.hpp"
#include "effect/scene.hpp"
#include "field/named/named_fields.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"

namespace gaussdrift {
namespace {

const std::string round_the_earth = "coordinates = \"longitude latitude\"\nmin = [-180, -75]\nmax = [180, 75]";

/// A bell that goes round an axis 30 degrees from the poles, and crosses 180 degrees.
CaseTables turning() {
  return {.params = "day = 86400",
          .domain = round_the_earth,
          .velocity = "field = \"sphere_rotation\"\npole = [180, 60]\nrate = \"2*pi/(12*day)\"",
          .density = shape_of("cosine_bell", "120, 40", "2.1e6"),
          .particles = "per_axis = 121\ncutoff = \"gauss4\"",
          .time = "end = \"4*day\"\nstep = 7200",
          .evaluate = "per_axis = 73",
          .output = output_at("0, \"4*day\"")};
}

Case spec_of(const CaseTables& tables, const std::vector<std::string>& overrides = {}) {
  return parse_case(case_text(tables), "scene.toml", overrides).spec;
}

Vector at_lattice(const Lattice& lattice, std::int64_t id) {
  const auto number = static_cast<std::size_t>(id);
  return {lattice.coordinate(0, number % lattice.points[0]), lattice.coordinate(1, number / lattice.points[0]), 0};
}

struct Ended {
  RunSummary summary;
  Particles particles;
  std::vector<double> rho;
  Lattice lattice;
};

Ended ended(const Case& spec, int threads = 1) {
  Ended end;
  Simulation simulation(spec, threads);
  simulation.observe("test", [&](const Frame& frame) {
    end.rho = frame.density->rho;
    end.lattice = frame.density->lattice;
  });
  end.summary = simulation.run();
  end.particles = simulation.particles();
  return end;
}

TEST(SphereRun, CarriesParticlesAsTheSphereTurns) {
  const Case spec = spec_of(turning());
  const Ended end = ended(spec);
  const auto field = make_named_field("sphere_rotation", {2, spec.domain.min, spec.domain.max},
                                      {{"pole", {180, 60}}, {"rate", {2 * std::numbers::pi / (12 * 86400)}}});
  Lattice seeding = make_lattice(2, {-180, -75, 0}, {180, 75, 0}, 121);
  seeding.points[0] = 120;  // the last column would be the first
  double worst = 0, most = -1000, least = 1000;
  for (std::size_t j = 0; j < end.particles.size(); ++j) {
    const Vector start = at_lattice(seeding, end.particles.id[j]);
    const Vector exact = *field->flow(0, 4 * 86400, start);
    worst = std::max(worst, angle_between(exact, end.particles.view().at(j)));
    most = std::max(most, end.particles.position[0][j]), least = std::min(least, end.particles.position[0][j]);
  }
  EXPECT_LT(worst, 2e-6);  // of rk4 with 144 steps a turn, at latitudes up to 60 degrees: measured 6e-7
  EXPECT_GT(end.particles.size(), 100u);
  EXPECT_GE(least, -180);
  EXPECT_LT(most, 180);
}

TEST(SphereRun, TellsDensityMassAndCentreOfTheSphere) {
  const Ended end = ended(spec_of(turning()));
  const FrameNumbers &first = end.summary.frames.front().second, &last = end.summary.frames.back().second;
  // The cap's integral: 2 pi R^2 int sin(a) (1 + cos(pi a/a0))/2 da, by Simpson's rule.
  double exact = 0;
  const double a0 = 2.1e6 / earth_radius;
  constexpr int n = 1000;
  for (int i = 0; i <= n; ++i) {
    const double a = a0 * i / n;
    exact += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * std::sin(a) * (1 + std::cos(std::numbers::pi * i / n)) / 2;
  }
  exact *= 2 * std::numbers::pi * earth_radius * earth_radius * a0 / n / 3;
  EXPECT_NEAR(first.mass / exact, 1, 1e-4);  // the lattice, of 7 points a radius
  EXPECT_EQ(first.mass, last.mass);
  // On the grid: the sum of rho times areas, the last column being the first one again.
  double mass = 0;
  for (std::size_t i = 0; i < end.rho.size(); ++i)
    if (i % end.lattice.points[0] + 1 < end.lattice.points[0])
      mass += end.rho[i] * end.lattice.cell(end.lattice.coordinate(1, i / end.lattice.points[0]));
  EXPECT_NEAR(mass / last.mass, 1, 1e-4);  // a grid of 5 degrees
  // The centre goes along a circle about the pole.
  const auto field = make_named_field("sphere_rotation", {2, {}, {}},
                                      {{"pole", {180, 60}}, {"rate", {2 * std::numbers::pi / (12 * 86400)}}});
  const Vector wanted = *field->flow(0, 4 * 86400, first.centroid);
  EXPECT_LT(angle_between(wanted, last.centroid), 1e-6);
  EXPECT_LT(angle_between(first.centroid, {120, 40, 0}), 1e-4);
  ASSERT_TRUE(last.error);
  EXPECT_LT(last.error->l2, 0.05);  // measured 0.046: blobs of 6 degrees in a bell of 19
  EXPECT_NEAR(last.error->l2, first.error->l2, 0.3 * first.error->l2) << "smoothing alone";
  EXPECT_NEAR(last.stretch, 1, 0.01) << "a sphere that turns parts nobody";
}

TEST(SphereRun, HasTheExactDensityOfAFlowWithDivergence) {
  // u = 0, v = V: rho cos y is carried along meridians, rho(y, t) = rho_0(y - V t/R) cos(y - V t/R)/cos y.
  CaseTables tables = turning();
  tables.velocity = velocity_of({"0", "20"});
  tables.density = "expression = \"exp(-((x - 10)^2 + (y - 30)^2)/50)\"";
  tables.domain = "coordinates = \"longitude latitude\"\nmin = [-40, 0]\nmax = [60, 70]";
  tables.time = "end = \"day\"\nstep = 3600";
  tables.particles = "per_axis = 161\ncutoff = \"gauss4\"";
  tables.output = output_at("\"day\"");
  const Ended end = ended(spec_of(tables));
  double worst = 0, largest = 0;
  const double moved = degrees(20 * 86400 / earth_radius);
  for (std::size_t i = 0; i < end.rho.size(); ++i) {
    const double x = end.lattice.coordinate(0, i % end.lattice.points[0]),
                 y = end.lattice.coordinate(1, i / end.lattice.points[0]), y0 = y - moved;
    const double exact =
        std::exp(-(std::pow(x - 10, 2) + std::pow(y0 - 30, 2)) / 50) * std::cos(radians(y0)) / std::cos(radians(y));
    largest = std::max(largest, exact), worst = std::max(worst, std::abs(end.rho[i] - exact));
  }
  EXPECT_LT(worst / largest, 3e-3);  // smoothing of order 4: measured 2.2e-3
  ASSERT_TRUE(end.summary.frames.back().second.error);
  EXPECT_NEAR(end.summary.frames.back().second.error->linf, worst / largest, 1e-6) << "characteristics say the same";
}

TEST(SphereRun, IsTheSameWhereverLongitudesBegin) {
  CaseTables tables = turning();
  tables.output = output_at("0, \"4*day\"");
  const Ended one = ended(spec_of(tables));
  tables.domain = "coordinates = \"longitude latitude\"\nmin = [0, -75]\nmax = [360, 75]";
  const Ended other = ended(spec_of(tables));
  ASSERT_EQ(one.rho.size(), other.rho.size());
  const std::size_t row = one.lattice.points[0], half = (row - 1) / 2;
  double largest = 0;
  for (const double rho : one.rho) largest = std::max(largest, rho);
  for (std::size_t i = 0; i < one.rho.size(); ++i) {
    const std::size_t there = i / row * row + (i % row + half) % (row - 1);
    EXPECT_NEAR(one.rho[i], other.rho[there], 3e-8 * largest);  // the tolerance of both sums
  }
}

TEST(SphereRun, SpreadsAtTheRateOfDiffusion) {
  // Laplace-Beltrami: a patch around a pole of the axis keeps its place, and its mean of 1 - cos(angle) relaxes as
  // exp(-2 D t / R^2) towards 1.
  CaseTables tables = turning();
  tables.velocity = velocity_of({"0", "0"});
  tables.domain = "coordinates = \"longitude latitude\"\nmin = [-50, -50]\nmax = [50, 50]";
  tables.density = shape_of("gaussian", "0, 0", "1e6");
  tables.particles = "per_axis = 61\ncutoff = \"gauss2\"";
  tables.output = output_at("0, \"4*day\"") + "\n[effects.diffusion]\nD = 1e5";
  tables.evaluate = "per_axis = 61";
  std::vector<double> means, masses;
  Simulation simulation(spec_of(tables), 1);
  simulation.observe("test", [&](const Frame& frame) {
    double mass = 0, sum = 0;
    const Lattice& lattice = frame.density->lattice;
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      const Vector x{lattice.coordinate(0, i % lattice.points[0]), lattice.coordinate(1, i / lattice.points[0]), 0};
      const double weight = frame.density->rho[i] * lattice.cell(x[1]);
      mass += weight, sum += weight * std::cos(angle_between(x, {0, 0, 0}));
    }
    means.push_back(sum / mass), masses.push_back(mass);
  });
  simulation.run();
  ASSERT_EQ(means.size(), 2u);
  EXPECT_NEAR(masses[1], masses[0], 1e-8 * masses[0]);  // of the sums
  const double rate = 2 * 1e5 / (earth_radius * earth_radius), t = 4 * 86400;
  // Core spreading has 1 - x + x^2/2 ... of another series than exp(-x): the second term differs by a part of x itself.
  EXPECT_NEAR(std::log(means[0] / means[1]) / (rate * t), 1, rate * t + 1e-3);
}

TEST(SphereRun, HasTheSameBitsForThreadsStopsAndRanks) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{},
        {"domain.min=[60, -10]", "domain.max=[200, 75]", "domain.edges=[\"open\", \"unbounded\"]"}}) {
    CaseTables tables = turning();
    tables.output = output_at("0, \"2*day\", \"4*day\"");
    const Case spec = spec_of(tables, more);
    const Ended one = ended(spec, 1), two = ended(spec, 2);
    expect_same(one.particles, two.particles);
    EXPECT_EQ(one.rho, two.rho);
    if (!more.empty()) {
      EXPECT_GT(one.summary.frames.back().second.left.front().particles +
                    one.summary.frames.back().second.left.back().particles,
                0u);
    }
    Simulation stopping(spec, 1);
    std::vector<double> rho;
    const auto see = [&](const Frame& frame) { rho = frame.density->rho; };
    stopping.observe("test", see);
    int stops = 0;
    stopping.on_progress([&](const Progress&) { return ++stops != 1; });
    RunSummary summary = stopping.run();
    ASSERT_FALSE(summary.complete);
    Simulation resumed(spec, 2);
    resumed.observe("test", see);
    resumed.restore(stopping.particles(), stopping.state());
    EXPECT_TRUE(resumed.run().complete);
    expect_same(resumed.particles(), one.particles);
    EXPECT_EQ(rho, one.rho);
    for (const int size : {3}) {
      std::vector<double> shared;
      Particles all;
      for (const auto& end : ends_on_ranks(size, [&](base::Communicator& ranks) {
             Simulation simulation(spec, 1, ranks);
             if (ranks.rank() == 0)
               simulation.observe("test", [&](const Frame& frame) { shared = frame.density->rho; });
             simulation.run();
             Particles some = simulation.all_particles();
             if (ranks.rank() == 0) all = std::move(some);
           }))
        EXPECT_FALSE(end);
      EXPECT_EQ(shared, one.rho);
      expect_same(all, one.particles);
    }
  }
}

TEST(SphereRun, IsSharedByTilesAcross180) {
  CaseTables tables = turning();
  tables.particles = "per_axis = 721\ncutoff = \"gauss2\"";
  tables.evaluate = "per_axis = 361\ntile_particles = 200";
  tables.density = shape_of("cosine_bell", "175, 20", "2.1e6");
  tables.time = "end = 21600\nstep = 7200";
  tables.output = output_at("0, 21600");
  const Case spec = spec_of(tables);
  const Ended one = ended(spec);
  EXPECT_NE(one.summary.transform_choice.find(" tiles"), std::string::npos) << one.summary.transform_choice;
  for (const int size : {2, 3}) {
    std::vector<double> shared;
    Particles all;
    for (const auto& end : ends_on_ranks(size, [&](base::Communicator& ranks) {
           Simulation simulation(spec, 1, ranks);
           if (ranks.rank() == 0) simulation.observe("test", [&](const Frame& frame) { shared = frame.density->rho; });
           simulation.run();
           EXPECT_LT(simulation.particles().size(), one.particles.size()) << "they are shared";
           Particles some = simulation.all_particles();
           if (ranks.rank() == 0) all = std::move(some);
         }))
      EXPECT_FALSE(end);
    EXPECT_EQ(shared, one.rho);
    expect_same(all, one.particles);
  }
}

TEST(SphereRun, EndsWithAReasonAtAPole) {
  CaseTables tables = turning();
  tables.velocity = velocity_of({"0", "40"});
  tables.time = "end = \"3*day\"\nstep = 3600";
  tables.output = output_at("0, \"3*day\"");
  const std::string message = message_of<NumericalError>([&] { ended(spec_of(tables)); });
  EXPECT_NE(message.find("within 0.1 degrees of a pole"), std::string::npos) << message;
}

TEST(SphereRun, ReleasesShapesByAreasAndShowsVelocitiesInMetres) {
  CaseTables tables = turning();
  tables.velocity = velocity_of({"30*cos(pi*y/180)", "0"});
  tables.density = shape_of("cosine_bell", "120, 40", "2.1e6");
  tables.output =
      "times = [0, \"day\"]\nvtk = [\"particles\"]\nimages = []\nreport = \"none\"\nfields = [\"velocity\", "
      "\"vorticity\"]";
  const std::string text =
      case_text(tables) + "\n[[source]]\n" + shape_of("disk", "-60, -30", "1e6") + "\nat = \"day/2\"\n";
  const Case spec = parse_case(text, "scene.toml").spec;
  Simulation simulation(spec, 1);
  int outputs = 0;
  simulation.observe("test", [&](const Frame& frame) {
    ++outputs;
    ASSERT_TRUE(frame.velocity);
    for (std::size_t j = 0; j < frame.particles->size(); ++j) {
      EXPECT_NEAR((*frame.velocity)[2 * j], 30 * std::cos(radians(frame.particles->position[1][j])), 1e-12);
      EXPECT_NEAR((*frame.velocity)[2 * j + 1], 0, 1e-12);
    }
    const Lattice& lattice = frame.density->lattice;
    ASSERT_EQ(frame.density->fields.size(), 2u);
    for (std::size_t i = 0; i < lattice.size(); i += 17) {
      const double y = radians(lattice.coordinate(1, i / lattice.points[0]));
      EXPECT_NEAR(frame.density->fields[0].values[2 * i], 30 * std::cos(y), 1e-12);
      EXPECT_NEAR(frame.density->fields[1].values[i], 60 * std::sin(y) / earth_radius, 1e-18);
    }
    if (outputs == 2) {
      EXPECT_NEAR(*frame.numbers.released /
                      (2 * std::numbers::pi * earth_radius * earth_radius * (1 - std::cos(1e6 / earth_radius))),
                  1,
                  0.05);  // a disk of 9 degrees on a lattice of 3
    }
  });
  simulation.run();
  EXPECT_EQ(outputs, 2);
}

}  // namespace
}  // namespace gaussdrift
