// Flows and densities with closed forms that the gallery does not show: eddies on a turning plane, viscous cells, a
// puff.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "case_text.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"

namespace gaussdrift {
namespace {

using std::numbers::pi;

Case spec_of(const std::string& text) { return parse_case(text, "scene.toml").spec; }

/// Largest distance of the particles at the end from where the closed form has them.
template <class Flow>
double largest_error(const Case& spec, const Flow& flow) {
  Simulation simulation(spec);
  simulation.prepare();
  const Particles start = simulation.particles();
  simulation.run();
  double largest = 0;
  for (std::size_t j = 0; j < start.size(); ++j) {
    const auto [x, y] = flow(start.position[0][j], start.position[1][j]);
    largest = std::max(
        largest, std::hypot(simulation.particles().position[0][j] - x, simulation.particles().position[1][j] - y));
  }
  return largest;
}

/// Eddies of Fabbroni in units of 100 km and of 1/f: u0 = 0.3 m/s, u_g = 0.04 m/s, f = 1e-4/s, and six hours.
std::string eddy(const std::string& u, const std::string& v) {
  return case_text({.params = "u0 = 0.03\nug = 0.004\ng = 0.04\ngg = 0.004\nT = 2.16",
                    .domain = unit_square,
                    .velocity = velocity_of({u.c_str(), v.c_str()}),
                    .density = shape_of("disk", "0.5, 0.5", "0.3"),
                    .time = "end = \"T\"\nstep = 0.01",
                    .evaluate = "per_axis = 5",
                    .reference = not_compared,
                    .output = output_at("\"T\"")});
}

TEST(FabbroniEddies, AreFollowedToTwelveDigits) {
  const double u0 = 0.03, ug = 0.004, g = 0.04, gg = 0.004, T = 2.16;
  // rk4 with steps of 0.01: 216 steps, each 0.01^5/120 of 0.03; published tests of others allow 1e-5.
  constexpr double bound = 5.5e-13;
  EXPECT_LT(
      largest_error(spec_of(eddy("u0*cos(t)", "-u0*sin(t)")),
                    [&](double x, double y) { return std::pair(x + u0 * std::sin(T), y - u0 * (1 - std::cos(T))); }),
      bound);
  EXPECT_LT(largest_error(spec_of(eddy("ug + (u0 - ug)*cos(t)", "-(u0 - ug)*sin(t)")),
                          [&](double x, double y) {
                            return std::pair(x + ug * T + (u0 - ug) * std::sin(T), y - (u0 - ug) * (1 - std::cos(T)));
                          }),
            bound);
  // Decaying: int e^{-g s} cos s ds = (g + e^{-gT}(sin T - g cos T)) / (1 + g^2), and likewise for sin.
  EXPECT_LT(largest_error(spec_of(eddy("ug*exp(-gg*t) + (u0 - ug)*exp(-g*t)*cos(t)", "-(u0 - ug)*exp(-g*t)*sin(t)")),
                          [&](double x, double y) {
                            const double e = std::exp(-g * T), c = std::cos(T), s = std::sin(T);
                            return std::pair(
                                x + ug * (1 - std::exp(-gg * T)) / gg + (u0 - ug) * (g + e * (s - g * c)) / (1 + g * g),
                                y - (u0 - ug) * (1 - e * (c + g * s)) / (1 + g * g));
                          }),
            bound);
}

TEST(ViscousTaylorGreenCells, AreTheSamePathsAtAnotherPace) {
  // With u = (sin x cos y, -cos x sin y) e^{-2 nu t} a path is that of the steady cells at s = (1 - e^{-2 nu t}) / (2
  // nu).
  const auto particles_of = [](const std::string& factor, double end) {
    const Case spec =
        spec_of(case_text({.params = "T = " + std::to_string(end),
                           .domain = "min = [0, 0]\nmax = [3, 3]",
                           .velocity = "u = [\"sin(x)*cos(y)*" + factor + "\", \"-cos(x)*sin(y)*" + factor + "\"]",
                           .density = shape_of("disk", "1, 1.2", "0.6"),
                           .particles = "per_axis = 31",
                           .time = "end = \"T\"\nstep = 0.005",
                           .evaluate = "per_axis = 5",
                           .reference = not_compared,
                           .output = output_at("\"T\"")}));
    Simulation simulation(spec);
    simulation.run();
    return simulation.particles();
  };
  const Particles viscous = particles_of("exp(-0.4*t)", 2), steady = particles_of("1", (1 - std::exp(-0.8)) / 0.4);
  ASSERT_EQ(viscous.size(), steady.size());
  for (std::size_t j = 0; j < viscous.size(); ++j)
    for (int k = 0; k < 2; ++k)  // end of `steady` is written with six digits: 5e-7 of time
      EXPECT_NEAR(viscous.position[k][j], steady.position[k][j], 6e-7);
}

TEST(Puff, DriftsSpreadsAndDecaysAsItsFormulaSays) {
  // rho = R^2/w exp(-|x - U t|^2/w - k t), w = R^2 + 4 D t: core spreading is exact in a uniform flow, and the decay
  // is.
  const Case spec = spec_of(case_text({.params = "D = 0.004\nk = 0.7",
                                       .velocity = "field = \"translation\"\nvelocity = [0.3, -0.2]",
                                       .density = shape_of("gaussian", "-0.2, 0.1", "0.15"),
                                       .particles = "per_axis = 161\noverlap = 2\ncutoff = \"gauss8\"",
                                       .time = "end = 1\nstep = 0.25",
                                       .evaluate = "per_axis = 61\ntolerance = 1e-10",
                                       .reference = R"text(kind = "exact"
rho = "0.0225/(0.0225 + 4*D*t)*exp(-((x + 0.2 - 0.3*t)^2 + (y - 0.1 + 0.2*t)^2)/(0.0225 + 4*D*t) - k*t)")text",
                                       .output = output_at("0, 0.5, 1")}) +
                            "[effects.diffusion]\nD = \"D\"\n[effects.reaction]\nrate = \"k\"\n");
  Simulation simulation(spec);
  const RunSummary summary = simulation.run();
  for (const auto& [time, numbers] : summary.frames) {
    EXPECT_LT(numbers.error->linf, 1.6e-6) << time;  // gauss8 with eps/R = 1/6: (eps/R)^8
    EXPECT_NEAR(numbers.mass / summary.frames.front().second.mass, std::exp(-0.7 * time), 1e-14);
  }
}

TEST(MolenkampCrowley, ComesBackAfterATurn) {
  // Their Gaussian 0.01^{4 r^2} about (-1/2, 0), one turn with u = 2 pi (-y, x).
  const Case spec = spec_of(case_text({.domain = "min = [-1.5, -1.5]\nmax = [1.5, 1.5]",
                                       .velocity = velocity_of({"-2*pi*y", "2*pi*x"}),
                                       .density = "expression = \"0.01^(4*((x + 0.5)^2 + y^2))\"",
                                       .particles = "per_axis = 201\ncutoff = \"gauss6\"",
                                       .time = "end = 1\nstep = 0.005",
                                       .evaluate = "per_axis = 61",
                                       .output = output_at("0, 1")}));
  Simulation simulation(spec);
  const auto frames = simulation.run().frames;
  EXPECT_NEAR(frames.back().second.error->linf, frames.front().second.error->linf,
              8e-9);                                  // 2 pi theta^4/120, theta = 2 pi/200
  EXPECT_LT(frames.back().second.error->linf, 1e-5);  // smoothing, (eps/0.23)^6 / 384 or so
}

}  // namespace
}  // namespace gaussdrift
