// Vortices and charges whose images beyond periodic and closed edges move them too: orbits against the same equations with
// the sums of tests/farfield/lattice.hpp, integrated here.
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "effect/charge.hpp"
#include "effect/scene.hpp"
#include "effect/vortex.hpp"
#include "farfield/lattice.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"
#include "sim/carrier.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {
namespace {

/// Two narrow peaks on nodes of the lattice, which has points at multiples of 0.1 and, along closed axes, between them: all
/// other particles have no weight and are left out.
std::string pair_at(const std::vector<std::string>& edges, const std::vector<std::vector<double>>& places) {
  std::string text = "expression = \"0";
  for (std::size_t p = 0; p < places.size(); ++p) {
    text += p == 0 ? " + 60*exp(-1e6*(0" : " + 100*exp(-1e6*(0";
    for (std::size_t l = 0; l < edges.size(); ++l)
      text += fmt::format(" + ({} - {:.2f})^2", "xyz"[l], places[p][l] + (edges[l] == "closed" ? 0.05 : 0));
    text += "))";
  }
  return text + "\"";
}

std::string list_of(const std::vector<std::string>& edges) {
  return fmt::format("\nedges = [\"{}\"]", fmt::join(edges, "\", \""));
}

struct Orbit {
  std::string name;
  Case spec;
  farfield::Options options;  // of the sums
  double factor;              // from a sum to a velocity
};

std::ostream& operator<<(std::ostream& out, const Orbit& orbit) { return out << orbit.name; }

template <int d>
Particles integrated(const Orbit& orbit, Particles particles) {
  const Eigen::VectorXd weights =
      Eigen::Map<const Eigen::VectorXd>(particles.alpha.data(), static_cast<Eigen::Index>(particles.alpha.size()));
  const bool turned = orbit.options.core_radius > 0 && orbit.options.mirror_images == farfield::MirrorImages::equal;
  const auto rate = [&](const farfield::Points<d>& x) -> farfield::Points<d> {
    farfield::Points<d> field = lattice::sum<d>(orbit.options, x, x, weights).field;
    if (turned) {  // charges with cores: the field, and not across it
      const Eigen::RowVectorXd first = field.row(0);
      field.row(0) = field.row(1);
      field.row(1) = -first;
    }
    return orbit.factor * field;
  };
  farfield::Points<d> x(d, weights.size());
  for (int l = 0; l < d; ++l)
    for (Eigen::Index j = 0; j < x.cols(); ++j) x(l, j) = particles.position[l][static_cast<std::size_t>(j)];
  constexpr int steps = d == 3 ? 20 : 40;
  const double h = orbit.spec.time.end / steps;
  for (int i = 0; i < steps; ++i) {
    const farfield::Points<d> a = rate(x), b = rate(x + h / 2 * a), c = rate(x + h / 2 * b), e = rate(x + h * c);
    x += h / 6 * (a + 2 * b + 2 * c + e);
  }
  for (int l = 0; l < d; ++l)
    for (Eigen::Index j = 0; j < x.cols(); ++j) particles.position[l][static_cast<std::size_t>(j)] = x(l, j);
  return particles;
}

farfield::Axis periodic(double low, double high) { return {farfield::Ends::periodic, low, high}; }
farfield::Axis closed(double low, double high) { return {farfield::Ends::mirrors, low, high}; }

Case two_in_the_plane(const std::vector<std::string>& edges, const std::string& effect) {
  return parse_case(case_text({.domain = "min = [0, 0]\nmax = [2, 1]" + list_of(edges),
                               .velocity = at_rest,
                               .density = pair_at(edges, {{0.4, 0.3}, {1.8, 0.7}}),
                               .particles = "per_axis = 21\noverlap = 1",
                               .time = "end = 0.4\nstep = 0.005",
                               .evaluate = "per_axis = 9"}) +
                        effect,
                    "two.toml", {})
      .spec;
}

Case two_in_space(const std::vector<std::string>& edges) {
  return parse_case(case_text({.domain = unit_cube + list_of(edges),
                               .velocity = velocity_of({"0", "0", "0"}),
                               .density = pair_at(edges, {{0.2, 0.2, 0.3}, {0.8, 0.6, 0.7}}),
                               .particles = "per_axis = 11\noverlap = 1",
                               .time = "end = 0.03\nstep = 0.00025",
                               .evaluate = "per_axis = 5"}) +
                        "\n[effects.charge]\nmobility = 2\ntolerance = 1e-7\n",
                    "two.toml", {})
      .spec;
}

std::vector<Orbit> orbits() {
  using farfield::MirrorImages;
  const auto vortices = [](const std::string& name, const std::vector<std::string>& edges, const farfield::Axis& x,
                           const farfield::Axis& y) {
    return Orbit{name,
                 two_in_the_plane(edges, "\n[effects.vortex]\ntolerance = 1e-10\n"),
                 {.core_radius = 0.1, .axes = {x, y}, .mirror_images = MirrorImages::opposite},
                 1};
  };
  const auto charges = [](const std::string& name, const std::vector<std::string>& edges, const farfield::Axis& x,
                          const farfield::Axis& y) {
    return Orbit{name,
                 two_in_the_plane(edges, "\n[effects.charge]\nmobility = 0.2\ntolerance = 1e-10\n"),
                 {.core_radius = 0.1, .axes = {x, y}},
                 0.2 * 2 * lattice::pi};
  };
  return {vortices("vortices_in_a_lattice", {"periodic", "periodic"}, periodic(0, 2), periodic(0, 1)),
          vortices("vortices_in_a_channel", {"periodic", "closed"}, periodic(0, 2), closed(0, 1)),
          vortices("vortices_in_a_room", {"closed", "closed"}, closed(0, 2), closed(0, 1)),
          vortices("a_row_of_vortices", {"periodic", "unbounded"}, periodic(0, 2), {}),
          charges("charges_in_a_lattice", {"periodic", "periodic"}, periodic(0, 2), periodic(0, 1)),
          charges("charges_in_a_room", {"closed", "closed"}, closed(0, 2), closed(0, 1)),
          Orbit{"charges_in_space",
                two_in_space({"periodic", "periodic", "periodic"}),
                {.axes = {periodic(0, 1), periodic(0, 1), periodic(0, 1)}},
                2},
          Orbit{"charges_between_walls",
                two_in_space({"closed", "periodic", "closed"}),
                {.axes = {closed(0, 1), periodic(0, 1), closed(0, 1)}},
                2}};
}

class PairImages : public testing::TestWithParam<Orbit> {};

TEST_P(PairImages, MoveTwoParticlesAsTheirEquationsSay) {
  const Orbit& orbit = GetParam();
  Simulation simulation(orbit.spec, 1);
  const Particles start = seed_scene(make_scene(orbit.spec), 0);
  simulation.run();
  const Particles& end = simulation.particles();
  ASSERT_EQ(end.size(), 2u);
  EXPECT_EQ(end.alpha, start.alpha);
  const int d = end.dimension;
  const Particles expected = d == 3 ? integrated<3>(orbit, start) : integrated<2>(orbit, start);
  double moved = 0;
  for (std::size_t l = 0; l < static_cast<std::size_t>(d); ++l)
    for (std::size_t j = 0; j < 2; ++j) {
      const farfield::Axis& axis = orbit.options.axes[l];
      double x = expected.position[l][j];
      if (axis.ends == farfield::Ends::periodic)
        x -= (axis.high - axis.low) * std::floor((x - axis.low) / (axis.high - axis.low));
      EXPECT_NEAR(end.position[l][j], x, 2e-8) << "axis " << l << ", particle " << j;
      moved += std::abs(x - start.position[l][j]);
    }
  EXPECT_GT(moved, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Orbits, PairImages, testing::ValuesIn(orbits()),
                         [](const auto& orbit) { return orbit.param.name; });

// A lone charge and a lone vortex, of which all images are alike, feel nothing of them.
TEST(PairImagesOfOne, DoNotMoveIt) {
  Domain domain{.dimension = 2, .min = {0, 0}, .max = {1, 3}, .edges = {}};
  domain.edges[0] = domain.edges[1] = {Edge::periodic, Edge::periodic};
  Particles particles;
  particles.dimension = 2;
  particles.position = {std::vector<double>{0.3}, std::vector<double>{1.1}, {}};
  particles.alpha = {2};
  particles.id = {0};
  Vortex vortex({.core_radius = 0.01, .cell = 1, .tolerance = 1e-9, .domain = domain});
  vortex.begin(particles, 0);
  double ux = 0, uy = 0;
  vortex.drift()->add(0, particles, particles.view(), VectorsView{2, 1, {&ux, &uy, nullptr}});
  EXPECT_NEAR(ux, 0, 1e-12);
  EXPECT_NEAR(uy, 0, 1e-12);
  EXPECT_EQ(vortex.numbers().back(), (std::pair<std::string, double>("background", -2.0 / 3)));
  EXPECT_EQ(vortex.conserves(), "circulation");
  EXPECT_NE(vortex.describe().find("uniform background"), std::string::npos);
}

TEST(PairImagesOnRanks, AreRefused) {
  Domain domain{.dimension = 2, .min = {0, 0}, .max = {1, 1}, .edges = {}};
  domain.edges[0] = {Edge::open, Edge::closed};
  on_ranks(2, [&](base::Communicator& ranks) {
    EXPECT_NE(message_of<InputError>([&] { PairVelocity(1e-6, 1, &ranks, domain); }).find("on one rank alone"),
              std::string::npos);
    PairVelocity(1e-6, 1, &ranks, Domain{});
  });
}

// Vortices that fill the plane like a chessboard stand still: each vorticity is the same all along a path.
TEST(PairImagesOfAnArray, KeepASteadyFlow) {
  const Case spec =
      parse_case(case_text({.domain = "min = [0, 0]\nmax = [\"2*pi\", \"2*pi\"]\nedges = [\"periodic\", \"periodic\"]",
                            .velocity = at_rest,
                            .density = "expression = \"2*sin(x)*sin(y)\"",
                            .particles = "per_axis = 33\noverlap = 1.4",
                            .time = "end = 0.5\nstep = 0.1",
                            .evaluate = "per_axis = 17"}) +
                     "\n[effects.vortex]\n[reference]\nkind = \"exact\"\nrho = \"2*sin(x)*sin(y)\"\n",
                 "array.toml", {})
          .spec;
  const RunSummary summary = Simulation(spec, 1).run();
  // The blobs' width takes 1 - exp(-eps^2/2) of it, eps = 1.4 * 2 pi / 33.
  ASSERT_TRUE(summary.frames.back().second.error.has_value());
  EXPECT_LT(summary.frames.back().second.error->linf, 0.045);
}

}  // namespace
}  // namespace gaussdrift
