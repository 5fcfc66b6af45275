// Diffusion with a matrix D by core spreading, against closed forms: exact at rest, in a wind and between edges; what it
// lacks in a shear; and what does not go with it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "scene.hpp"

namespace gaussdrift {
namespace {

// As in core_spreading_test.cpp: a Gaussian of radius^2 0.04, blobs of radius^2 0.01. Their sum is a Gaussian with the
// matrix W = 0.05 I + 4 D t, but for a quadrature below exp(-30) and a tail of exp(-25).
double largest_error(const std::vector<std::string>& overrides, const std::string& rho) {
  const std::vector<std::string> all =
      with({"evaluate.tolerance=1e-11", "reference.kind=exact", "reference.rho=" + rho}, overrides);
  double error = 0;
  for (const auto& [time, numbers] : Simulation(scene_of(all)).run().frames)
    error = std::max(error, numbers.error->linf);
  return error;
}

const std::string a = "(0.05+4*0.03*t)", b = "(0.05+4*0.01*t)", c = "(4*0.012*t)";
const std::string det = "(" + a + "*" + b + "-" + c + "^2)";
const std::string form = "(" + b + "*x^2-2*" + c + "*x*y+" + a + "*y^2)/" + det;  // x^T W^-1 x
const std::string aslant = "0.04/sqrt(" + det + ")*exp(-" + form + ")";
const std::vector<std::string> along{"effects.diffusion.D_axes=[0.03, 0.01]"},
    mixed{"effects.diffusion.D_axes=[0.03, 0.01]", "effects.diffusion.D_xy=0.012"};
constexpr double tolerance = 2.5e-11;  // the transform's 1e-11, and the tail exp(-25) = 1.4e-11

TEST(Anisotropic, SpreadsAGaussianExactlyAlongTheAxesInAWind) {
  const std::string rho = "0.04/sqrt(" + a + "*" + b + ")*exp(-(x-0.1*t)^2/" + a + "-(y+0.2*t)^2/" + b + ")";
  EXPECT_LT(largest_error(with(along, {"velocity.u=[\"0.1\", \"-0.2\"]"}), rho), tolerance);
}

TEST(Anisotropic, SpreadsAGaussianExactlyAslant) { EXPECT_LT(largest_error(mixed, aslant), tolerance); }

TEST(Anisotropic, KeepsTheCoefficientsOfDerivatives) {
  // gauss4 smooths by 1 - eps^2/4 Laplacian: of exp(-x^T A x), A = W^-1, that is 4 |A x|^2 - 2 trace A times it.
  const std::string laplacian =
      "(4*((" + b + "*x-" + c + "*y)^2+(" + a + "*y-" + c + "*x)^2)/" + det + "^2-2*(" + a + "+" + b + ")/" + det + ")";
  EXPECT_LT(largest_error(with(mixed, {"particles.cutoff=gauss4"}), aslant + "*(1-0.0025*" + laplacian + ")"),
            tolerance);
}

TEST(Anisotropic, SumsTilesAndPiecesAlike) {
  EXPECT_LT(largest_error(with(mixed, {"evaluate.tile_particles=100", "evaluate.per_axis=65"}), aslant), tolerance);
}

TEST(Anisotropic, DecaysModesBetweenPeriodicAndClosedEdges) {
  // A wave cos(k x) falls by exp(-k^T D k t); blobs smooth it by exp(-eps^2 k^2/4), eps = 0.1.
  const auto waves = [](const std::string& kx, const std::string& ky, const std::string& of, const char* edges_of,
                        const std::vector<std::string>& diffusion, const std::string& rate) {
    const std::string k2 = "(" + kx + "^2+" + ky + "^2)";
    const std::string rho = "1+0.5*exp(-0.0025*" + k2 + "-" + rate + "*t)*" + of;
    std::vector<std::string> scene{"density.expression=1+0.5*" + of, "particles.per_axis=41", edges(edges_of)};
    std::string text = resting_gaussian;
    const std::string shape = resting.density;
    text.replace(text.find(shape), shape.size(), "expression = \"1\"");
    const std::vector<std::string> all =
        with(with({"evaluate.tolerance=1e-11", "reference.kind=exact", "reference.rho=" + rho}, scene), diffusion);
    return Simulation(scene_of(all, text)).run().frames.back().second.error->linf;
  };
  // eps k <= 0.7, and a lattice of 2 eps: aliases of the wave are below exp(-38).
  EXPECT_LT(waves("pi", "(2*pi)", "cos(pi*x+2*pi*y)", "\"periodic\", \"periodic\"", mixed,
                  "(0.03*pi^2+2*0.012*2*pi^2+0.01*4*pi^2)"),
            tolerance);
  EXPECT_LT(
      waves("(pi/2)", "pi", "cos(pi/2*(x+1))*cos(pi*y)", "\"closed\", \"periodic\"", along, "(0.03*pi^2/4+0.01*pi^2)"),
      tolerance);
}

TEST(Anisotropic, HasTheBitsOfANumberWhereAllAxesAreAlike) {
  const auto end = [](const std::vector<std::string>& diffusion) {
    double maximum = 0;
    Simulation simulation(scene_of(diffusion));
    maximum = simulation.run().frames.back().second.maximum;
    return std::pair{maximum, simulation.particles().spread};
  };
  EXPECT_EQ(end({"effects.diffusion.D=0.02"}), end({"effects.diffusion.D_axes=[0.02, 0.02]"}));
}

TEST(Anisotropic, LacksTheDeformationOfWhatItSpreadsAndTellsIt) {
  // Sigma' = A Sigma + Sigma A^T + 2 D in u = (y, 0): what D adds is xx: 2 D_xx t + 2 D_xy t^2 + 2/3 D_yy t^3, xy:
  // 2 D_xy t + D_yy t^2, yy: 2 D_yy t. Core spreading has 2 D t alone.
  Simulation simulation(scene_of(with(mixed, {"velocity.u=[\"y\", \"0\"]", "time.end=1", "output.times=[1]"})));
  const RunSummary summary = simulation.run();
  const Moments m = moments_of(simulation.particles());
  const double s0 = 0.02, t = 1, spread = simulation.particles().spread;
  constexpr double tail = 2.1e-12;  // as in core_spreading_test.cpp
  EXPECT_NEAR(m.xx, s0 * (1 + t * t), tail) << "weights are sheared alone";
  EXPECT_NEAR(m.xy, s0 * t, tail);
  // The largest eigenvalue of D: 0.02 + sqrt(0.01^2 + 0.012^2).
  EXPECT_NEAR(spread, 4 * (0.02 + std::hypot(0.01, 0.012)) * t, 1e-15);
  const std::string warning = summary.effects.at(1).warning;
  EXPECT_NE(warning.find("random-walk"), std::string::npos) << warning;
  // A rotation turns ellipses, though it strains nothing; a wind does not.
  const auto warned = [](const std::vector<std::string>& diffusion, const char* u) {
    return Simulation(scene_of(with(diffusion, {std::string("velocity.u=") + u}))).run().effects.at(1).warning;
  };
  EXPECT_NE(warned(along, "[\"-y\", \"x\"]"), "");
  EXPECT_EQ(warned({"effects.diffusion.D_axes=[0.02, 0.02]"}, "[\"-y\", \"x\"]"), "");
  EXPECT_EQ(warned(mixed, "[\"1-t\", \"t^2\"]"), "");
}

std::string refusal(const std::vector<std::string>& overrides) {
  return message_of<CaseError>([&] { scene_of(overrides); });
}

TEST(Anisotropic, RefusesWhatDoesNotGoWithIt) {
  const auto expect = [](const std::vector<std::string>& overrides, const std::string& part) {
    const std::string message = refusal(overrides);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  const std::string exchange = "effects.diffusion.method=particle-exchange";
  expect({"effects.diffusion.seed=3"}, "has none of \"D\", \"D_axes\", \"D_field\", \"file\"");
  expect(with(along, {"effects.diffusion.D=0.01"}), "has both \"D\" and \"D_axes\"");
  expect({"effects.diffusion.D=0.01", "effects.diffusion.D_xy=0.001"}, "D_xy goes with D_axes");
  expect(with(along, {"effects.diffusion.D_xz=0.001"}), "D_xz is for three dimensions");
  expect(with(along, {"effects.diffusion.D_xy=0.02"}), "has the eigenvalue -0.0023");
  expect(with(along, {exchange}), "needs a D that is the same along all axes");
  expect(with(along, {"effects.remesh.every=2"}), "blobs become ellipses");
  expect(with(along, {"effects.vortex.tolerance=1e-6"}), "blobs become ellipses");
  expect(with(mixed, {edges("\"closed\", \"open\"")}), "does not go with closed edges");
  expect({"effects.diffusion.D_field=0.01"}, "core-spreading needs a constant D");
  expect({"effects.diffusion.D=0.01", "source.point=[0, 0]", "source.at=0.1", "source.amount=1"},
         "core spreading widens the blobs");
  EXPECT_EQ(refusal(with(mixed, {edges("\"periodic\", \"open\"")})), "");
  EXPECT_EQ(refusal({"effects.diffusion.D_axes=[0.02, 0.02]", "effects.remesh.every=2"}), "");
}

TEST(Anisotropic, OfItsCaseStaysNearTheExactDensity) {
  const Case spec =
      read_case(SOURCE_DIR "/cases/anisotropic_puff.toml", {"particles.per_axis=61", "evaluate.per_axis=41"}).spec;
  const RunSummary summary = Simulation(spec, 1).run();
  double worst = 0;
  for (const auto& [time, frame] : summary.frames) worst = std::max(worst, frame.error->linf);
  EXPECT_LT(worst, 0.011);  // (eps/R)^4 of gauss4 at the start: 0.0098
  EXPECT_GT(worst, 0.005) << "the bound is too wide to notice anything";
}

}  // namespace
}  // namespace gaussdrift
