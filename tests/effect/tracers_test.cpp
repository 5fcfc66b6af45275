// Named densities: each has weights of its own, and they change into each other along the paths.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"
#include "same_particles.hpp"

namespace gaussdrift {
namespace {

/// Gaussians of the names A and B; more parts with more lines.
std::string two(const std::string& of_a, const std::string& of_b, const std::string& velocity = "u = [\"-y\", \"x\"]") {
  return "gaussdrift = 1\n[domain]\nmin = [-1, -1]\nmax = [1, 1]\n[velocity]\n" + velocity +
         "\n[[density]]\nname = \"A\"\n" + of_a +
         "\nexpression = \"exp(-(x^2+y^2)/0.04)\"\n[[density]]\nname = \"B\"\n" + of_b +
         "\nexpression = \"0.5*exp(-((x-0.1)^2+y^2)/0.04)\"\n[particles]\nper_axis = 41\n[time]\nend = 0.5\nstep = "
         "0.05\n[evaluate]\nper_axis = 33\n[output]\nframes = 2\nvtk = []\nimages = []\nreport = \"none\"\n";
}

Case spec_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_case(text, "tracers.toml", overrides).spec;
}

/// Largest difference of the weights of a tracer from what `exact` says of those at the start, relative to the largest.
template <class Exact>
double error_of(const Case& spec, std::size_t tracer, const Exact& exact) {
  Simulation simulation(spec, 1);
  simulation.prepare();
  const Particles start = simulation.particles();
  simulation.run();
  const Particles& end = simulation.particles();
  double largest = 0, error = 0;
  for (std::size_t j = 0; j < end.size(); ++j) {
    const double wanted = exact(start.tracers[0][j], start.tracers[1][j]);
    largest = std::max(largest, std::abs(wanted));
    error = std::max(error, std::abs(end.tracers[tracer][j] - wanted));
    EXPECT_EQ(end.alpha[j], end.tracers[0][j] + end.tracers[1][j]);
  }
  return error / largest;
}

TEST(Tracers, DecayIntoEachOtherAsTheirMatrixSays) {
  const std::string text = two("gain = \"-2*A + 0.5*B\"", "gain = \"2*A - 0.5*B\"");
  const double e = std::exp(-2.5 * 0.5), f = 0.2;
  const auto exact = [&](double a, double b) { return f * (a + b) + (a - f * (a + b)) * e; };
  const double coarse = error_of(spec_of(text), 0, exact),
               fine = error_of(spec_of(text, {"time.step=0.025"}), 0, exact);
  EXPECT_LT(fine, 1e-7);
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.2) << "the order of the steps";
  EXPECT_LT(error_of(spec_of(text, {"time.method=dopri5", "time.tolerance=1e-10"}), 0, exact), 1e-8);
}

TEST(Tracers, HalveInTheirHalfLife) {
  const auto half = [](double a, double) { return a / 4; };
  EXPECT_LT(error_of(spec_of(two("half_life = 0.25", "")), 0, half), 1e-5);
  EXPECT_EQ(error_of(spec_of(two("half_life = 0.25", "")), 1, [](double, double b) { return b; }), 0);
  // What all lose together is exact, whatever the steps.
  EXPECT_LT(error_of(spec_of(two("", ""), {"effects.reaction.half_life=0.25"}), 0, half), 1e-14);
  // Backwards it comes back.
  EXPECT_LT(error_of(spec_of(two("half_life = 0.25", ""), {"time.start=0.5", "time.end=0", "output.frames=2"}), 0,
                     [](double a, double) { return 4 * a; }),
            1e-4);
}

TEST(Tracers, MeetByTheirConcentrations) {
  // A' = -3 A^2: c = c_0/(1 + 3 c_0 t). In u = 0.3 x the volume grows by exp(0.6 t).
  const double cell = 0.05 * 0.05;
  const auto still = [&](double a, double) { return a / (1 + 3 * (a / cell) * 0.5); };
  EXPECT_LT(error_of(spec_of(two("gain = \"-3*A*A\"", "")), 0, still), 1e-5);
  const auto growing = [&](double a, double) { return a / (1 + 3 * (a / cell) * (1 - std::exp(-0.3)) / 0.6); };
  EXPECT_LT(error_of(spec_of(two("gain = \"-3*A*A\"", "", "u = [\"0.3*x\", \"0.3*y\"]")), 0, growing), 1e-5);
}

TEST(Tracers, HaveDensitiesOfTheirOwn) {
  Simulation simulation(spec_of(two("exact = \"exp(-(x^2+y^2)/0.04)\"", ""), {"particles.cutoff=gauss6"}), 1);
  simulation.observe("look", [](const Frame& frame) {
    const DensityGrid& grid = *frame.density;
    ASSERT_EQ(grid.fields.size(), 2u);
    EXPECT_EQ(grid.fields[0].name, "A");
    for (std::size_t i = 0; i < grid.rho.size(); ++i)
      EXPECT_NEAR(grid.fields[0].values[i] + grid.fields[1].values[i], grid.rho[i], 3e-8);
    const auto& tracers = frame.numbers.tracers;
    ASSERT_EQ(tracers.size(), 2u);
    EXPECT_LT(tracers[0].error.value().linf, 3e-2);
    EXPECT_FALSE(tracers[1].error);
    EXPECT_NEAR(tracers[0].mass + tracers[1].mass, frame.numbers.mass, 1e-15);
    EXPECT_NEAR(tracers[1].maximum, 0.5, 0.02);
  });
  simulation.run();
}

TEST(Tracers, HaveTheirWeightsInFilesOfParticles) {
  const Case spec = spec_of(two("gain = \"-A\"", "gain = \"A\""), {"output.vtk=[\"particles\"]"});
  const auto looks = [](Simulation& simulation) {
    simulation.observe("look", [](const Frame& frame) {
      ASSERT_TRUE(frame.particle_fields);
      ASSERT_EQ(frame.particle_fields->size(), 3u);  // after core_radius
      for (const std::size_t k : {0u, 1u}) {
        const FieldOnGrid& weights = (*frame.particle_fields)[1 + k];
        EXPECT_EQ(weights.name, k == 0 ? "alpha_A" : "alpha_B");
        EXPECT_EQ(weights.values, frame.particles->tracers[k]);
      }
    });
    simulation.run();
  };
  Simulation whole(spec, 1);
  looks(whole);
  // In pieces, and nowhere where no file has them.
  Simulation pieces(
      spec_of(two("gain = \"-A\"", "gain = \"A\""), {"output.vtk=[\"particles\"]", "output.piece_particles=500"}), 1);
  class Pieces : public Observer {
   public:
    explicit Pieces(std::size_t& seen) : seen_(seen) {}
    std::string name() const override { return "pieces"; }
    bool takes_particle_pieces() const override { return true; }
    void frame(const Frame& /*frame*/) override {}
    void particle_piece(const Frame& /*frame*/, const ParticlePiece& piece) override {
      ASSERT_TRUE(piece.fields);
      EXPECT_EQ((*piece.fields)[2].name, "alpha_B");
      for (std::size_t j = 0; j < piece.particles->size(); ++j)
        EXPECT_EQ((*piece.fields)[1].values[j] + (*piece.fields)[2].values[j], piece.particles->alpha[j]);
      seen_ += piece.particles->size();
    }

   private:
    std::size_t& seen_;
  };
  std::size_t seen = 0;
  pieces.observe(std::make_unique<Pieces>(seen));
  pieces.run();
  EXPECT_EQ(seen, 2 * pieces.particle_count()) << "at both outputs";
  Simulation plain(spec_of(two("", "")), 1);
  plain.observe("look", [](const Frame& frame) { EXPECT_FALSE(frame.particle_fields); });
  plain.run();
}

TEST(Tracers, CloseTheBudgetOfEach) {
  const std::string text =
      two("gain = \"-2*A + 0.5*B\"", "gain = \"A\"\nhalf_life = 0.7", "u = [\"3 - y\", \"2*x\"]") +
      "[[source]]\nface = \"x_min\"\nconcentration = \"1\"\npuffs = 20\ntracer = \"B\"\n[[source]]\npoint = [0, "
      "0]\namount "
      "= 0.3\nat = 0.1\ntracer = \"A\"\n[[check]]\nwhat = \"released\"\ntracer = \"A\"\nat = 0.5\nmin = 0.3\nmax = "
      "0.3\n";
  const RunSummary summary =
      Simulation(spec_of(text, {"domain.edges=[\"open\", \"open\"]", "time.step=0.01"}), 1).run();
  EXPECT_TRUE(summary.checks[0].passed);
  double mass = 0;
  for (std::size_t k : {0u, 1u}) {
    const TracerNumbers &start = summary.frames.front().second.tracers[k],
                        &end = summary.frames.back().second.tracers[k];
    EXPECT_GT(end.left.value(), 1e-3);
    EXPECT_GT(std::abs(end.reacted.value()), 1e-3);
    EXPECT_NEAR(end.mass, start.mass + *end.released + *end.reacted - *end.left, 1e-14) << k;
    mass += end.mass;
  }
  EXPECT_NEAR(mass, summary.frames.back().second.mass, 1e-14);
}

TEST(Tracers, AreWrittenAndReadAgain) {
  const Case spec = spec_of(two("gain = \"-k*A*B\"\nexact = \"x+s*t\"", "half_life = 3"), {"params.k=2", "params.s=1"});
  const Case again = spec_of(case_text(spec, "."));
  ASSERT_EQ(again.tracers.size(), 2u);
  EXPECT_EQ(again.tracers[0].gain, "-k*A*B");
  EXPECT_EQ(again.tracers[0].exact, "x+s*t");
  EXPECT_EQ(again.tracers[1].half_life, 3);
  EXPECT_EQ(again.tracers[1].parts, (std::vector<std::size_t>{1}));
  Simulation one(spec, 1), other(again, 2);
  one.run(), other.run();
  expect_same(one.particles(), other.particles());
}

TEST(Tracers, RefuseWhatIsNotKnownOfThem) {
  const auto refused = [](const std::string& text, const std::vector<std::string>& overrides,
                          const std::string& words) {
    const std::string message = message_of<Error>([&] { Simulation(spec_of(text, overrides), 1).prepare(); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  const std::string plain = two("", "");
  refused(plain, {"effects.remesh.every=2"}, "named densities do not go with [effects.remesh]");
  refused(plain, {"effects.charge.mobility=1"}, "which of the densities moves the particles is not said");
  refused(two("gain = \"-A*B\"", ""), {"source.point=[0,0]", "source.at=0", "source.amount=1", "source.tracer=A"},
          "[[source]] does not go with reactions that are not sums");
  refused(plain, {"source.point=[0,0]", "source.at=0", "source.amount=1"}, "does not say which of the named densities");
  refused(plain, {"source.point=[0,0]", "source.at=0", "source.amount=1", "source.tracer=D"},
          "no density is called \"D\"");
  refused(two("gain = \"-C\"", ""), {}, "C");
  refused(two("gain = \"-A\"\nname = \"x\"", ""), {}, "");
  refused(two("gain = \"-A\"", ""), {"reference.kind=characteristics"}, "does not go with reactions of named");
  refused(two("gain = \"-1000*A\"", ""), {}, "time.step = 0.05 is not stable with [effects.tracers]");
  refused(resting_gaussian, {"density.half_life=1"}, "\"half_life\" goes with \"name\"");
  refused(resting_gaussian, {"density.name=rho"}, "the name \"rho\" is taken");
  refused(plain, {"check.what=Linf", "check.tracer=A", "check.max=1"}, "Linf of A needs its exact density");
}

TEST(Tracers, OfTheGalleryDecayIntoEachOtherAsTheirFormulasSay) {
  // The checks of the case are the closed forms of both, and what is left of one.
  const Case spec = read_case(SOURCE_DIR "/cases/two_tracers.toml", {"output.images=[]", "evaluate.per_axis=41"}).spec;
  const RunSummary summary = Simulation(spec).run();
  ASSERT_EQ(summary.checks.size(), 4u);
  for (const CheckResult& check : summary.checks) EXPECT_TRUE(check.passed) << check.text;
}

}  // namespace
}  // namespace gaussdrift
