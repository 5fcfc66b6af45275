// Named densities that diffuse, each with a coefficient of its own.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"

namespace gaussdrift {
namespace {

/// exp(-r^2/0.04) of A and half of that of B, at rest, with more lines of each.
std::string two_that_spread(const std::string& of_a, const std::string& of_b, const std::string& more) {
  return "gaussdrift = 1\n[domain]\nmin = [-1.5, -1.5]\nmax = [1.5, 1.5]\n[velocity]\nu = [\"0\", \"0\"]\n"
         "[[density]]\nname = \"A\"\n" +
         of_a + "\nexpression = \"exp(-(x^2+y^2)/0.04)\"\n[[density]]\nname = \"B\"\n" + of_b +
         "\nexpression = \"0.5*exp(-(x^2+y^2)/0.04)\"\n[particles]\nper_axis = 61\n[time]\nend = 0.5\nstep = "
         "0.05\n[evaluate]\nper_axis = 31\n[output]\nframes = 2\nvtk = []\nimages = []\nreport = \"none\"\n" +
         more;
}
Case spec_of_text(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_case(text, "tracers.toml", overrides).spec;
}
const std::string spreading = "[effects.diffusion]\nD = 0.02\n";
const std::string exchanging = spreading + "method = \"particle-exchange\"\n";

/// exp(-r^2/0.04) as Gaussian blobs with eps = 0.1 show it after some diffusion: its square of the width is that much
/// larger, and the sum over the lattice has no error that double precision shows.
std::string shown(double height, double spread) {
  const double width = 0.04 + 0.01;
  return fmt::format("{}*exp(-(x^2+y^2)/({} + {}*t))*{}/({} + {}*t)", height, width, spread, 0.04, width, spread);
}

TEST(TracersThatDiffuse, SpreadByCoresAsWideAsTheirCoefficientsSay) {
  const Case spec = spec_of_text(two_that_spread(
      "diffusion = 0.005\nexact = \"" + shown(1, 0.02) + "\"", "exact = \"" + shown(0.5, 0.08) + "\"",
      spreading + "[reference]\nkind = \"exact\"\nrho = \"" + shown(1, 0.02) + " + " + shown(0.5, 0.08) + "\"\n"));
  Simulation simulation(spec, 2);
  simulation.observe("look", [](const Frame& frame) {
    for (const TracerNumbers& tracer : frame.numbers.tracers) EXPECT_LT(tracer.error.value().linf, 1e-7) << tracer.name;
    EXPECT_LT(frame.numbers.error.value().linf, 1e-7);  // 1e-8 is allowed of each transform
    EXPECT_LT(frame.numbers.transform_error, 2e-8);
    const DensityGrid& grid = *frame.density;
    for (std::size_t i = 0; i < grid.rho.size(); ++i)
      EXPECT_EQ(grid.fields[0].values[i] + grid.fields[1].values[i], grid.rho[i]);
    EXPECT_EQ(frame.numbers.maximum, *std::max_element(grid.rho.begin(), grid.rho.end()));
  });
  simulation.run();
  // Also where one does not spread at all.
  const Case still = spec_of_text(
      two_that_spread("diffusion = 0\nhalf_life = 0.5\nexact = \"0.5^(t/0.5)*" + shown(1, 0) + "\"", "", spreading));
  const RunSummary summary = Simulation(still, 1).run();
  // The rate is integrated by steps of rk4.
  EXPECT_LT(summary.frames.back().second.tracers[0].error.value().linf, 3e-7);  // 10 (ln 2 step/0.5)^5 / 120
}

/// Of a tracer: the mean of x^2 + y^2.
double square(const Particles& particles, std::size_t tracer) {
  double sum = 0, mass = 0;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    const double w = particles.tracers[tracer][j], x = particles.position[0][j], y = particles.position[1][j];
    sum += w * (x * x + y * y), mass += w;
  }
  return sum / mass;
}

TEST(TracersThatDiffuse, ExchangeEachItsOwnWeight) {
  Simulation simulation(spec_of_text(two_that_spread("diffusion = 0.005", "", exchanging)), 2);
  simulation.prepare();
  const Particles start = simulation.particles();
  const RunSummary summary = simulation.run();
  const Particles& end = simulation.particles();
  EXPECT_GT(end.size(), start.size()) << "no halo was made";
  // <r^2> grows by 4 D t, whatever the width of the blobs; 1e-5: what lies beyond the halo.
  EXPECT_NEAR(square(end, 0) - square(start, 0), 4 * 0.005 * 0.5, 1e-5);
  EXPECT_NEAR(square(end, 1) - square(start, 1), 4 * 0.02 * 0.5, 1e-5);
  for (const std::size_t k : {0u, 1u})
    EXPECT_NEAR(summary.frames.back().second.tracers[k].mass, summary.frames.front().second.tracers[k].mass, 1e-14);
  for (std::size_t j = 0; j < end.size(); ++j) EXPECT_EQ(end.alpha[j], end.tracers[0][j] + end.tracers[1][j]);
}

TEST(TracersThatDiffuse, ReactWhileTheyExchange) {
  // A becomes B: A = exp(-k t) G(D_A), and both together keep their mass. <r^2> of B is that of what has come when.
  const double k = 2, end = 0.5, slow = 0.005, fast = 0.02, width = 0.04;
  const RunSummary summary = [&] {
    const std::string text = two_that_spread("gain = \"-2*A\"\ndiffusion = 0.005", "gain = \"2*A\"", exchanging);
    Simulation simulation(spec_of_text(text, {"time.step=0.025"}), 1);
    const RunSummary of_run = simulation.run();
    // What was B from the start has spread for T; what was A until s, slowly until then and fast after.
    const double m_a = 1, m_b = 0.5;
    const double came = m_a * (1 - std::exp(-k * end));
    // int_0^T k e^{-k s} (4 slow s + 4 fast (T - s)) ds
    const double mean_s = (1 - std::exp(-k * end) * (1 + k * end)) / k;  // int k s e^{-k s} ds
    const double of_came = m_a * (4 * slow * mean_s + 4 * fast * ((1 - std::exp(-k * end)) * end - mean_s));
    const double expected = width + (m_b * 4 * fast * end + of_came) / (m_b + came);
    EXPECT_NEAR(square(simulation.particles(), 1), expected, 2e-5);
    EXPECT_NEAR(square(simulation.particles(), 0), width + 4 * slow * end, 2e-5);
    return of_run;
  }();
  const auto& [start, last] = std::pair(summary.frames.front().second, summary.frames.back().second);
  EXPECT_NEAR(last.tracers[0].mass / start.tracers[0].mass, std::exp(-k * end), 3e-8);  // 20 (k step)^5 / 120 of it
  EXPECT_NEAR(last.mass, start.mass, 1e-14);
  for (const std::size_t one : {0u, 1u})
    EXPECT_NEAR(last.tracers[one].mass, start.tracers[one].mass + last.tracers[one].reacted.value(), 1e-14);
}

TEST(TracersThatDiffuse, ShareTheVolumesWithReactionsOfConcentrations) {
  // A' = -3 A^2 in u = 0.3 x, with so little diffusion that it does not count: as without it.
  const auto weights = [](const std::string& more) {
    std::string text = two_that_spread("gain = \"-3*A*A\"", "", more);
    text.replace(text.find("\"0\", \"0\""), 8, "\"0.3*x\", \"0.3*y\"");
    Simulation simulation(spec_of_text(text), 1);
    const RunSummary summary = simulation.run();
    return summary.frames.back().second.tracers[0].mass;
  };
  const double alone = weights("");
  EXPECT_NEAR(weights("[effects.diffusion]\nD = 1e-12\nmethod = \"particle-exchange\"\n") / alone, 1, 1e-8);
}

TEST(TracersThatDiffuse, RefuseWhatTheMethodCannotDo) {
  const auto refused = [](const std::string& text, const std::vector<std::string>& overrides,
                          const std::string& words) {
    const std::string message = message_of<Error>([&] { spec_of_text(text, overrides); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  const std::string own = two_that_spread("diffusion = 0.005", "", spreading);
  EXPECT_EQ(spec_of_text(case_text(spec_of_text(own), ".")).tracers[0].diffusion, 0.005);
  refused(two_that_spread("diffusion = 0.005", "", ""), {},
          "A has a diffusion, and the case has no effect that diffuses");
  refused(own, {"effects.diffusion.D=0.001"}, "is less than the diffusion of A, 0.005");
  refused(own, {"effects.diffusion.method=random-walk"}, "a particle that walks carries all named densities along");
  refused(two_that_spread("diffusion = 0.005\ngain = \"-B\"", "", spreading), {},
          "what A gains from others has been spread");
  refused(two_that_spread("diffusion = 0.005", "", "[effects.diffusion]\nD_axes = [0.01, 0.02]\n"), {},
          "has no D, and named");
  refused(own, {"output.fields=[\"gradient\"]"}, "\"gradient\" is one of all densities");
  refused(resting_gaussian, {"density.diffusion=1"}, "\"diffusion\" goes with \"name\"");
}

}  // namespace
}  // namespace gaussdrift
