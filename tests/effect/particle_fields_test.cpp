// Fields of the particles: age, residence, first exit, and how the flow map stretches, against closed forms and SciPy.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"
#include "sim/follow/flow_map.hpp"

namespace gaussdrift {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// What the last output shows.
struct Seen {
  double time = 0;
  Particles particles;
  std::map<std::string, FieldOnGrid> fields, on_grid;
  Lattice lattice;

  const std::vector<double>& of(const std::string& name) const { return fields.at(name).values; }
};

void take(const Frame& frame, Seen& seen) {
  seen = {frame.time, *frame.particles, {}, {}, frame.density->lattice};
  if (frame.particle_fields)
    for (const FieldOnGrid& field : *frame.particle_fields) seen.fields[field.name] = field;
  for (const FieldOnGrid& field : frame.density->fields) seen.on_grid[field.name] = field;
}

Seen last_of(const Case& spec, int threads = 1) {
  Seen seen;
  Simulation simulation(spec, threads);
  simulation.observe("test", [&](const Frame& frame) { take(frame, seen); });
  simulation.run();
  return seen;
}

std::string fields(const std::string& names) { return "output.fields=[" + names + "]"; }
const std::string both_files = R"(output.vtk=["density", "particles"])";

/// Particles everywhere on the lattice.
const std::vector<std::string> full = {"density={expression=\"1\"}", both_files};

TEST(Ftle, OfLinearFlowsIsThatOfTheirMatrix) {
  const std::vector<std::string> common =
      with(full, {"particles.per_axis=9", "time={end=0.75,step=0.01}", "output.times=[0.75]",
                  fields("\"ftle\", \"flow_map_gradient\"")});
  const double e = std::exp(0.75 * 0.8), s = 0.75 * 1.5;
  struct {
    const char* velocity;
    std::array<double, 4> gradient;
    double exponent;
  } const flows[] = {
      {"[\"0.8*x\", \"-0.8*y\"]", {e, 0, 0, 1 / e}, 0.8},
      {"[\"1.5*y\", \"0\"]", {1, s, 0, 1}, std::asinh(s / 2) / 0.75},  // s - 1/s is the shear for the singular value s
      {"[\"-2*y\", \"2*x\"]", {std::cos(1.5), -std::sin(1.5), std::sin(1.5), std::cos(1.5)}, 0}};
  for (const auto& flow : flows) {
    const Seen seen = last_of(scene_of(with(common, {std::string("velocity.u=") + flow.velocity})));
    ASSERT_EQ(seen.particles.size(), 81u);
    ASSERT_EQ(seen.fields.at("flow_map_gradient").components, 4);
    for (std::size_t j = 0; j < 81; ++j) {
      // 1e-9: the fourth order of rk4 at this step.
      EXPECT_NEAR(seen.of("ftle")[j], flow.exponent, 1e-9) << flow.velocity << " at particle " << j;
      for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(seen.of("flow_map_gradient")[4 * j + c], flow.gradient[c], 2e-9);
    }
  }
}

TEST(Ftle, InSpace) {
  Particles particles;
  particles.dimension = 3;
  const Lattice lattice{3, {3, 3, 3}, {0, 0, 0}, 0.5};
  const double rows[3][3] = {{2, 0.3, 0}, {0, 0.5, -0.4}, {0.1, 0, 1.5}};
  for (std::int64_t id = 0; id < 27; ++id) {
    if (id == 0) continue;  // a corner has no particle: those beside it have a neighbour on one side
    const double x[3] = {0.5 * static_cast<double>(id % 3), 0.5 * static_cast<double>(id / 3 % 3),
                         0.5 * static_cast<double>(id / 9)};
    for (std::size_t i = 0; i < 3; ++i)
      particles.position[i].push_back(rows[i][0] * x[0] + rows[i][1] * x[1] + rows[i][2] * x[2]);
    particles.alpha.push_back(1);
    particles.id.push_back(id);
  }
  particles.id.push_back(40);  // released: it has no neighbours
  particles.alpha.push_back(1);
  for (auto& x : particles.position) x.push_back(0);
  const std::vector<double> gradients = flow_map_gradients(particles, lattice, {}, 2);
  const std::vector<double> exponents = lyapunov_exponents(gradients, 3, -2, 1);
  for (std::size_t j = 0; j < 26; ++j)
    for (std::size_t c = 0; c < 9; ++c) EXPECT_NEAR(gradients[9 * j + c], rows[c / 3][c % 3], 1e-15);
  EXPECT_TRUE(std::isnan(gradients[9 * 26]));
  EXPECT_TRUE(std::isnan(exponents[26]));
  // The largest singular value of the rows, by the power method.
  std::array<double, 3> v{1, 0, 0};
  double largest = 0;
  for (int i = 0; i < 200; ++i) {
    std::array<double, 3> w{}, z{};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) w[a] += rows[a][b] * v[b];
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) z[a] += rows[b][a] * w[b];
    largest = std::sqrt(std::hypot(z[0], z[1], z[2]));
    for (std::size_t a = 0; a < 3; ++a) v[a] = z[a] / std::hypot(z[0], z[1], z[2]);
  }
  for (std::size_t j = 0; j < 26; ++j) EXPECT_NEAR(exponents[j], std::log(largest) / 2, 1e-14);
}

/// Place, exponent by differences, exponent by the variational equations.
std::vector<std::array<double, 4>> by_scipy(const std::string& flow) {
  std::vector<std::array<double, 4>> rows;
  std::ifstream table(std::string(REFERENCE_DIR) + "/scipy-ftle.csv");
  for (std::string line; std::getline(table, line);) {
    if (line.rfind(flow + ",", 0) != 0) continue;
    std::array<double, 4> row{};
    std::size_t at = flow.size() + 1;
    for (double& number : row) {
      number = std::stod(line.substr(at));
      at = line.find(',', at) + 1;
    }
    rows.push_back(row);
  }
  EXPECT_EQ(rows.size(), 7u);
  return rows;
}

Case gyre(int per_axis) {
  return scene_of(with(full, {"domain={min=[0,0],max=[2,1]}", "velocity={field=\"double_gyre\"}",
                              "particles.per_axis=" + std::to_string(per_axis), "time={end=5,step=0.025}",
                              "output.times=[5]", "evaluate.per_axis=41", fields("\"ftle\"")}));
}

TEST(Ftle, OfTheDoubleGyreIsThatOfScipy) {
  const auto rows = by_scipy("gyre");
  std::vector<double> worst;  // against the variational equations
  for (const int per_axis : {41, 81, 161}) {
    const Seen seen = last_of(gyre(per_axis));
    const std::vector<double>& shown = seen.on_grid.at("ftle").values;
    double error = 0;
    for (const auto& [x, y, differences, variations] : rows) {
      // The grid of 41 x 21 points is a part of all lattices, so that it shows their values.
      const auto point = static_cast<std::size_t>(std::lround(y / 0.05) * 41 + std::lround(x / 0.05));
      if (per_axis == 41) {
        EXPECT_NEAR(shown[point], differences, 1e-8) << x << ", " << y;
      }
      error = std::max(error, std::abs(shown[point] - variations));
    }
    worst.push_back(error);
  }
  // Differences over 2h are of second order.
  EXPECT_NEAR(std::log2(worst[1] / worst[2]), 2, 0.2) << worst[1] << ", " << worst[2];
  EXPECT_LT(worst[2], 1e-3);
}

// Backwards it is of the flow map back, and times are those of the clock.
TEST(Ftle, OfARunBackwardsIsThatOfTheWayBack) {
  const Seen seen = last_of(scene_of(
      with(full, {"velocity.u=[\"0.8*x*t\", \"-0.8*y*t\"]", "particles.per_axis=9", "time={start=2,end=1,step=0.01}",
                  "output.times=[1]", fields("\"ftle\", \"exit_time\", \"age\"")})));
  EXPECT_EQ(seen.time, 1);
  for (std::size_t j = 0; j < 81; ++j) {
    // The integral of 0.8 t from 1 to 2 is 1.2: y grows by exp(1.2) on the way back, x falls.
    EXPECT_NEAR(seen.of("ftle")[j], 1.2, 1e-9);
    EXPECT_EQ(seen.of("age")[j], 1);
    const double y0 = std::abs(-1 + 0.25 * static_cast<double>(seen.particles.id[j] / 9));
    const double left = std::sqrt(4 - std::log(1 / y0) / 0.4);  // exp(0.4 (4 - t^2)) y0 = 1
    if (y0 > 0.9 || y0 == 0 || std::log(1 / y0) > 1.2) continue;
    EXPECT_NEAR(seen.of("exit_time")[j], left, 1e-4);
  }
}

// cases/jet.toml on a lattice as wide as that of SciPy's differences.
TEST(Ftle, OfTheCaseOfTheJetIsThatOfScipy) {
  Case spec = read_case(std::string(SOURCE_DIR) + "/cases/jet.toml",
                        {"particles.per_axis=201", "evaluate.per_axis=201", "time.step=0.01", "output.times=[1, 5]"})
                  .spec;
  spec.reference = {}, spec.checks.clear();
  const Seen seen = last_of(spec);
  ASSERT_EQ(seen.lattice.points[0], 201u);
  for (const auto& [x, y, differences, variations] : by_scipy("jet")) {
    const auto point = static_cast<std::size_t>(std::lround((y + 3) / 0.1) * 201 + std::lround(x / 0.1));
    EXPECT_NEAR(seen.on_grid.at("ftle").values[point], differences, 1e-8) << x << ", " << y;
  }
}

TEST(Ftle, KnowsNeighboursOverPeriodicEdges) {
  const Seen seen =
      last_of(scene_of(with(full, {edges("\"periodic\", \"periodic\""), "velocity.u=[\"0.7+0.2*sin(pi*y)\", \"0.3\"]",
                                   "particles.per_axis=41", "time={end=1,step=0.01}", "output.times=[1]",
                                   fields("\"ftle\", \"flow_map_gradient\"")})));
  ASSERT_EQ(seen.particles.size(), 1600u);
  const auto& ids = seen.particles.id;
  for (std::size_t j = 0; j < ids.size(); ++j) {
    const double y = -1 + static_cast<double>(ids[j] / 40) * 0.05;
    // x moves by the integral of 0.2 sin(pi (y + 0.3 t)); its slope in y by central differences over 0.1.
    const auto moved = [](double from) {
      return -0.2 / (0.3 * std::numbers::pi) *
             (std::cos(std::numbers::pi * (from + 0.3)) - std::cos(std::numbers::pi * from));
    };
    const double shear = (moved(y + 0.05) - moved(y - 0.05)) / 0.1;
    EXPECT_NEAR(seen.of("flow_map_gradient")[4 * j + 1], shear, 1e-9);
    EXPECT_NEAR(seen.of("ftle")[j], std::asinh(std::abs(shear) / 2), 1e-9);
  }
}

const std::string all_fields =
    fields(R"("age", "residence_time", "exit_time", "exit_face", "ftle", "flow_map_gradient")");

TEST(ParticleFields, TellWhenAndWhereTheDomainIsLeftFirst) {
  // Out through x = 1 and y = -1, in and out again: x = x0 + 0.9 sin(4t), which turns at t = pi/8.
  for (const char* method : {"\"rk4\"", "\"dopri5\",tolerance=1e-10"}) {
    const Seen seen = last_of(scene_of(
        with(full, {"velocity.u=[\"3.6*cos(4*t)\", \"0\"]", "particles.per_axis=21",
                    std::string("time={end=1,step=0.005,method=") + method + "}", "output.times=[1]", all_fields})));
    ASSERT_EQ(seen.particles.size(), 441u);
    std::size_t left = 0;
    for (std::size_t j = 0; j < 21; ++j) {  // all rows are alike
      const double x0 = -1 + static_cast<double>(seen.particles.id[j]) * 0.1;
      // Its place at many times: when it is inside.
      double inside = 0, exit = infinite, face = 0;
      constexpr int moments = 100000;
      for (int i = 0; i < moments; ++i) {
        const double t = (i + 0.5) / moments, x = x0 + 0.9 * std::sin(4 * t);
        if (std::abs(x) <= 1 + 1e-9)
          inside += 1. / moments;
        else if (face == 0)
          exit = t, face = x > 0 ? 2 : 1;
      }
      EXPECT_EQ(seen.of("age")[j], 1);
      // 4e-5: a chord of a step of 0.005 misses the path by 2e-5, near the turn the way is slow.
      EXPECT_NEAR(seen.of("residence_time")[j], inside, 1e-3) << x0;
      EXPECT_EQ(seen.of("exit_face")[j], face) << x0;
      if (face == 0)
        EXPECT_TRUE(std::isnan(seen.of("exit_time")[j]));
      else
        EXPECT_NEAR(seen.of("exit_time")[j], exit, 1e-3) << x0;
      left += face != 0;
    }
    EXPECT_GT(left, 5u);
    EXPECT_LT(left, 21u);
  }
}

const std::vector<std::string> drifting_out = {edges("\"open\", \"unbounded\""),
                                               "velocity.u=[\"1\", \"0.25*y\"]",
                                               "particles.per_axis=11",
                                               "time={end=1.25,step=0.1}",
                                               "output.times=[0, 0.5, 1.25]",
                                               "evaluate.per_axis=21",
                                               all_fields};

TEST(ParticleFields, OfThoseWhoHaveLeftStandWhereTheyBegan) {
  const Seen seen = last_of(scene_of(with(full, drifting_out)));
  const FieldOnGrid& exits = seen.on_grid.at("exit_time");
  ASSERT_EQ(seen.lattice.points[0], 21u);
  EXPECT_EQ(seen.on_grid.count("age"), 0u);
  EXPECT_EQ(seen.on_grid.count("flow_map_gradient"), 0u);
  for (std::size_t point = 0; point < exits.values.size(); ++point) {
    // Points of the grid lie on the lattice and half way between: there the lower one counts.
    const std::size_t i = point % 21 / 2, k = point / 21 / 2;
    const double x0 = -1 + 0.2 * static_cast<double>(i), y0 = -1 + 0.2 * static_cast<double>(k);
    const double through_x = 1 - x0, through_y = y0 == 0 ? infinite : 4 * std::log(1 / std::abs(y0));
    const double exit = std::min(through_x, through_y);
    const double face = exit > 1.25 ? 0 : through_x < through_y ? 2 : y0 > 0 ? 4 : 3;
    if (std::abs(through_x - through_y) < 1e-6 || std::abs(y0) > 1 - 1e-9) continue;  // corners and edges
    EXPECT_EQ(seen.on_grid.at("exit_face").values[point], face) << x0 << ", " << y0;
    if (face == 0)
      EXPECT_TRUE(std::isnan(exits.values[point]));
    else
      // 3e-4: a step of 0.1 is taken as straight.
      EXPECT_NEAR(exits.values[point], exit, 3e-4) << x0 << ", " << y0;
    if (through_x < through_y) {
      // 1e-8: a face is passed 2e-9 beyond it.
      EXPECT_NEAR(seen.on_grid.at("residence_time").values[point], std::min(1.25, exit), 1e-8);
    }
    EXPECT_EQ(std::isnan(seen.on_grid.at("ftle").values[point]), through_x < 1.25 - 1e-9) << x0;
  }
}

TEST(ParticleFields, OfReleasedParticlesBeginWithThem) {
  const Seen seen =
      last_of(scene_of({"source.point=[0, 0]", "source.from=0.1", "source.to=0.4", "source.rate=1", "source.puffs=3",
                        "output.times=[0.5]", both_files, fields("\"age\", \"residence_time\", \"ftle\"")}));
  const std::size_t count = seen.particles.size();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = count - 3 + i;
    EXPECT_NEAR(seen.of("age")[j], 0.35 - 0.1 * static_cast<double>(i), 1e-15);
    EXPECT_NEAR(seen.of("residence_time")[j], seen.of("age")[j], 1e-15);
    EXPECT_TRUE(std::isnan(seen.of("ftle")[j]));
  }
  EXPECT_EQ(seen.of("age")[0], 0.5);
}

void expect_same(const Seen& a, const Seen& b) {
  expect_same(a.particles, b.particles);
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (const auto list : {&Seen::fields, &Seen::on_grid})
    for (const auto& [name, field] : a.*list) {
      const std::vector<double>& other = (b.*list).at(name).values;
      ASSERT_EQ(field.values.size(), other.size());
      for (std::size_t i = 0; i < other.size(); ++i)
        EXPECT_TRUE(field.values[i] == other[i] || (std::isnan(field.values[i]) && std::isnan(other[i]))) << name;
    }
}

TEST(ParticleFields, AreTheSameForThreadsRanksAndAfterAStop) {
  const Case spec = scene_of(with(with(full, drifting_out),
                                  {"particles.per_axis=101", "evaluate.tile_particles=500", "evaluate.per_axis=200"}));
  const Seen one = last_of(spec);
  expect_same(one, last_of(spec, 3));
  Seen shared;
  on_ranks(3, [&](base::Communicator& ranks) {
    Simulation simulation(spec, 1, ranks);
    if (ranks.rank() == 0) simulation.observe("test", [&](const Frame& frame) { take(frame, shared); });
    simulation.run();
  });
  expect_same(one, shared);
  Simulation first(spec, 1), second(spec, 1);
  int calls = 0;
  first.on_progress([&](const Progress& progress) { return progress.time < 0.7 && ++calls < 100; });
  first.run();
  Seen resumed;
  second.observe("test", [&](const Frame& frame) { take(frame, resumed); });
  second.restore(first.particles(), first.state());
  second.run();
  expect_same(one, resumed);
}

TEST(ParticleFields, CostNothingWhereNobodyAsks) {
  const Seen seen = last_of(scene_of({both_files}));
  EXPECT_EQ(seen.fields.size(), 1u);
  EXPECT_TRUE(seen.fields.contains("core_radius"));  // what ParaView draws them with
  EXPECT_TRUE(seen.particles.kept.empty());
  EXPECT_TRUE(last_of(scene_of({both_files, fields("\"age\", \"ftle\"")})).particles.kept.empty());
}

TEST(ParticleFields, AreRefusedWhereParticlesDoNotStayWhoTheyAre) {
  const auto message = [](const std::vector<std::string>& overrides) {
    return message_of<CaseError>([&] { scene_of(overrides); });
  };
  EXPECT_NE(message({fields("\"ftle\""), "effects.remesh.every=2"}).find("\"ftle\" belongs to particles of the start"),
            std::string::npos);
  const std::vector<std::string> spreading = {fields("\"age\""), "effects.diffusion.D=0.01"};
  EXPECT_NE(message(with(spreading, {"effects.diffusion.method=\"particle-exchange\""})).find("core-spreading"),
            std::string::npos);
  EXPECT_EQ(message(with(spreading, {"effects.diffusion.method=\"core-spreading\""})), "");
  const std::string in_pieces = message_of<InputError>([] {
    Simulation(scene_of(with(full, {fields("\"ftle\""), "evaluate={per_axis=200,piece_points=10000}"})), 1).run();
  });
  EXPECT_NE(in_pieces.find("raise evaluate.piece_points to 40000"), std::string::npos) << in_pieces;
}

}  // namespace
}  // namespace gaussdrift
