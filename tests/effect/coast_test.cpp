// Land in data on a grid: what happens to particles that reach it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "field/gridded/land.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"
#include "same_numbers.hpp"
#include "same_particles.hpp"
#include "sim/comparison.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// u = (1, v) on [-1, 1]^2 with 9 points an axis; land at x >= 0.5, so that the coast is at 0.375.
std::shared_ptr<GridData> wind(double v) {
  auto data = std::make_shared<GridData>();
  data->name = "wind";
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 9; ++i) data->axis[static_cast<std::size_t>(k)].push_back(-1 + 0.25 * i);
  data->times = {0};
  data->components = 2;
  data->values.emplace_back();
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 9; ++i)
      for (const double value : {1.0, v}) data->values[0].push_back(i < 6 ? value : nan);
  data->land = true;
  return data;
}
constexpr double coast_at = 0.375;

/// A Gaussian of variance 0.02 an axis at the origin, in that wind.
Case scene(AtCoast rule, double v = 0, std::vector<std::string> more = {}) {
  for (const char* usual : {"time.step=0.05", "output.times=[0, 0.25, 0.36, 0.5]"}) more.insert(more.begin(), usual);
  Case spec = scene_of(more);
  FileVelocitySpec file;
  file.interpolation = "linear", file.outside = "clamp", file.missing = "land", file.data = wind(v);
  spec.velocity = {file};
  spec.domain.coast = rule;
  return spec;
}

/// The part of the cloud that has x > coast_at - t at the start, as the particles have it.
double part_beyond(const Case& spec, double t) {
  const Particles start = [&] {
    Simulation simulation(spec);
    simulation.prepare();
    return simulation.particles();
  }();
  double all = 0, beyond = 0;
  for (std::size_t j = 0; j < start.size(); ++j) {
    all += start.alpha[j];
    if (start.position[0][j] + t > coast_at) beyond += start.alpha[j];
  }
  return beyond / all;
}

TEST(Land, IsWhereMoreThanHalfOfTheWeightHasNoValue) {
  const Land land(wind(0.5), Outside::clamp);
  EXPECT_FALSE(land.is_land(0, {0.37, 0.1, 0}));
  EXPECT_TRUE(land.is_land(0, {0.38, 0.1, 0}));
  EXPECT_TRUE(land.is_land(0, {0.9, 0.1, 0}));
  EXPECT_TRUE(land.is_land(0, {7, 0.1, 0})) << "clamped";
  EXPECT_FALSE(Land(wind(0), Outside::zero).is_land(0, {7, 0.1, 0}));
  EXPECT_NEAR(land.shore(0, {0.375, 0.1, 0}, 2).slope[0], -4, 1e-12);
}

TEST(CoastalVelocity, IsTheMeanOfThePointsThatHaveValues) {
  // v = 2 + y + x y at the points, one point of land.
  auto data = wind(0);
  for (std::size_t j = 0; j < 9; ++j)
    for (std::size_t i = 0; i < 9; ++i) {
      const double x = data->axis[0][i], y = data->axis[1][j];
      data->values[0][2 * (9 * j + i)] = 1;
      data->values[0][2 * (9 * j + i) + 1] = 2 + y + x * y;
    }
  const std::size_t hole = 9 * 4 + 4;  // (0, 0)
  data->values[0][2 * hole] = data->values[0][2 * hole + 1] = nan;
  for (const auto interpolation : {Interpolation::linear, Interpolation::cubic}) {
    const CoastalVelocity field(GridInterpolator(data, interpolation, Outside::error), Outside::error, false);
    const auto at = [&](double x, double y) {
      Vector u{};
      field.add(0, {2, 1, {&x, &y, nullptr}}, {2, 1, {&u[0], &u[1], nullptr}});
      return u;
    };
    EXPECT_NEAR(at(0.6, 0.7)[1], 2 + 0.7 + 0.42, 1e-12) << "far away";
    // In the cell [0, 0.25]^2, weights 0.24, 0.24, 0.36 of the corners but the origin, at (0.6, 0.6) of it.
    const double known = 0.24 * 2 + 0.24 * 2.25 + 0.36 * (2.25 + 0.0625);
    EXPECT_NEAR(at(0.15, 0.15)[1], known / 0.84, 1e-12);
    EXPECT_NEAR(at(0.15, 0.15)[0], 1, 1e-12);
    EXPECT_TRUE(std::isnan(at(0.05, 0.05)[0]));
    EXPECT_NE(field.why_not_finite(0, {0.05, 0.05, 0}).find("domain.coast"), std::string::npos);
    // Derivatives are those of that mean.
    const double x = 0.15, y = 0.1, h = 1e-6;
    std::array<double, 4> slopes{};
    double divergence = 0;
    GradientsView gradient{2, 1, {}};
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 0; i < 2; ++i) gradient.slope[k][i] = &slopes[2 * k + i];
    field.add_gradient(0, {2, 1, {&x, &y, nullptr}}, gradient);
    field.add_divergence(0, {2, 1, {&x, &y, nullptr}}, &divergence);
    EXPECT_NEAR(slopes[2], (at(x + h, y)[1] - at(x - h, y)[1]) / (2 * h), 1e-8);
    EXPECT_NEAR(slopes[3], (at(x, y + h)[1] - at(x, y - h)[1]) / (2 * h), 1e-8);
    EXPECT_NEAR(divergence, slopes[0] + slopes[3], 1e-12);
  }
}

TEST(Coast, EndsARunOnlyWhereAParticleReachesIt) {
  const std::string message = message_of<NumericalError>([&] { Simulation(scene(AtCoast::refuse)).run(); });
  for (const char* words : {"particle ", "t = ", "land", "domain.coast = \"stop\", \"slide\" or \"remove\""})
    EXPECT_NE(message.find(words), std::string::npos) << message;
  Case away =
      scene(AtCoast::refuse, 0, {"density.center=[-0.5, 0]", "density.shape=\"wendland\"", "density.radius=0.2"});
  EXPECT_TRUE(Simulation(away).run().complete);
}

TEST(Coast, StopsRemovesWhatReachesItAndCountsIt) {
  for (const char* method : {"rk4", "dopri5"})
    for (const AtCoast rule : {AtCoast::stop, AtCoast::remove}) {
      const Case spec = scene(rule, 0, {"particles.per_axis=21", std::string("time.method=") + method});
      Simulation simulation(spec, 1);
      const RunSummary summary = simulation.run();
      const double mass = summary.frames.front().second.mass;
      for (const auto& [time, numbers] : summary.frames) {
        const double expected = part_beyond(spec, time);
        ASSERT_TRUE(numbers.inside);
        if (rule == AtCoast::stop) {
          ASSERT_TRUE(numbers.stopped);
          EXPECT_NEAR(numbers.stopped->mass / mass, expected, 1e-12) << time;
          EXPECT_NEAR(numbers.mass, mass, 1e-14 * mass) << "it stays in the run";
        } else {
          ASSERT_EQ(numbers.left.size(), 1u);
          EXPECT_EQ(numbers.left[0].reason, "coast");
          EXPECT_NEAR(numbers.left[0].mass / mass, time == 0 ? 0 : expected, 1e-12) << time;
          EXPECT_NEAR(numbers.mass + numbers.left[0].mass, mass, 1e-14 * mass);
        }
      }
      for (std::size_t j = 0; j < simulation.particles().size() && rule == AtCoast::stop; ++j)
        EXPECT_LE(simulation.particles().position[0][j], std::max(coast_at, 1.0) + 1e-9);
    }
}

TEST(Coast, HoldsWhatStopsAtTheCoastItself) {
  const std::vector<std::string> small{"density.shape=\"wendland\"", "density.radius=0.2"};
  Simulation simulation(scene(AtCoast::stop, 0.3, small), 2);
  simulation.run();
  const Particles& at_end = simulation.particles();
  for (std::size_t j = 0; j < at_end.size(); ++j) {
    const double x0 = -1 + 0.05 * static_cast<double>(at_end.id[j] % 41),
                 y0 = -1 + 0.05 * static_cast<double>(at_end.id[j] / 41);
    const double moved = std::min(0.5, coast_at - x0);
    EXPECT_NEAR(at_end.position[0][j], x0 + moved, 1e-10);
    EXPECT_NEAR(at_end.position[1][j], y0 + 0.3 * moved, 1e-10) << "where it met the coast, not where its step ended";
  }
}

TEST(Coast, IsSlidAlong) {
  const std::vector<std::string> small{"density.shape=\"wendland\"", "density.radius=0.2"};
  Simulation simulation(scene(AtCoast::slide, 0.3, small), 2);
  const RunSummary summary = simulation.run();
  const Particles& at_end = simulation.particles();
  for (std::size_t j = 0; j < at_end.size(); ++j) {
    const double x0 = -1 + 0.05 * static_cast<double>(at_end.id[j] % 41),
                 y0 = -1 + 0.05 * static_cast<double>(at_end.id[j] / 41);
    EXPECT_NEAR(at_end.position[0][j], std::min(x0 + 0.5, coast_at), 1e-6);
    EXPECT_NEAR(at_end.position[1][j], y0 + 0.3 * 0.5, 1e-6);
  }
  EXPECT_FALSE(summary.frames.back().second.stopped);
}

TEST(Coast, IsNotSteppedOver) {
  // A wall one point wide; a step is as long as four cells.
  auto data = wind(0);
  for (std::size_t j = 0; j < 9; ++j)
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t c = 0; c < 2; ++c) data->values[0][2 * (9 * j + i) + c] = i == 5 ? nan : c == 0 ? 1 : 0;
  for (const AtCoast rule : {AtCoast::stop, AtCoast::slide}) {
    Case spec = scene(rule, 0,
                      {"time.end=1.5", "time.step=1.2", "time.method=euler", "output.times=[1.5]",
                       "density.shape=\"wendland\"", "density.radius=0.1"});
    std::get<FileVelocitySpec>(spec.velocity[0]).data = data;
    Simulation simulation(spec, 1);
    simulation.run();
    for (const double x : simulation.particles().position[0]) EXPECT_NEAR(x, 0.125, 1e-6);
  }
}

TEST(Coast, IsPassedByACloudAsTheStreamlinesSay) {
  // The checks of the case are what has passed, from paths in the flow of the formula.
  const Case spec =
      gaussdrift::read_case(SOURCE_DIR "/cases/island.toml", {"output.images=[]", "evaluate.per_axis=11"}).spec;
  const RunSummary summary = Simulation(spec).run();
  ASSERT_EQ(summary.checks.size(), 3u);
  for (const CheckResult& check : summary.checks) EXPECT_TRUE(check.passed) << check.text;
}

TEST(Coast, LeavesTheExactDensityOutOnLandAndHasNoneFromThere) {
  // The wind blows off the land: behind the cloud comes nothing.
  auto data = wind(0);
  for (double& value : data->values[0])
    if (value == 1) value = -1;
  for (const AtCoast rule : {AtCoast::remove, AtCoast::slide}) {
    Case spec = scene(rule, 0, {"reference.kind=\"characteristics\"", "evaluate.per_axis=41"});
    std::get<FileVelocitySpec>(spec.velocity[0]).data = data;
    const Scene scene_then = make_scene(spec);
    std::vector<double> exact;
    const ReferenceReport report = make_reference(spec, scene_then, 1)->evaluate(0.5, exact);
    EXPECT_EQ(report.untraced, 0u);
    const double radius = 0.2;
    for (std::size_t i = 0; i < 41; ++i) {  // along y = 0, at t = 0.5
      const double x = -1 + 0.05 * static_cast<double>(i), value = exact[20 * 41 + i];
      if (x > coast_at)
        EXPECT_TRUE(std::isnan(value)) << x;
      else if (x + 0.5 > coast_at + 1e-9 && rule == AtCoast::slide)
        EXPECT_TRUE(std::isnan(value)) << x;
      else if (x + 0.5 > coast_at + 1e-9)
        EXPECT_EQ(value, 0) << x;
      else
        EXPECT_NEAR(value, std::exp(-std::pow((x + 0.5) / radius, 2)), 1e-8) << x;
    }
  }
}

TEST(Coast, HasTheBitsOfOneThreadOnRanksAndAfterAStop) {
  for (const AtCoast rule : {AtCoast::stop, AtCoast::slide, AtCoast::remove}) {
    const Case spec = scene(rule, 0.3, {"particles.per_axis=41", "effects.reaction.rate=1+x", "time.step=0.02"});
    Simulation whole(spec, 1), threads(spec, 3), saving(spec, 1), resumed(spec, 1);
    const RunSummary once = whole.run();
    threads.run();
    expect_same(whole.particles(), threads.particles());
    Particles particles;
    std::string state;
    int calls = 0;
    saving.on_progress([&](const Progress& progress) {
      if (progress.time > 0.3 && ++calls == 2) particles = saving.particles(), state = saving.state();
      return true;
    });
    saving.run();
    ASSERT_FALSE(state.empty());
    resumed.restore(particles, state);
    const RunSummary again = resumed.run();
    expect_same(whole.particles(), resumed.particles());
    ASSERT_EQ(again.frames.size(), once.frames.size());
    for (std::size_t i = 0; i < once.frames.size(); ++i) expect_same(again.frames[i].second, once.frames[i].second);
    on_ranks(3, [&](base::Communicator& ranks) {
      Simulation shared(spec, 1, ranks);
      const RunSummary summary = shared.run();
      for (std::size_t i = 0; i < once.frames.size(); ++i) expect_same(summary.frames[i].second, once.frames[i].second);
      const Particles all = shared.all_particles();
      if (ranks.rank() == 0) expect_same(whole.particles(), all);
    });
  }
}

}  // namespace
}  // namespace gaussdrift
