// Diffusion with a coefficient that depends on place and time, by particle exchange, against exact solutions.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "scene.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift {
namespace {

const std::string exchange = "effects.diffusion.method=particle-exchange";

std::string field(const std::string& expression) { return "effects.diffusion.D_field=" + expression; }

TEST(VaryingDiffusion, IsThatOfANumberWhereTheFieldIsConstant) {
  const auto end = [](const std::string& coefficient) {
    return particles_at_end(scene_of({exchange, coefficient, "time.step=0.05"}), 1);
  };
  const Particles number = end("effects.diffusion.D=0.02"), constant = end(field("0.02+0*x"));
  ASSERT_EQ(number.id, constant.id);
  for (std::size_t j = 0; j < number.size(); ++j)
    EXPECT_NEAR(number.alpha[j], constant.alpha[j], 1e-13 * 0.0025);  // of the largest weight: roots are rounded
}

// d_t rho = D0 div(r^2 grad rho) is d_t rho = D0 (d_ss + 2 d_s) rho in s = ln r, a wave that diffuses: a ring
// exp(-(ln(r/r0))^2 / w^2) becomes w/sqrt(W) exp(-(ln(r/r0) + 2 D0 t)^2 / W), W = w^2 + 4 D0 t.
// There is next to nothing beyond r^2 = 2, where D stays what it is: 2e-4.
constexpr double D0 = 0.06, r0 = 0.6, w2 = 0.04, at_end = 0.2;
const std::vector<std::string> ring{
    exchange,       "domain.min=[-1.5, -1.5]", "domain.max=[1.5, 1.5]", field("0.06*min(2, x^2+y^2)"),
    "time.end=0.2", "output.times=[0.2]",      "evaluate.per_axis=9"};
const std::string ring_density = "density.expression=exp(-log(max(1e-9, sqrt(x^2+y^2))/0.6)^2/0.04)";

std::string without_shape() {
  std::string text = resting_gaussian;
  text.replace(text.find(resting.density), resting.density.size(), "expression = \"1\"");
  return text;
}

double ring_error(const std::vector<std::string>& more) {
  const Case spec = scene_of(with(with(ring, {ring_density}), more), without_shape());
  const Particles end = particles_at_end(spec, 1);
  const double h = 3.0 / (spec.particles.per_axis - 1), W = w2 + 4 * D0 * at_end;
  double largest = 0;
  for (std::size_t j = 0; j < end.size(); ++j) {
    const double s = std::log(std::hypot(end.position[0][j], end.position[1][j]) / r0) + 2 * D0 * at_end;
    largest = std::max(largest, std::abs(end.alpha[j] / (h * h) - std::sqrt(w2 / W) * std::exp(-s * s / W)));
  }
  return largest;
}

TEST(VaryingDiffusion, ConvergesWithTheSquareOfTheCoreRadiusToARing) {
  const double coarse = ring_error({"particles.per_axis=62", "time.step=0.02"}),
               fine = ring_error({"particles.per_axis=122", "time.step=0.008"});
  EXPECT_LT(fine, 0.03);
  EXPECT_NEAR(std::log2(coarse / fine) / std::log2(121. / 61), 2, 0.25);  // eps = 0.1 and 0.05 of a width 0.12
}

TEST(VaryingDiffusion, FollowsARotationThatTheRingDoesNotSee) {
  const std::string turning = "velocity.u=[\"-y\", \"x\"]";
  const double still = ring_error({"particles.per_axis=62", "time.step=0.02"});
  EXPECT_NEAR(ring_error({"particles.per_axis=62", "time.step=0.02", turning}), still, 0.02 * still);
}

// With D = D0 + D1 x the moments are known: <x>' = D1, <x^2>' = 2 D0 + 4 D1 <x>, <y^2>' = 2 D0 + 2 D1 <x>. The mean of
// roots misses terms of order eps^2, for the root of D is no straight line.
TEST(VaryingDiffusion, ComesToTheMomentsOfALinearCoefficientAndKeepsTheMass) {
  const double d0 = 0.02, d1 = 0.01, t = 0.5, mean = d1 * t / 2;  // the last: of <x> over the time
  const auto missing = [&](const char* per_axis) {
    const std::string lattice = std::string("particles.per_axis=") + per_axis;
    const Moments start = moments_of(particles_at_end(scene_of({lattice, "time.end=1e-3", "output.times=[1e-3]"}), 1)),
                  end = moments_of(
                      particles_at_end(scene_of({lattice, exchange, field("0.02+0.01*x"), "time.step=0.02"}), 1));
    EXPECT_NEAR(end.mass, start.mass, 5e-14 * start.mass);  // the mass stays to rounding
    EXPECT_NEAR(end.centroid[1], 0, 1e-15);
    return std::array{end.centroid[0] - d1 * t,
                      end.xx + std::pow(end.centroid[0], 2) - (start.xx + 2 * d0 * t + 4 * d1 * mean * t),
                      end.yy - (start.yy + 2 * d0 * t + 2 * d1 * mean * t)};
  };
  const auto coarse = missing("31"), fine = missing("61");
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    EXPECT_LT(std::abs(coarse[i]), 2e-5);
    EXPECT_LT(std::abs(fine[i]), 0.3 * std::abs(coarse[i]) + 1e-8) << i;  // a quarter, and what the halo holds back
  }
}

TEST(VaryingDiffusion, FollowsTheTimeWithOrderTwo) {
  // D = 0.02 (1 + 4 t): the variance grows by 2 int D = 0.04 (t + 2 t^2), to the order of the splitting.
  const auto missing = [](const char* step) {
    const Particles end = particles_at_end(
        scene_of({exchange, field("0.02*(1+4*t)"), "particles.per_axis=25", std::string("time.step=") + step}), 1);
    const Particles start = particles_at_end(scene_of({"particles.per_axis=25"}));
    return moments_of(end).xx - moments_of(start).xx - 0.04 * (0.5 + 2 * 0.25);
  };
  EXPECT_NEAR(missing("0.05"), 0, 1e-4);
  EXPECT_LT(std::abs(missing("0.025")), 0.3 * std::abs(missing("0.05")) + 5e-9);  // what the halo holds back
}

TEST(VaryingDiffusion, TakesDataOnAGrid) {
  // Rows of numbers, each in the middle of its part of the domain: at x = -2/3, 0 and 2/3.
  const ScratchFolder folder;
  std::ofstream(folder.path() / "D.csv") << "0.01,0.02,0.03\n0.01,0.02,0.03\n";
  const auto end = [&](const std::string& coefficient) {
    const Case spec = gaussdrift::parse_case(resting_gaussian, (folder.path() / "scene.toml").string(),
                                             {exchange, coefficient, "time.step=0.05"})
                          .spec;
    return particles_at_end(spec, 1);
  };
  const Particles data = end("effects.diffusion.file=D.csv"),
                  formula = end(field("0.02+0.015*max(-2/3, min(2/3, x))"));  // beyond the rim its values hold
  ASSERT_EQ(data.id, formula.id);
  for (std::size_t j = 0; j < data.size(); ++j)
    EXPECT_NEAR(data.alpha[j], formula.alpha[j], 1e-13 * 0.0025);  // rounding, of the largest weight
}

TEST(VaryingDiffusion, IsWrittenAndReadAgain) {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "D.csv") << "0.01,0.02,0.03\n0.01,0.02,0.03\n";
  const std::string name = (folder.path() / "scene.toml").string();
  const Case spec =
      gaussdrift::parse_case(resting_gaussian, name, {exchange, "effects.diffusion.file=D.csv", "time.step=0.05"}).spec;
  const Case again = gaussdrift::parse_case(case_text(spec), name).spec;
  EXPECT_EQ(spec.effects, again.effects);
  ASSERT_TRUE(again.effects.find("diffusion")->file);
  EXPECT_EQ(again.effects.find("diffusion")->file->outside, "clamp");
  const std::string message = message_of<CaseError>([&] {
    gaussdrift::parse_case(resting_gaussian, name, {exchange, "effects.diffusion.file=none.csv"});
  });
  EXPECT_NE(message.find("none.csv"), std::string::npos) << message;
  const std::string alone = message_of<CaseError>([&] {
    gaussdrift::parse_case(resting_gaussian, name, {exchange, "effects.diffusion.D=1", "effects.diffusion.array=D"});
  });
  EXPECT_NE(alone.find("\"array\" goes with file"), std::string::npos) << alone;
}

TEST(VaryingDiffusion, RefusesStepsThatAreNotStableWhereItIsLargest) {
  // eps = 0.1, D at most about 0.02 (1 + 2 * 0.5) at t = 0.5: eps^2/(2 D) = 0.125, at the start 0.25.
  const auto refusal = [](const std::string& coefficient) {
    return message_of<InputError>([&] {
      Simulation(scene_of({exchange, coefficient, "time.step=0.2", "particles.per_axis=41"})).prepare();
    });
  };
  EXPECT_EQ(refusal(field("0.02")), "");
  const std::string message = refusal(field("0.02*(1+2*t)"));
  EXPECT_NE(message.find("time.step = 0.2 is not stable with [effects.diffusion]"), std::string::npos) << message;
}

TEST(VaryingDiffusion, NamesThePlaceOfANegativeCoefficient) {
  const std::string message = message_of<NumericalError>([&] {
    particles_at_end(scene_of({exchange, field("0.02*(x+0.5)"), "time.step=0.05"}));
  });
  EXPECT_NE(message.find("the coefficient of [effects.diffusion] is -"), std::string::npos) << message;
}

TEST(VaryingDiffusion, OfItsCaseStaysNearTheExactDensity) {
  const Case spec = read_case(SOURCE_DIR "/cases/uneven_diffusion.toml",
                              {"particles.per_axis=91", "evaluate.per_axis=41", "time.step=0.008"})
                        .spec;
  const RunSummary summary = Simulation(spec, 1).run();
  for (const auto& [time, frame] : summary.frames) {
    EXPECT_LT(frame.error->linf, 0.03);  // of order eps^2: 0.026 at the end
    EXPECT_NEAR(frame.mass, summary.frames.front().second.mass, 5e-14);
  }
  EXPECT_GT(summary.frames.back().second.error->linf, 0.015) << "the bound is too wide to notice anything";
}

}  // namespace
}  // namespace gaussdrift
