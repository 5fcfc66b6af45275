// Diffusion by a random walk. Chance has laws: a mean of n independent numbers of variance v deviates by sqrt(v/n), and by
// more than five times that in one of two million trials. Seeds are fixed, so that a test that passes does so always.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "effect/random_walk.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"
#include "scene.hpp"
#include "scratch_folder.hpp"
#include "share_from.hpp"

namespace gaussdrift {
namespace {

const std::string walk = "effects.diffusion.method=random-walk";
constexpr double sigmas = 5;

/// rho = 1 on a lattice of 100 x 100 in the unit square between the given edges.
Case even_scene(const std::vector<std::string>& overrides, const std::string& density = "1") {
  const CaseTables even{.domain = unit_square,
                        .velocity = at_rest,
                        .density = "expression = \"" + density + "\"",
                        .particles = "per_axis = 101\noverlap = 4",
                        .time = "end = 0.5\nstep = 0.01",
                        .evaluate = "per_axis = 33"};
  return scene_of(with({walk}, overrides), case_text(even));
}
const std::string closed = edges("\"closed\", \"periodic\"");

/// sum over cells of (count - mean)^2 / mean for cells of the unit square, per degree of freedom: 1 with the deviation
/// sqrt(2 / (cells - 1)) where particles are independent and even.
double unevenness(const std::vector<double>& x, int cells) {
  std::vector<double> counts(static_cast<std::size_t>(cells));
  for (const double place : x)
    counts[static_cast<std::size_t>(std::min(cells - 1, static_cast<int>(place * cells)))] += 1;
  const double mean = static_cast<double>(x.size()) / cells;
  double sum = 0;
  for (const double count : counts) sum += (count - mean) * (count - mean) / mean;
  return sum / (cells - 1);
}

TEST(RandomWalk, MovesParticlesByTheMomentsOfItsMatrix) {
  // Steps of one particle each, in space: 20000 draws with D t = matrix / 20.
  RandomWalk::Options options{.diffusion = {{{0.3, 0.1, -0.05}, {0.1, 0.2, 0.04}, {-0.05, 0.04, 0.1}}}, .seed = 5};
  RandomWalk effect(options);
  Particles particles;
  particles.dimension = 3;
  constexpr std::size_t count = 20000;
  for (auto& axis : particles.position) axis.assign(count, 0.0);
  particles.alpha.assign(count, 1.0);
  for (std::size_t j = 0; j < count; ++j) particles.id.push_back(static_cast<std::int64_t>(j));
  effect.scatter(particles, {.number = 4, .time = 0, .length = 0.05});
  for (std::size_t k = 0; k < 3; ++k) {
    double mean = 0;
    for (const double x : particles.position[k]) mean += x / count;
    const double variance = 2 * options.diffusion[k][k] * 0.05;
    EXPECT_LT(std::abs(mean), sigmas * std::sqrt(variance / count));
    for (std::size_t l = 0; l <= k; ++l) {
      double product = 0;
      for (std::size_t j = 0; j < count; ++j) product += particles.position[k][j] * particles.position[l][j] / count;
      const double exact = 2 * options.diffusion[k][l] * 0.05, other = 2 * options.diffusion[l][l] * 0.05;
      EXPECT_LT(std::abs(product - exact), sigmas * std::sqrt((variance * other + exact * exact) / count)) << k << l;
    }
  }
}

TEST(RandomWalk, DrawsForAParticleByItsIdAlone) {
  // The same particles in another order and company, on one thread and on three.
  RandomWalk one({.diffusion = {{{0.01, 0.002}, {0.002, 0.03}}}, .seed = 9, .threads = 1}),
      three({.diffusion = {{{0.01, 0.002}, {0.002, 0.03}}}, .seed = 9, .threads = 3});
  Particles few, many;
  for (int j = 0; j < 3000; ++j) {
    for (Particles* some : {&few, &many}) {
      if (some == &few && j % 7 != 0) continue;
      some->position[0].push_back(j), some->position[1].push_back(-j);
      some->alpha.push_back(1), some->id.push_back(j * j);
    }
  }
  const ShareFrom shared(0);
  one.scatter(few, {.number = 11, .time = 0, .length = 0.1});
  three.scatter(many, {.number = 11, .time = 0, .length = 0.1});
  for (std::size_t j = 0; j < few.size(); ++j)
    for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(few.position[k][j], many.position[k][7 * j]);
}

// The covariance of the particles follows Sigma' = A Sigma + Sigma A^T + 2 D, with the splitting's order 2 in the step.
TEST(RandomWalk, FollowsAShearWithAMatrix) {
  const std::vector<std::string> scene{walk,
                                       "velocity.u=[\"y\", \"0\"]",
                                       "effects.diffusion.D_axes=[0.03, 0.01]",
                                       "effects.diffusion.D_xy=0.012",
                                       "time.end=1",
                                       "time.step=0.1",
                                       "output.times=[1]",
                                       "particles.per_axis=161"};
  const Particles end = particles_at_end(scene_of(scene), 1),
                  start = particles_at_end(scene_of({"particles.per_axis=161"}), 1);
  const Moments m = moments_of(end), before = moments_of(start);
  const double s0 = 0.02, t = 1, xx = s0 * (1 + t * t) + 2 * 0.03 * t + 2 * 0.012 * t * t + 2. / 3 * 0.01 * t * t * t,
               xy = s0 * t + 2 * 0.012 * t + 0.01 * t * t, yy = s0 + 2 * 0.01 * t;
  EXPECT_NEAR(m.mass, before.mass, 1e-15);
  double squares = 0;  // weights differ: as many as 1 / sum of squares of equal ones
  for (const double alpha : end.alpha) squares += alpha * alpha / (m.mass * m.mass);
  const double step = 0.1 * 0.1 / 6;  // of the splitting, relative to what is integrated
  EXPECT_LT(std::abs(m.xx - xx), sigmas * xx * std::sqrt(2 * squares) + step * xx);
  EXPECT_LT(std::abs(m.yy - yy), sigmas * yy * std::sqrt(2 * squares) + step * yy);
  EXPECT_LT(std::abs(m.xy - xy), sigmas * std::sqrt((xx * yy + xy * xy) * squares) + step * xy);
  EXPECT_GT(xy, 20 * sigmas * std::sqrt((xx * yy + xy * xy) * squares) / 5) << "it tells";
}

// D varies by a factor of 19 over the box. Without its gradient particles would gather where it is small.
TEST(RandomWalk, LeavesAnEvenDensityEvenWhereDVaries) {
  const std::string coefficient = "0.05*(1+0.9*cos(pi*x))";
  const Particles end = particles_at_end(even_scene({"effects.diffusion.D_field=" + coefficient, closed}), 1);
  ASSERT_EQ(end.size(), 10000u);
  constexpr int cells = 50;
  EXPECT_LT(unevenness(end.position[0], cells), 1 + sigmas * std::sqrt(2. / (cells - 1)));
  EXPECT_LT(unevenness(end.position[1], cells), 1 + sigmas * std::sqrt(2. / (cells - 1)));
  EXPECT_GT(unevenness(end.position[0], cells), 0.1) << "particles have left their lattice";
  for (const double x : end.position[0]) EXPECT_TRUE(x >= 0 && x <= 1);

  // What the measure says of a walk that takes the coefficient of where it starts: it is far from even.
  RandomWalk unit({.diffusion = {{{1, 0}, {0, 1}}}, .seed = 3});
  Particles naive = particles_at_end(even_scene({"effects.diffusion.D=0.05", closed, "time.end=0.01"}), 1);
  Particles draws = naive;
  for (std::uint64_t step = 0; step < 50; ++step) {
    for (auto& axis : draws.position) axis.assign(axis.size(), 0.0);
    unit.scatter(draws, {.number = step, .time = 0, .length = 0.01});
    for (std::size_t j = 0; j < naive.size(); ++j) {
      double& x = naive.position[0][j];
      x += std::sqrt(0.05 * (1 + 0.9 * std::cos(std::numbers::pi * x))) * draws.position[0][j];
      x = std::abs(x);
      if (x > 1) x = 2 - x;
    }
  }
  EXPECT_GT(unevenness(naive.position[0], cells), 3);
}

// d/dx D0 (1 - x^2) d/dx has the eigenfunction x with -2 D0 (Legendre): a slope falls by exp(-2 D0 t) in [-1, 1], where
// D is 0 at the faces. The mean of x is a third of the slope.
TEST(RandomWalk, HasTheRateOfAnEigenfunction) {
  const CaseTables slope{.velocity = at_rest,
                         .density = "expression = \"1+0.8*x\"",
                         .particles = "per_axis = 121\noverlap = 4",
                         .time = "end = 1\nstep = 0.02",
                         .evaluate = "per_axis = 9"};
  const Particles end = particles_at_end(
      scene_of({walk, "effects.diffusion.D_field=0.3*max(0, 1-x^2)", edges("\"closed\", \"periodic\"")},
               case_text(slope)),
      1);
  const Moments m = moments_of(end);
  double squares = 0;
  for (const double alpha : end.alpha) squares += alpha * alpha / (m.mass * m.mass);
  const double exact = 0.8 / 3 * std::exp(-2 * 0.3), step = 0.02 * 0.3;  // weak order 1 in the step
  EXPECT_LT(std::abs(m.centroid[0] - exact), sigmas * std::sqrt(squares / 3) + step * exact);
}

// Noise of the density as the warning tells it: the root mean square over the grid of an even density.
TEST(RandomWalk, HasTheNoiseThatItTells) {
  double sum = 0;
  std::size_t count = 0;
  Simulation simulation(even_scene({"effects.diffusion.D=0.05", edges("\"periodic\", \"periodic\""),
                                    "particles.cutoff=gauss4", "particles.per_axis=101"}),
                        1);
  simulation.observe("noise", [&](const Frame& frame) {
    if (frame.time == 0) return;
    for (const double rho : frame.density->rho) sum += (rho - 1) * (rho - 1), ++count;
  });
  const RunSummary summary = simulation.run();
  const auto& numbers = summary.effects.at(1).numbers;
  double told = 0;
  for (const auto& [name, value] : numbers)
    if (name == "particles_in_a_blob") told = 1 / std::sqrt(value);
  // Some 2 pi (eps/h)^2 = 100 particles a blob, so the grid shows 100 independent blobs: a tenth or so.
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(count)) / told, 1, 0.25);
  EXPECT_NE(summary.effects.at(1).warning.find("particles share a blob"), std::string::npos);
}

TEST(RandomWalk, ErrorFallsWithTheRootOfTheNumber) {
  // The density against the exact puff, at four times and sixteen times as many particles a blob.
  const auto error = [](const char* per_axis, const char* overlap) {
    const std::string width = "(0.04+0.04+4*0.03*t)";  // eps = 0.2
    return Simulation(
               scene_of({walk, "effects.diffusion.D=0.03", "reference.kind=exact",
                         "reference.rho=0.04/" + width + "*exp(-(x^2+y^2)/" + width + ")",
                         std::string("particles.per_axis=") + per_axis, std::string("particles.overlap=") + overlap}),
               1)
        .run()
        .frames.back()
        .second.error->l2;
  };
  const double coarse = error("41", "4"), fine = error("161", "16");
  EXPECT_LT(fine, 0.5 * coarse);  // a quarter is expected, and the error of either is one of chance
  EXPECT_GT(fine, 0.1 * coarse);
}

// A wall that takes: 1 - x diffuses to 0 at x = 1 and is held by a mirror at x = 0. Steps see what crosses at their ends
// only, as if the wall stood 0.5826 sqrt(2 D tau) farther [Sie79].
TEST(RandomWalk, LosesThroughAnOpenEdgeWhatTheStepsSee) {
  const double D = 0.1, end = 0.5;
  const auto stays = [&](double length) {  // of an even density between a mirror and a wall that takes, in time
    // rho = sum_n a_n cos(k_n x) exp(-D k_n^2 t), a_n = 2/L int_0^1 cos(k_n x) dx = 2 sin(k_n) / (L k_n).
    double mass = 0;
    for (int n = 0; n < 50; ++n) {
      const double k = (n + 0.5) * std::numbers::pi / length;
      mass += 2 * std::sin(k) / (length * k) * std::sin(k * length) / k * std::exp(-D * k * k * end);
    }
    return mass;
  };
  const auto stayed = [&](const char* step) {
    const Particles left =
        particles_at_end(even_scene({"effects.diffusion.D=0.1", edges("[\"closed\", \"open\"], \"periodic\""),
                                     std::string("time.step=") + step}),
                         1);
    return static_cast<double>(left.size()) / 10000;
  };
  for (const auto& [text, tau] : {std::pair{"0.02", 0.02}, {"0.005", 0.005}}) {
    const double seen = stays(1 + 0.5826 * std::sqrt(2 * D * tau)), found = stayed(text);
    EXPECT_LT(std::abs(found - seen), sigmas * std::sqrt(seen * (1 - seen) / 10000)) << text;
    EXPECT_GT(seen, stays(1));
  }
}

TEST(RandomWalk, HasTheSameBitsOnThreadsAndRanksAndAnotherSeedHasOthers) {
  const auto scene = [](const std::string& seed) {
    return even_scene({"effects.diffusion.D_field=0.05*(1+0.5*x)", closed, "particles.per_axis=31", "time.end=0.05",
                       "velocity.u=[\"sin(pi*x)\", \"0.3\"]", "evaluate.tile_particles=100",
                       "effects.diffusion.seed=" + seed});
  };
  const Case spec = scene("7");
  const ShareFrom shared(0);
  const Particles one = particles_at_end(spec, 1);
  expect_same(one, particles_at_end(spec, 3));
  on_ranks(3, [&](base::Communicator& ranks) {
    Simulation simulation(spec, 1, ranks);
    simulation.run();
    const Particles all = simulation.all_particles();
    if (ranks.rank() == 0) expect_same(all, one);
  });
  const Particles other = particles_at_end(scene("8"), 1);
  EXPECT_NE(one.position[0], other.position[0]);
}

TEST(RandomWalk, RefusesWhatDoesNotGoWithIt) {
  const auto refusal = [](const std::vector<std::string>& overrides) {
    return message_of<CaseError>([&] { scene_of(with({walk, "effects.diffusion.D=0.01"}, overrides)); });
  };
  const auto expect = [&](const std::vector<std::string>& overrides, const std::string& part) {
    const std::string message = refusal(overrides);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect({"time.method=dopri5"}, "do not go with [effects.diffusion] method = ");
  expect({"effects.remesh.every=2"}, "a random walk parts particles");
  expect({"effects.diffusion.tolerance=1e-5"}, "\"tolerance\" goes with method");
  EXPECT_EQ(refusal({"effects.vortex.tolerance=1e-6"}), "") << "random vortices";
  EXPECT_EQ(refusal({"effects.reaction.rate=1"}), "");
  EXPECT_EQ(refusal({edges("\"open\", \"closed\""), "source.point=[0, 0]", "source.at=0.1", "source.amount=1"}), "");
}

TEST(RandomWalk, OfItsCaseStaysNearTheExactDensityButForItsNoise) {
  const Case spec =
      read_case(SOURCE_DIR "/cases/random_walk.toml", {"particles.per_axis=121", "evaluate.per_axis=31"}).spec;
  const RunSummary summary = Simulation(spec, 1).run();
  for (const auto& [time, frame] : summary.frames) {
    EXPECT_EQ(frame.mass, summary.frames.front().second.mass);
    if (time == 0) continue;
    EXPECT_LT(frame.error->l2, 0.12);  // 161 particles a blob: 0.079, and more at the walls, where images are alike
    EXPECT_GT(frame.error->l2, 0.05) << "chance has no part in it";
  }
}

// An island in still water: an even density stays even, and nobody comes on land. Moves that would end there are taken
// back.
TEST(RandomWalk, KeepsAnEvenDensityEvenBesideACoast) {
  const ScratchFolder folder;
  // Water 16 cells wide between land to the left and a mirror: u = 0 there, no value on land.
  std::ofstream(folder / "still.vtk") << [] {
    std::string text =
        "# vtk DataFile Version 3.0\nstill\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 21 21 1\nORIGIN 0 0 0\n"
        "SPACING 0.05 0.05 1\nPOINT_DATA 441\nVECTORS u double\n";
    for (int i = 0; i < 441; ++i) text += i % 21 < 5 ? "nan nan nan\n" : "0 0 0\n";
    return text;
  }();
  const CaseTables still{.domain = unit_square + "\ncoast = \"slide\"",
                         .velocity = "file = \"still.vtk\"",
                         .density = "expression = \"max(0, sign(x-0.23))\"",
                         .particles = "per_axis = 101\noverlap = 4",
                         .time = "end = 0.4\nstep = 0.02",
                         .evaluate = "per_axis = 9"};
  const Case spec = gaussdrift::parse_case(case_text(still), (folder / "scene.toml").string(),
                                           {walk, "effects.diffusion.D=0.05", closed})
                        .spec;
  const Particles end = particles_at_end(spec, 1);
  std::vector<double> places;  // as a part of the water, which reaches from 0.225 to 1
  for (const double x : end.position[0]) places.push_back((x - 0.225) / 0.775);
  EXPECT_GE(*std::min_element(places.begin(), places.end()), -1e-6);
  constexpr int cells = 40;
  for (double& place : places) place = std::clamp(place, 0.0, 1.0);
  EXPECT_LT(unevenness(places, cells), 1 + sigmas * std::sqrt(2. / (cells - 1)));
  EXPECT_GT(unevenness(places, cells), 0.1) << "particles have left their lattice";
}

}  // namespace
}  // namespace gaussdrift
