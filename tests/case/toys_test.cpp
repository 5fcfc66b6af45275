// A thing of each kind that is added to its catalogue alone: reader, `explain`, schema, `check` and a run know it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/budget.hpp"
#include "accuracy/forecast.hpp"
#include "base/catalogue.hpp"
#include "case_text.hpp"
#include "effect/catalogue.hpp"
#include "effect/remesh_kernel.hpp"
#include "fgtd/fgtd.hpp"
#include "field/density/shapes.hpp"
#include "field/named/named_fields.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "input/effect_rules.hpp"
#include "input/explain.hpp"
#include "input/markdown.hpp"
#include "message_of.hpp"
#include "particle/cutoff.hpp"
#include "render/styles.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {
namespace {

/// exp(-|x|^2 / 0.3^2) turns around the origin, once in 2 pi.
const std::string turning = case_text({.density = shape_of("gaussian", "0, 0", "0.3"),
                                       .particles = "per_axis = 41",
                                       .time = "end = 0.5\nstep = 0.1",
                                       .evaluate = "per_axis = 41"});

Case read(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return gaussdrift::parse_case(turning + more, "toy.toml", overrides).spec;
}

/// The errors of a case that is refused.
std::string refusal(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return message_of<CaseError>([&] { read(more, overrides); });
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string explained(std::string_view word) { return input::to_text(input::explain(word)); }

std::string checked(const Case& spec) { return accuracy::to_text(spec, accuracy::forecast(spec, 1)); }

/// Weights that decay on their own, at fixed positions: alpha' = -strength alpha.
class Fading : public Effect {
 public:
  explicit Fading(double strength) : strength_(strength) {}
  std::string name() const override { return "fading"; }
  std::string describe() const override { return "weights fade at the rate " + std::to_string(strength_); }
  Changes changes() const override { return {.weight = true}; }
  std::string conserves() const override { return "nothing"; }
  bool acts_between_steps() const override { return true; }
  void exchange(Particles& particles, double /*time*/, double length) override {
    for (double& alpha : particles.alpha) alpha *= std::exp(-strength_ * length);
  }

 private:
  double strength_;
};

NamedEffect fading() {
  return {
      .about = {.name = "fading",
                .meaning = "weights fade. The toy of a test",
                .parameters = {{.name = "strength", .range = positive, .unit = "1 / time", .meaning = "how fast"},
                               {.name = "times",
                                .kind = NamedParameter::Kind::choice,
                                .fallback = "once",
                                .meaning = "how often",
                                .choices =
                                    [] {
                                      return std::vector<NamedChoice>{{"once", "is slow"}, {"twice", "is fast"}};
                                    }}}},
      .traits = {.grows_weights = {.words = "fading changes the weights"}, .needs_fixed_steps = {.words = "at all"}},
      .make = [](const EffectSpec& effect, const EffectScene&) {
        return std::make_unique<Fading>(effect.number("strength") * (effect.text("times") == "twice" ? 2 : 1));
      }};
}

TEST(Toy, EffectIsAddedThroughItsCatalogueAlone) {
  EXPECT_TRUE(has(refusal("[effects.fading]\nstrength = 1\n"), "unknown effect \"fading\""));
  const base::Added<NamedEffect> toy(fading());

  EXPECT_TRUE(has(explained("effects.fading"), "weights fade"));
  EXPECT_TRUE(has(explained("fading"), "weights fade"));
  EXPECT_TRUE(has(explained("strength"), "how fast"));
  EXPECT_TRUE(has(explained("times"), "`twice` is fast"));
  EXPECT_TRUE(has(input::schema_json(), "\"fading\""));
  EXPECT_TRUE(has(input::registry_markdown(), "### `[effects.fading]`"));

  const std::string table = "[effects.fading]\nstrength = 0.8\ntimes = \"twice\"\n";
  const Case spec = read(table);
  EXPECT_TRUE(has(case_text(spec), table));
  EXPECT_EQ(gaussdrift::parse_case(case_text(spec), "again.toml").spec.effects, spec.effects);
  EXPECT_TRUE(has(checked(spec), "weights fade at the rate 1.6"));

  const RunSummary summary = Simulation(spec, 1).run();
  EXPECT_NEAR(summary.frames[1].second.mass / summary.frames[0].second.mass, std::exp(-0.8), 1e-14);
  ASSERT_EQ(summary.effects.size(), 2u);
  EXPECT_EQ(summary.effects[1].name, "fading");
}

// What the others have to know follows from its traits.
TEST(Toy, EffectMeetsTheOthers) {
  const base::Added<NamedEffect> toy(fading());
  const std::string table = "[effects.fading]\nstrength = 1\n";
  EXPECT_TRUE(has(refusal(table + "[effects.vortex]\n"),
                  "[effects.vortex] does not go with [effects.fading]: fading changes the weights, and these are the "
                  "circulations that move the particles"));
  EXPECT_TRUE(has(refusal(table + "[effects.charge]\nmobility = 1\n"), "does not go with [effects.fading] unless"));
  EXPECT_EQ(refusal(table + "[effects.charge]\nmobility = 1\ndensity = 1\n"), "");
  EXPECT_EQ(refusal(table + "[effects.remesh]\n"), "");
  EXPECT_EQ(input::goes_with("fading"),
            "fading goes with reaction, diffusion, remesh; with charge if the charge has a density of its own");
  EXPECT_TRUE(has(input::effects_markdown(), "* vortex with fading: fading changes the weights"));

  const Case spec = read(table);
  EXPECT_EQ(spec.particles.threshold, 0) << "weights grow, so small ones count";
  EXPECT_EQ(spec.reference.kind, ReferenceSpec::Kind::none) << "no path knows the density";
  EXPECT_TRUE(has(refusal(table + "[reference]\nkind = \"characteristics\"\n"), "with [effects.fading]"));
  EXPECT_TRUE(has(refusal(table + "[accuracy]\ntarget = 0.1\n"), "with [effects.fading]"));
  EXPECT_TRUE(has(refusal(table, {"time.method=dopri5"}), "do not go with [effects.fading] at all"));
  EXPECT_TRUE(has(accuracy::budget_not_covered(spec), "[effects.fading]"));
}

/// Everything moves away from a corner, at the speed of its distance.
class Bursting : public NamedVelocityField {
 public:
  explicit Bursting(double rate) : rate_(rate) {}
  void add(double, const PointsView& x, const VectorsView& u) const override {
    for (int k = 0; k < x.dimension; ++k)
      for (std::size_t i = 0; i < x.count; ++i) u.axis[k][i] += rate_ * x.axis[k][i];
  }
  void add_divergence(double, const PointsView& x, double* values) const override {
    for (std::size_t i = 0; i < x.count; ++i) values[i] += rate_ * x.dimension;
  }
  void add_gradient(double, const PointsView& x, const GradientsView& g) const override {
    for (int k = 0; k < x.dimension; ++k)
      for (std::size_t i = 0; i < x.count; ++i) g.slope[k][k][i] += rate_;
  }

 private:
  double rate_;
};

NamedField bursting() {
  return {
      .about = {.name = "bursting",
                .meaning = "all moves apart. The toy of a test",
                .formula = "u = pace x",
                .parameters = {{.name = "pace", .unit = "1 / time", .meaning = "how fast it bursts"}}},
      .divergence = "d pace",
      .exact_flow = "x exp(pace (t - s))",
      .make = [](int, const Arguments& arguments) { return std::make_unique<Bursting>(number(arguments, "pace")); }};
}

TEST(Toy, FieldIsAddedThroughItsCatalogueAlone) {
  const std::string keys = "field = \"bursting\"\npace = 0.5\n", text = case_text({.velocity = keys});
  EXPECT_TRUE(
      has(message_of<CaseError>([&] { gaussdrift::parse_case(text, "toy.toml"); }), "unknown value \"bursting\""));
  const base::Added<NamedField> toy(bursting());

  EXPECT_TRUE(has(explained("bursting"), "all moves apart"));
  EXPECT_TRUE(has(explained("pace"), "how fast it bursts"));
  EXPECT_TRUE(has(input::schema_json(), "\"bursting\""));
  EXPECT_TRUE(has(input::registry_markdown(), "All moves apart"));
  const Case spec = gaussdrift::parse_case(text, "toy.toml").spec;
  EXPECT_TRUE(has(case_text(spec), keys));
  EXPECT_TRUE(has(checked(spec), "bursting (pace = 0.5), div u = d pace"));
  Simulation simulation(spec, 1);
  simulation.prepare();
  const Particles start = simulation.particles();
  simulation.run();
  for (std::size_t j = 0; j < start.size(); ++j)  // rk4: two steps, each right to (0.5 * 0.05)^5 / 120 = 8e-11
    ASSERT_NEAR(simulation.particles().position[0][j], std::exp(0.5 * 0.1) * start.position[0][j], 2e-10);
}

/// The same density everywhere within a distance of the origin.
class Plateau : public InitialDensity {
 public:
  explicit Plateau(double level) : level_(level) {}
  void add(const PointsView& x, double* values) const override {
    for (std::size_t i = 0; i < x.count; ++i) values[i] += std::hypot(x.axis[0][i], x.axis[1][i]) < 0.55 ? level_ : 0;
  }
  std::string describe() const override { return "a plateau"; }
  std::optional<double> mass() const override { return level_ * std::numbers::pi * 0.55 * 0.55; }

 private:
  double level_;
};

NamedShape plateau() {
  return {{.name = "plateau",
           .meaning = "a flat top. The toy of a test",
           .formula = "level for |x| < 0.55",
           .parameters = {{.name = "level", .meaning = "how high the plateau is"}}},
          [](int, const Arguments& arguments) { return std::make_unique<Plateau>(number(arguments, "level")); }};
}

TEST(Toy, ShapeIsAddedThroughItsCatalogueAlone) {
  const std::string keys = "shape = \"plateau\"\nlevel = 2\n", text = case_text({.density = keys});
  EXPECT_TRUE(
      has(message_of<CaseError>([&] { gaussdrift::parse_case(text, "toy.toml"); }), "unknown value \"plateau\""));
  const base::Added<NamedShape> toy(plateau());

  EXPECT_TRUE(has(explained("plateau"), "a flat top"));
  EXPECT_TRUE(has(explained("level"), "how high the plateau is"));
  EXPECT_TRUE(has(input::schema_json(), "\"plateau\""));
  EXPECT_TRUE(has(input::registry_markdown(), "A flat top"));
  const Case spec = gaussdrift::parse_case(text, "toy.toml").spec;
  EXPECT_TRUE(has(case_text(spec), keys));
  EXPECT_TRUE(has(checked(spec), "a plateau"));
  const RunSummary summary = Simulation(spec, 1).run();
  // 97 nodes of a lattice of spacing 0.1 lie within, and none near the rim.
  EXPECT_NEAR(summary.frames[0].second.mass, 2 * 0.01 * 97, 1e-13);
}

/// A Gaussian wider than its core radius.
NamedCutoff wide() {
  return {.name = "wide",
          .meaning = "is a wide Gaussian",
          .order = 2,
          .parameters = {{.name = "wideness", .fallback = "1.5", .range = {1, 3}, .meaning = "for `wide`: how wide"}},
          .make =
              [](int dimension, double core_radius, const Arguments& arguments) {
                const double width = number(arguments, "wideness") * core_radius;
                return Cutoff{{width, {}, std::pow(std::sqrt(std::numbers::pi) * width, -dimension)}};
              },
          .problems =
              [](const Arguments& arguments) {
                return number(arguments, "wideness") < 2.5
                           ? std::vector<Complaint>{}
                           : std::vector<Complaint>{{.key = "wideness", .message = "too wide", .remedy = "less"}};
              }};
}

TEST(Toy, CutoffIsAddedThroughItsCatalogueAlone) {
  EXPECT_TRUE(has(refusal("", {"particles.cutoff=wide"}), "unknown value \"wide\""));
  const base::Added<NamedCutoff> toy(wide());

  EXPECT_TRUE(has(explained("wide"), "`wide` is a wide Gaussian"));
  EXPECT_TRUE(has(explained("wideness"), "particles.wideness"));
  EXPECT_TRUE(has(input::schema_json(), "\"wide\""));
  EXPECT_TRUE(has(input::registry_markdown(), "| `wideness` |"));
  EXPECT_TRUE(has(refusal("", {"particles.wideness=2"}), "\"wideness\" goes with cutoff = \"wide\", not with"));
  EXPECT_TRUE(has(refusal("", {"particles.cutoff=wide", "particles.wideness=2.7"}), "too wide"));

  const Case spec = read("", {"particles.cutoff=wide", "particles.wideness=2"});
  EXPECT_TRUE(has(case_text(spec), "cutoff = \"wide\"\nwideness = 2\n"));
  EXPECT_TRUE(has(checked(spec), "wide"));
  const double blob = 2 * 2 * 0.05, radius = 0.3;  // two core radii of two spacings
  const RunSummary summary = Simulation(spec, 1).run();
  EXPECT_NEAR(summary.frames[1].second.maximum, radius * radius / (radius * radius + blob * blob), 1e-4)
      << "the density, a Gaussian, convolved with the blob, a Gaussian; the rest is the error of the steps";
}

/// All weight to the nearest node.
RemeshKernel nearest() {
  return {.name = "nearest",
          .meaning = "gives all to the nearest node",
          .moments = 0,
          .share = [](double place, double, std::int64_t& first, std::vector<double>& weights) {
            first = std::llround(place);
            weights = {1};
          }};
}

TEST(Toy, RemeshKernelIsAddedThroughItsCatalogueAlone) {
  const std::string table = "[effects.remesh]\nevery = 5\nkernel = \"nearest\"\n";
  EXPECT_TRUE(has(refusal(table), "unknown value \"nearest\" for effects.remesh.kernel"));
  const base::Added<RemeshKernel> toy(nearest());

  EXPECT_TRUE(has(explained("nearest"), "`nearest` gives all to the nearest node"));
  EXPECT_TRUE(has(input::schema_json(), "\"nearest\""));
  const Case spec = read(table);
  EXPECT_TRUE(has(case_text(spec), table));
  EXPECT_TRUE(has(checked(spec), "remesh every 5 steps by nearest"));
  Simulation simulation(spec, 1);
  const RunSummary summary = simulation.run();
  EXPECT_NEAR(summary.frames[1].second.mass, summary.frames[0].second.mass, 1e-12);
  for (std::size_t j = 0; j < simulation.particles().size(); ++j) {
    const double place = (simulation.particles().position[0][j] + 1) / 0.05;
    ASSERT_NEAR(place, std::round(place), 1e-9);
  }
}

time::Tableau midpoint() {
  return {.name = "midpoint",
          .stages = 2,
          .time_order = 2,
          .stage_weights = {0.5},
          .weights = {0, 1},
          .nodes = {0, 0.5},
          .meaning = "is the midpoint rule, of order 2"};
}

TEST(Toy, TableauIsAddedThroughItsCatalogueAlone) {
  EXPECT_TRUE(has(refusal("", {"time.method=midpoint"}), "unknown value \"midpoint\""));
  const base::Added<time::Tableau> toy(midpoint());

  EXPECT_TRUE(has(explained("midpoint"), "`midpoint` is the midpoint rule, of order 2"));
  EXPECT_TRUE(has(input::schema_json(), "\"midpoint\""));
  const Case spec = read("", {"time.method=midpoint"});
  EXPECT_TRUE(has(case_text(spec), "method = \"midpoint\"\n"));
  EXPECT_TRUE(has(checked(spec), "5 steps"));
  Simulation simulation(spec, 1);
  simulation.prepare();
  const Particles start = simulation.particles();
  simulation.run();
  const Particles& end = simulation.particles();
  const double growth = std::pow(1 + std::pow(0.1, 4) / 4, 5.0 / 2);  // |1 + iz - z^2/2|^5 at z = 0.1
  for (std::size_t j = 0; j < start.size(); j += 37)
    EXPECT_NEAR(std::hypot(end.position[0][j], end.position[1][j]),
                growth * std::hypot(start.position[0][j], start.position[1][j]), 1e-14);
}

TEST(Catalogues, HaveTheDefaultsOfACaseFirst) {
  EXPECT_EQ(ParticleSpec{}.cutoff, cutoffs().front().name);
  EXPECT_EQ(TimeSpec{}.method, time::tableaux().front().name);
}

// A name in quotes would be knowledge of the thing in another place.
TEST(Catalogues, AreTheOnlyPlaceOfTheirNames) {
  std::vector<std::string_view> names = base::names_of(cutoffs());
  for (const auto& more :
       {base::names_of(effects()), base::names_of(remesh_kernels()), base::names_of(time::tableaux())})
    names.insert(names.end(), more.begin(), more.end());
  std::vector<std::string> methods;
  for (const fgtd::Method method : fgtd::methods())
    if (method != fgtd::Method::automatic) methods.push_back(to_string(method));  // "auto" is a word of many keys
  names.insert(names.end(), methods.begin(), methods.end());
  for (const render::Style& style : render::styles())
    if (style.about.name != "error") names.push_back(style.about.name);  // the error is an array and a column, too
  const std::vector<std::string> own{"src/effect/",
                                     "src/particle/cutoffs.cpp",
                                     "src/time/tableau.cpp",
                                     "src/fgtd/",
                                     "src/render/",
                                     "src/farfield/",
                                     "src/rbf/",                        // have methods of their own with these names
                                     "src/reproduce/",                  // as the papers have it
                                     "src/input/column_names.cpp",      // words of tables, such as "charge"
                                     "src/input/foreign_keys.cpp",      // words of other programs, such as "cells"
                                     "src/read/stored_grid.cpp",        // values at cells
                                     "src/read/grid_file.cpp",          // and messages about them
                                     "src/input/tables/density.cpp",    // its key "diffusion" has the effect's name
                                     "src/write/write_checkpoint.cpp",  // members of its manifest
                                     "src/write/read_checkpoint.cpp"};
  const std::filesystem::path root = SOURCE_DIR;
  int seen = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "src")) {
    const std::string file = entry.path().lexically_relative(root).generic_string();
    if (!file.ends_with(".cpp") && !file.ends_with(".hpp")) continue;
    if (std::any_of(own.begin(), own.end(), [&](const std::string& one) { return file.starts_with(one); })) continue;
    ++seen;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      line.resize(std::min(line.size(), line.find("//")));
      for (const std::string_view name : names)
        for (const std::string& quoted : {fmt::format("\"{}\"", name), fmt::format("effects.{}", name)})
          EXPECT_FALSE(has(line, quoted)) << file << ": " << line;
    }
  }
  EXPECT_GT(seen, 300);
}

}  // namespace
}  // namespace gaussdrift
