// Sizes, places and numbers at the edge of what double precision can do.
#include <gtest/gtest.h>

#include <cstring>
#include <fgtd/fgtd.hpp>
#include <numbers>

#include "gaussdrift/error.hpp"
#include "scenes.hpp"

namespace gaussdrift {
namespace {

using std::numbers::pi;

/// A cone in a vortex about the middle of [origin, origin + size]^2, all lengths in units of `size`.
std::string vortex(const std::string& size, const std::string& origin = "0") {
  return case_text({.params = "s = \"(" + size + ")\"\no = \"(" + origin + ")\"",
                    .domain = "min = [\"o\", \"o\"]\nmax = [\"o + s\", \"o + s\"]",
                    .velocity = velocity_of({"-(y - o - s/2)", "x - o - s/2"}),
                    .density = shape_of("wendland", "\"o + 0.75*s\", \"o + s/2\"", "\"0.2*s\""),
                    .particles = "per_axis = 65",
                    .time = "end = 1\nstep = 0.05",
                    .evaluate = "per_axis = 33"});
}

TEST(Scale, ByPowersOfTwoChangesNoBit) {
  const Ran one = run(written(vortex("1")));
  for (const char* size : {"2^-30", "2^30", "2^-100"}) {
    const Ran scaled = run(written(vortex(size)));
    ASSERT_EQ(scaled.particles.size(), one.particles.size()) << size;
    for (std::size_t i = 0; i < one.summary.frames.size(); ++i) {
      const FrameNumbers &a = one.summary.frames[i].second, &b = scaled.summary.frames[i].second;
      EXPECT_EQ(a.maximum, b.maximum) << size;
      EXPECT_EQ(a.minimum, b.minimum) << size;
      EXPECT_EQ(a.error->linf, b.error->linf) << size;
    }
  }
}

TEST(Scale, OfANanometreAndOfAMillionKilometresChangesOnlyRounding) {
  const Ran one = run(written(vortex("1")));
  for (const char* size : {"1e-9", "1e9"}) {
    const Ran scaled = run(written(vortex(size)));
    EXPECT_NEAR(scaled.last().maximum, one.last().maximum, 7.6e-15) << size;
    EXPECT_NEAR(scaled.last().error->linf, one.last().error->linf, 7.6e-15) << size;
  }
}

TEST(Place, FarFromTheOriginCostsOnlyTheDigitsOfThePlace) {
  const Ran near = run(written(vortex("1"))), far = run(written(vortex("1", "1e6")));
  ASSERT_EQ(far.particles.size(), near.particles.size());
  // Coordinates are right to 1e-10, a step adds as much; slopes of the density are at most 2.1/0.2.
  EXPECT_NEAR(far.last().maximum, near.last().maximum, 20 * 1.2e-10 * 2.1 / 0.2 + 1e-8);
  EXPECT_NEAR(far.last().centroid[0] - 1e6, near.last().centroid[0], 20 * 1.2e-10);
}

TEST(Overlap, FromGapsToMushIsAsPredicted) {
  // Ripples of two axes multiply, and ten steps of rk4 shrink the lattice by 7e-8.
  // A Gaussian of radius R, smoothed by eps, has the height R^2 / (R^2 + eps^2); with gaps the sum ripples by
  // 2 exp(-pi^2 c^2) an axis.
  for (const double c : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0}) {
    const double R = 0.25, h = 2.0 / 80, eps = c * h;
    const Ran ran =
        run(built_in("rotating_cone", {"density.shape=gaussian", "density.center=[0, 0]", "density.radius=0.25",
                                       "particles.per_axis=81", "particles.overlap=" + std::to_string(c), "time.end=1",
                                       "time.step=0.1", "output.times=[0, 1]", "evaluate.per_axis=81"}));
    const double height = R * R / (R * R + eps * eps), ripple = 4 * std::exp(-pi * pi * c * c);
    for (const auto& [time, numbers] : ran.summary.frames)
      EXPECT_NEAR(numbers.maximum, height, height * ripple * 1.2 + 2e-7) << "c = " << c << " at " << time;
  }
}

TEST(Blobs, WiderThanTheDomainAreSummedRight) {
  const Case scene = built_in("rotating_cone", {"particles.per_axis=21", "particles.overlap=40", "time.step=0.1",
                                                "evaluate.per_axis=11", "output.times=[0, 1]", "time.end=1"});
  const Ran ran = run(scene);
  EXPECT_LT(ran.last().transform_error, 1e-8);  // evaluate.tolerance, here and in the next line
  EXPECT_NEAR(ran.last().maximum, density_at(scene, ran.particles, 0.2, 0.4), 1e-8 * ran.last().maximum);
  EXPECT_GT(ran.last().minimum, 0);
}

TEST(Blobs, NarrowerThanTheGridAreSummedRight) {
  const Case scene = built_in("rotating_cone", {"particles.per_axis=300", "evaluate.per_axis=7", "time.step=0.1",
                                                "output.times=[0]", "time.end=1"});
  const Ran ran = run(scene);  // eps = 0.013, grid spacing 1/3: one point at (1/3, 0), 0.17 from the centre
  Simulation at_start(scene);
  at_start.prepare();
  EXPECT_NEAR(ran.last().maximum, density_at(scene, at_start.particles(), 1. / 3, 0),
              1e-8);  // evaluate.tolerance, here and in the next line
  EXPECT_LT(ran.last().transform_error, 1e-8);
}

TEST(Points, AMillionOnOnePlaceAreOneHeavyOne) {
  constexpr Eigen::Index count = 1'000'000;
  fgtd::Points<2> sources(2, count);
  sources.row(0).setConstant(0.3);
  sources.row(1).setConstant(-0.7);
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(count, 1);
  fgtd::Points<2> targets(2, 3);
  targets << 0.3, 0.31, 5, -0.7, -0.7, 5;
  for (const double sigma : {1e-6, 1.0, 1e6}) {
    const Eigen::MatrixXd sum = fgtd::Plan<2>(sources, weights, sigma, {.tolerance = 1e-10}).evaluate(targets);
    for (int i = 0; i < 3; ++i) {
      const double square = (targets.col(i) - sources.col(0)).squaredNorm();
      EXPECT_NEAR(sum(i, 0), 1e6 * std::exp(-sigma * square), 1e6 * 1.1e-10) << sigma;
    }
  }
}

TEST(Points, ThatAFlowDrivesTogetherKeepTheirMass) {
  // u = -20 x over t = 1: 5000 particles within 2e-9 of the origin, which is one blob.
  const Ran ran = run(written(case_text({.velocity = velocity_of({"-20*x", "-20*y"}),
                                         .density = shape_of("disk", "0, 0", "0.8"),
                                         .particles = "per_axis = 100",
                                         .time = "end = 1\nstep = 0.01",
                                         .evaluate = "per_axis = 41"})));
  const double eps = 2 * 2. / 99;
  EXPECT_EQ(ran.last().mass, ran.summary.frames.front().second.mass);
  EXPECT_NEAR(ran.last().maximum, ran.last().mass / (pi * eps * eps),
              1e-8 * ran.last().maximum);  // one blob, to evaluate.tolerance
}

TEST(Times, ThatDoubleCannotHoldAreLandedOn) {
  const Ran ran = run(written(vortex("1"), {"time.end=0.1*3", "time.step=0.1", "output.times=[0.1, 0.2, 0.3]"}));
  EXPECT_EQ(ran.summary.steps, 3u);  // no step of 5e-17
  ASSERT_EQ(ran.summary.frames.size(), 3u);
  const Ran whole = run(written(vortex("1"), {"time.end=0.3", "time.step=0.1", "output.times=[0.3]"}));
  EXPECT_NEAR(ran.last().maximum, whole.last().maximum, 6.7e-16);
}

/// u = -k (x, y): rk4 is stable up to k tau = 2.785.
Case decaying_flow(double step) {
  return written(case_text({.velocity = velocity_of({"-10*x", "-10*y"}),
                            .density = shape_of("gaussian", "0, 0", "0.3"),
                            .particles = "per_axis = 41",
                            .time = "end = 20\nstep = " + std::to_string(step),
                            .reference = not_compared,
                            .output = output_at("20")}));
}

TEST(Step, JustBelowItsLimitStaysBoundedAndJustAboveIsRefused) {
  constexpr double limit = 0.27853;  // 2.7853 / 10
  const Ran ran = run(decaying_flow(0.99 * limit));
  for (int k = 0; k < 2; ++k)
    for (const double x : ran.particles.position[k]) EXPECT_LE(std::abs(x), 0.04);
  try {
    run(decaying_flow(1.01 * limit));
    FAIL() << "a step beyond the limit was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("Use time.step <= 0.278"), std::string::npos) << error.what();
  }
}

TEST(Threads, ChangeNoBitOfTheHardCases) {
  for (const Case& scene :
       {written(vortex("1e-9")), written(vortex("1", "1e6")), decaying_flow(0.2),
        built_in("swirl_remesh", {"particles.per_axis=81", "time.end=1", "output.times=[1]", "evaluate.per_axis=31"}),
        built_in("stiff_reaction", {"particles.per_axis=80", "evaluate.per_axis=31"}),
        built_in("shear_diffusion", {"particles.per_axis=61", "evaluate.per_axis=31"})}) {
    const Ran one = run(scene, 1), two = run(scene, 2);
    ASSERT_EQ(one.particles.size(), two.particles.size());
    for (int k = 0; k < one.particles.dimension; ++k) EXPECT_EQ(one.particles.position[k], two.particles.position[k]);
    EXPECT_EQ(one.particles.alpha, two.particles.alpha);
    EXPECT_EQ(one.last().maximum, two.last().maximum);
    EXPECT_EQ(one.last().mass, two.last().mass);
  }
}

TEST(Stretch, TellsWhereTheOverlapIsLost) {
  // A shear by gamma t = 3 moves neighbours along y to sqrt(1 + 9) spacings.
  const Ran ran = run(written(case_text({.velocity = velocity_of({"3*y", "0"}),
                                         .density = shape_of("disk", "0, 0", "0.5"),
                                         .particles = "per_axis = 41",
                                         .time = "end = 1\nstep = 0.1"})));
  EXPECT_NEAR(ran.summary.frames[0].second.stretch, 1, 2.7e-15);
  EXPECT_NEAR(ran.summary.frames[1].second.stretch, std::sqrt(10.), 6.4e-14);
}

}  // namespace
}  // namespace gaussdrift
