// Core spreading against closed forms: exact at rest and in rigid motion; what it lacks in a shear, measured.
#include <gtest/gtest.h>

#include <cmath>

#include "gaussdrift/error.hpp"
#include "scene.hpp"

namespace gaussdrift {
namespace {

// resting_gaussian: height 1, radius^2 = 0.04, eps = 2 h = 0.1. Blobs and density are Gaussians, so rho_eps^h is one
// too, of radius^2 W = 0.04 + eps^2 + 4 D t, but for the quadrature on the lattice: below exp(-30) at overlap 2, and
// exp(-25) of the density lies outside the domain.
const std::string width = "(0.05+4*0.03*t)";

double largest_error_of_spreading(const std::vector<std::string>& overrides, const std::string& rho) {
  std::vector<std::string> all{"effects.diffusion.D=0.03", "evaluate.tolerance=1e-11", "reference.kind=exact",
                               "reference.rho=" + rho};
  all.insert(all.end(), overrides.begin(), overrides.end());
  const RunSummary summary = Simulation(scene_of(all)).run();
  double error = 0;
  for (const auto& [time, numbers] : summary.frames) error = std::max(error, numbers.error->linf);
  return error;
}

TEST(CoreSpreading, DiffusesAGaussianExactly) {
  const std::string rho = "0.04/" + width + "*exp(-(x^2+y^2)/" + width + ")";
  EXPECT_LT(largest_error_of_spreading({}, rho),
            2.5e-11);  // the transform's tolerance 1e-11, and the tail exp(-25) = 1.4e-11
}

TEST(CoreSpreading, KeepsTheCoefficientsOfDerivatives) {
  // gauss4 smooths by 1 - eps^2/4 Laplacian, eps that of the start: applied to the Gaussian above.
  const std::string rho =
      "0.04/" + width + "*exp(-(x^2+y^2)/" + width + ")*(1-0.01*((x^2+y^2)/" + width + "-1)/" + width + ")";
  EXPECT_LT(largest_error_of_spreading({"particles.cutoff=gauss4"}, rho), 2.5e-11);  // as above
}

TEST(CoreSpreading, IsExactInARigidMotion) {
  // Around the origin with angle t, from (0.1, 0).
  const std::string rho = "0.04/" + width + "*exp(-((x-0.1*cos(t))^2+(y-0.1*sin(t))^2)/" + width + ")";
  const double error =
      largest_error_of_spreading({"velocity.u=[\"-y\", \"x\"]", "density.center=[0.1, 0]", "time.step=0.01"}, rho);
  EXPECT_LT(
      error,
      1.2e-10);  // exp(-(0.9/0.2)^2) = 2e-9 of the density lies outside, its nearest blobs far from the grid: 4e-11
}

TEST(CoreSpreading, LacksTheDeformationOfWhatItSpreads) {
  // u = (y, 0), covariance of the exact solution from s0 I: xx = s0 (1 + t^2) + 2 D t + 2/3 D t^3, xy = s0 t + D t^2,
  // yy = s0 + 2 D t. Core spreading has all terms but those of D with t^2 and t^3, and eps^2/2 of the blobs on xx and
  // yy.
  const double s0 = 0.02, D = 0.01, t = 1, eps = 0.1;
  Simulation simulation(
      scene_of({"velocity.u=[\"y\", \"0\"]", "effects.diffusion.D=0.01", "time.end=1", "output.times=[1]"}));
  const RunSummary summary = simulation.run();
  const Moments m = moments_of(simulation.particles());
  const double blob = (eps * eps + simulation.particles().spread) / 2;
  const double exact_xx = s0 * (1 + t * t) + 2 * D * t + 2. / 3 * D * t * t * t, exact_xy = s0 * t + D * t * t;
  constexpr double tail = 2.1e-12;  // second moment of what lies outside the domain, about exp(-25) of the whole: 7e-13
  EXPECT_NEAR(exact_xx + eps * eps / 2 - (m.xx + blob), 2. / 3 * D * t * t * t, tail);
  EXPECT_NEAR(exact_xy - m.xy, D * t * t, tail);
  EXPECT_NEAR(m.yy + blob, s0 + 2 * D * t + eps * eps / 2, tail);

  ASSERT_EQ(summary.effects.size(), 2u);
  EXPECT_NE(summary.effects[1].warning.find("strains at the rate 0.5"), std::string::npos)
      << summary.effects[1].warning;
}

TEST(CoreSpreading, DoesNotWarnWhereNothingStrains) {
  for (const char* u :
       {"velocity.u=[\"0\", \"0\"]", "velocity.u=[\"-3*y\", \"3*x\"]", "velocity.u=[\"1-t\", \"t^2\"]"}) {
    const RunSummary summary = Simulation(scene_of({u, "effects.diffusion.D=0.01"})).run();
    EXPECT_EQ(summary.effects.at(1).warning, "") << u;
  }
}

TEST(CoreSpreading, WarnsOfTheStrainBetweenTwoRemeshings) {
  // The shear strains at the rate 0.5: by 0.05 in an interval of 0.1, by 0.5 in one of 1; a tenth is told.
  const auto warning = [](const char* every) {
    return Simulation(scene_of({"velocity.u=[\"y\", \"0\"]", "effects.diffusion.D=0.01", "time.end=1", "time.step=0.1",
                                "output.times=[1]", std::string("effects.remesh.every=") + every}))
        .run()
        .effects.at(1)
        .warning;
  };
  EXPECT_EQ(warning("1"), "");
  const std::string rare = warning("10");
  EXPECT_NE(rare.find("exp(0.5)"), std::string::npos) << rare;
  EXPECT_NE(rare.find("more often by [effects.remesh]"), std::string::npos) << rare;
}

TEST(CoreSpreading, GoesTogetherWithReaction) {
  const std::string rho = "exp(-2*t)*0.04/" + width + "*exp(-(x^2+y^2)/" + width + ")";
  EXPECT_LT(largest_error_of_spreading({"effects.reaction.rate=2"}, rho), 2.5e-11);  // as at rest
}

TEST(CoreSpreading, IsConstructedAloneAndKeepsNoArrays) {
  Simulation simulation(scene_of({"effects.diffusion.D=0.03"}));
  const RunSummary summary = simulation.run();
  ASSERT_EQ(summary.effects.size(), 2u) << "transport, and it";
  EXPECT_EQ(summary.effects[1].name, "diffusion");
  EXPECT_TRUE(simulation.particles().path.empty());
  EXPECT_DOUBLE_EQ(simulation.particles().spread, 4 * 0.03 * 0.5);
  EXPECT_EQ(summary.effects.at(1).changes, std::vector<std::string>{"width"});
}

TEST(CoreSpreading, RefusesASpreadBeyondAllNumbers) {
  EXPECT_THROW(Simulation(scene_of({"effects.diffusion.D=1e308", "time.end=1e3", "time.step=1"})), InputError);
}

}  // namespace
}  // namespace gaussdrift
