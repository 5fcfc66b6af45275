// What valid cases become: defaults, expressions of numbers, overrides, and the way back to a file.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>

#include "base/catalogue.hpp"
#include "cases.hpp"
#include "input/effect_rules.hpp"
#include "input/markdown.hpp"
#include "input/registry.hpp"

namespace gaussdrift::input {
namespace {

Case parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_case(text, "folder/cone.toml", overrides).spec;
}

/// Field by field, without name, file and source.
void expect_same(const Case& a, const Case& b) {
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.cite, b.cite);
  for (const auto& param : a.params)  // a resolved case keeps the parameters that its expressions mention
    EXPECT_NE(std::find(b.params.begin(), b.params.end(), param), b.params.end()) << param.first;
  EXPECT_EQ(a.domain.dimension, b.domain.dimension);
  EXPECT_EQ(a.domain.min, b.domain.min);
  EXPECT_EQ(a.domain.max, b.domain.max);
  ASSERT_EQ(a.velocity.size(), b.velocity.size());
  for (std::size_t k = 0; k < a.velocity.size(); ++k) {
    ASSERT_EQ(a.velocity[k].index(), b.velocity[k].index());
    if (const auto* u = std::get_if<ExpressionVelocitySpec>(&a.velocity[k])) {
      EXPECT_EQ(u->components, std::get<ExpressionVelocitySpec>(b.velocity[k]).components);
    }
    if (const auto* named = std::get_if<NamedVelocitySpec>(&a.velocity[k])) {
      EXPECT_EQ(named->field, std::get<NamedVelocitySpec>(b.velocity[k]).field);
      EXPECT_EQ(named->arguments, std::get<NamedVelocitySpec>(b.velocity[k]).arguments);
    }
  }
  ASSERT_EQ(a.density.size(), b.density.size());
  for (std::size_t k = 0; k < a.density.size(); ++k) {
    ASSERT_EQ(a.density[k].index(), b.density[k].index());
    if (const auto* expression = std::get_if<ExpressionDensitySpec>(&a.density[k])) {
      EXPECT_EQ(expression->text, std::get<ExpressionDensitySpec>(b.density[k]).text);
    }
    if (const auto* shape = std::get_if<ShapeDensitySpec>(&a.density[k])) {
      EXPECT_EQ(shape->shape, std::get<ShapeDensitySpec>(b.density[k]).shape);
      EXPECT_EQ(shape->arguments, std::get<ShapeDensitySpec>(b.density[k]).arguments);
    }
  }
  EXPECT_EQ(a.particles.per_axis, b.particles.per_axis);
  EXPECT_EQ(a.particles.overlap, b.particles.overlap);
  EXPECT_EQ(a.particles.cutoff, b.particles.cutoff);
  EXPECT_EQ(a.particles.threshold, b.particles.threshold);
  EXPECT_EQ(a.time.end, b.time.end);
  EXPECT_EQ(a.time.step, b.time.step);
  EXPECT_EQ(a.effects, b.effects);
  EXPECT_EQ(a.particles.cutoff_arguments, b.particles.cutoff_arguments);
  EXPECT_EQ(a.time.tolerance, b.time.tolerance);
  EXPECT_EQ(a.time.method, b.time.method);
  EXPECT_EQ(a.evaluate.per_axis, b.evaluate.per_axis);
  EXPECT_EQ(a.evaluate.tolerance, b.evaluate.tolerance);
  EXPECT_EQ(a.evaluate.method, b.evaluate.method);
  EXPECT_EQ(a.evaluate.most_seconds, b.evaluate.most_seconds);
  EXPECT_EQ(a.output.times, b.output.times);
  EXPECT_EQ(base::names_of(a.output.files), base::names_of(b.output.files));
  EXPECT_EQ(base::names_of(a.output.images), base::names_of(b.output.images));
  EXPECT_EQ(a.reference.kind, b.reference.kind);
  EXPECT_EQ(a.reference.rho, b.reference.rho);
  ASSERT_EQ(a.checks.size(), b.checks.size());
  for (std::size_t k = 0; k < a.checks.size(); ++k) {
    EXPECT_EQ(a.checks[k].what, b.checks[k].what);
    EXPECT_EQ(a.checks[k].max, b.checks[k].max);
    EXPECT_EQ(a.checks[k].min, b.checks[k].min);
    EXPECT_EQ(a.checks[k].at, b.checks[k].at);
  }
}

TEST(Case, HasWhatTheFileSays) {
  const Case scene = parse(cone);
  const double turn = 2 * std::numbers::pi;
  EXPECT_EQ(scene.name, "cone");
  EXPECT_EQ(scene.file, "folder/cone.toml");
  EXPECT_EQ(scene.source, cone);
  EXPECT_EQ(scene.title, "Rotating cone");
  EXPECT_EQ(scene.params, (Params{{"R", 0.25}, {"turn", turn}}));
  EXPECT_EQ(scene.domain.dimension, 2);
  EXPECT_EQ(scene.domain.min, (std::array<double, 3>{-1, -1, 0}));
  EXPECT_EQ(std::get<ExpressionVelocitySpec>(scene.velocity.at(0)).components, (std::vector<std::string>{"-y", "x"}));
  const auto& shape = std::get<ShapeDensitySpec>(scene.density.at(0));
  EXPECT_EQ(shape.shape, "wendland");
  EXPECT_EQ(shape.arguments, (Arguments{{"center", {0.5, 0}}, {"radius", {0.25}}, {"height", {1.5}}}));
  EXPECT_EQ(scene.time.end, turn);
  EXPECT_EQ(scene.output.times, (std::vector<double>{0, turn / 4, turn}));
}

TEST(Case, SaysWhatItsResultsAreComparedWith) {
  const Case exact = parse(cone + R"text([reference]
kind = "exact"
rho = "exp(-R*(x^2 + y^2) - t)"
[[check]]
what = "Linf"
max = "R/10"
[[check]]
what = "mass"
min = 0.5
max = 1.5
at = "pi/2"
)text");
  EXPECT_EQ(exact.reference.kind, ReferenceSpec::Kind::exact);
  EXPECT_EQ(exact.reference.rho, "exp(-R*(x^2 + y^2) - t)");
  ASSERT_EQ(exact.checks.size(), 2u);
  EXPECT_EQ(exact.checks[0].what, CheckSpec::Quantity::linf);
  EXPECT_EQ(exact.checks[0].max, 0.025);
  EXPECT_FALSE(exact.checks[0].min.has_value() || exact.checks[0].at.has_value());
  EXPECT_EQ(exact.checks[1].what, CheckSpec::Quantity::mass);
  EXPECT_EQ(exact.checks[1].min, 0.5);
  EXPECT_EQ(exact.checks[1].at, exact.output.times[1]) << "exactly the output time";
  const Case none = parse(cone + "[reference]\nkind = \"none\"\n[check]\nwhat = \"mass\"\nmin = 1\n");
  EXPECT_EQ(none.reference.kind, ReferenceSpec::Kind::none);
  EXPECT_EQ(none.checks.size(), 1u);
}

TEST(Case, TakesPicturesOfItsDimension) {
  using Names = std::vector<std::string_view>;
  const Case solid = parse(least + "[output]\nimages = [\"isosurface\", \"projection\", \"error\"]\n");
  EXPECT_EQ(base::names_of(solid.output.images), (Names{"isosurface", "projection", "error"}));
  const Case flat = parse(with(cone, "images = [\"surface\"]", "images = [\"error\", \"heatmap\"]"));
  EXPECT_EQ(base::names_of(flat.output.images), (Names{"error", "heatmap"}));
}

// A reaction can raise what is next to nothing at the start.
TEST(Case, LeavesNothingOutByItselfWhereWeightsChange) {
  const std::string reacting = cone + "[effects.reaction]\nrate = \"-1\"\n";
  EXPECT_EQ(parse(cone).particles.threshold, 1e-12);
  EXPECT_EQ(parse(reacting).particles.threshold, 0);
  EXPECT_EQ(parse(reacting, {"particles.threshold=1e-9"}).particles.threshold, 1e-9);
}

TEST(Case, TakesItsDefaultsFromTheRegistryAndTheyAreValid) {
  const ReadResult result = parse_case(least, "least.toml");
  EXPECT_TRUE(result.warnings.empty());
  const Case& scene = result.spec;
  const ParticleSpec particles;
  const TimeSpec time;
  const EvaluateSpec evaluate;
  EXPECT_EQ(scene.particles.overlap, particles.overlap);
  EXPECT_EQ(scene.particles.cutoff, particles.cutoff);
  EXPECT_EQ(scene.particles.threshold, particles.threshold);
  EXPECT_EQ(scene.time.method, time.method);
  EXPECT_EQ(scene.evaluate.per_axis, evaluate.per_axis);
  EXPECT_EQ(scene.evaluate.tolerance, evaluate.tolerance);
  EXPECT_EQ(scene.evaluate.method, evaluate.method);
  EXPECT_EQ(scene.output.times, (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(base::names_of(scene.output.files), (std::vector<std::string_view>{"density", "particles"}));
  EXPECT_EQ(base::names_of(scene.output.images), std::vector<std::string_view>{"slices"});
  EXPECT_EQ(scene.reference.kind, ReferenceSpec::Kind::characteristics);
  EXPECT_TRUE(scene.checks.empty());
  const Case flat = parse(with(cone, "images = [\"surface\"]\n", ""));
  EXPECT_EQ(base::names_of(flat.output.images), std::vector<std::string_view>{"surface"});
  const auto rotation =
      std::get<NamedVelocitySpec>(parse(with(cone, "u = [\"-y\", \"x\"]", "field = \"rotation\"")).velocity.at(0));
  EXPECT_EQ(rotation.arguments, (Arguments{{"center", {0, 0}}, {"rate", {1}}}));
  EXPECT_EQ(
      number(std::get<ShapeDensitySpec>(parse(with(cone, "height = 1.5\n", "")).density.at(0)).arguments, "height"), 1);
}

TEST(Case, TakesExpressionsWhereverANumberStands) {
  std::string text = with(cone, "per_axis = 300", "per_axis = \"3*100\"");
  text = with(text, "max = [1, 1]", "max = [\"4*R\", \"e - e + 1\"]");
  text = with(text, "tolerance = 1e-8", "tolerance = \"10^-6\"");
  text = with(text, "u = [\"-y\", \"x\"]", "field = \"rotation\"\nrate = \"turn\"\ncenter = [\"R/2\", 0]");
  const Case scene = parse(text);
  EXPECT_EQ(scene.particles.per_axis, 300);
  EXPECT_EQ(scene.domain.max, (std::array<double, 3>{1, 1, 0}));
  EXPECT_DOUBLE_EQ(scene.evaluate.tolerance, 1e-6);
  EXPECT_EQ(std::get<NamedVelocitySpec>(scene.velocity.at(0)).arguments,
            (Arguments{{"center", {0.125, 0}}, {"rate", {2 * std::numbers::pi}}}));
}

TEST(Case, TakesPlainNumbersAsVelocityAndDensity) {
  const Case scene = parse(with(with(least, "\"y\", \"z*t\", \"x\"", "1, 0.5, \"x\""), "\"exp(-x^2-y^2-z^2)\"", "1"));
  EXPECT_EQ(std::get<ExpressionVelocitySpec>(scene.velocity.at(0)).components,
            (std::vector<std::string>{"1", "0.5", "x"}));
  EXPECT_EQ(std::get<ExpressionDensitySpec>(scene.density.at(0)).text, "1");
}

TEST(Case, AddsUpSeveralVelocitiesAndDensities) {
  const Case scene = parse(with(with(cone, "[velocity]\nu = [\"-y\", \"x\"]",
                                     "[[velocity]]\nu = [\"-y\", \"x\"]\n[[velocity]]\nfield = \"rotation\""),
                                "[density]", "[[density]]\nexpression = \"x\"\n[[density]]"),
                           {"velocity[2].rate=3", "density[2].height=4"});
  ASSERT_EQ(scene.velocity.size(), 2u);
  EXPECT_EQ(std::get<ExpressionVelocitySpec>(scene.velocity[0]).components, (std::vector<std::string>{"-y", "x"}));
  EXPECT_EQ(number(std::get<NamedVelocitySpec>(scene.velocity[1]).arguments, "rate"), 3);
  ASSERT_EQ(scene.density.size(), 2u);
  EXPECT_EQ(std::get<ExpressionDensitySpec>(scene.density[0]).text, "x");
  EXPECT_EQ(number(std::get<ShapeDensitySpec>(scene.density[1]).arguments, "height"), 4);
  expect_same(parse(case_text(scene)), scene);
}

TEST(Case, LimitsTheSecondsOfADensityIfAsked) {
  EXPECT_EQ(parse(cone).evaluate.most_seconds, 0);
  const Case scene = parse(cone, {"evaluate.most_seconds=2.5"});
  EXPECT_EQ(scene.evaluate.most_seconds, 2.5);
  expect_same(parse(case_text(scene)), scene);
  EXPECT_THROW(parse(cone, {"evaluate.most_seconds=0"}), CaseError);
}

TEST(Case, SpreadsFramesEvenlyAndEndsExactly) {
  const auto times = [](const std::string& output) { return parse(least, {output}).output.times; };
  EXPECT_EQ(times("output.frames=1"), (std::vector<double>{1}));
  EXPECT_EQ(times("output.frames=3"), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(parse(least, {"output.frames=8", "time.end=0.7"}).output.times.back(), 0.7);
  EXPECT_EQ(parse(least, {"time.end=0"}).output.times, (std::vector<double>{0}));
}

TEST(Case, SnapsTimesThatAreTheEndUpToRounding) {
  const Case scene = parse(least, {"time.end=0.3", "output.times=[\"0.1*3\"]"});
  ASSERT_NE(0.1 * 3, 0.3);
  EXPECT_EQ(scene.output.times, (std::vector<double>{0.3}));
  EXPECT_THROW(parse(least, {"time.end=0.3", "output.times=[0.3000001]"}), CaseError);
}

TEST(Case, ReadsTheWindowsEndOfLine) {
  std::string text;
  for (const char c : cone) text += c == '\n' ? "\r\n" : std::string(1, c);
  expect_same(parse(text), parse(cone));
}

TEST(Overrides, HaveTheTypesOfTheFile) {
  const Case scene =
      parse(cone, {"time.step = 0.05", "particles.cutoff=gauss4", "time.end=turn/2", "output.times=[0, \"turn/2\"]",
                   "case.title=\"a = b\"", "params.R=0.5", "evaluate.method='direct'"});
  EXPECT_EQ(scene.time.step, 0.05);
  EXPECT_EQ(scene.particles.cutoff, "gauss4");
  EXPECT_EQ(scene.time.end, std::numbers::pi);
  EXPECT_EQ(scene.output.times, (std::vector<double>{0, std::numbers::pi}));
  EXPECT_EQ(scene.title, "a = b");
  EXPECT_EQ(number(std::get<ShapeDensitySpec>(scene.density.at(0)).arguments, "radius"), 0.5)
      << "expressions see the parameter that was set";
  EXPECT_EQ(scene.evaluate.method, "direct");
}

TEST(Overrides, ReplaceTimesByFramesAndTheOtherWayRound) {
  EXPECT_EQ(parse(cone, {"output.frames=2"}).output.times, (std::vector<double>{0, 2 * std::numbers::pi}));
  const std::string framed = with(cone, "times = [0, \"turn/4\", \"turn\"]", "frames = 7");
  EXPECT_EQ(parse(framed).output.times.size(), 7u);
  EXPECT_EQ(parse(framed, {"output.times=[1]"}).output.times, (std::vector<double>{1}));
  EXPECT_EQ(parse(framed, {"output.times=[1]", "output.frames=3"}).output.times.size(), 3u) << "the later one counts";
}

TEST(Overrides, MakeTablesThatTheFileLacks) {
  EXPECT_EQ(parse(least, {"evaluate.per_axis=20", "case.title=made"}).evaluate.per_axis, 20);
  const Case scene = parse(least, {"params.k=2*pi", "velocity.u=[\"k*y\", \"z\", \"x\"]"});
  EXPECT_EQ(scene.params, (Params{{"k", 2 * std::numbers::pi}}));
}

TEST(Overrides, RepairWhatTheFileHasWrong) {
  EXPECT_EQ(errors(with(cone, "step = 0.001", "step = \"oops\""), {"time.step=0.1"}), "");
  EXPECT_EQ(parse(cone, {"time.step=1", "time.step=2"}).time.step, 2) << "the last one counts";
}

TEST(ResolvedCase, IsTheSameCaseAgain) {
  const std::vector<std::string> texts = {
      cone,
      least,
      with(cone, "u = [\"-y\", \"x\"]", "field = \"rotation\"\nrate = \"1/3\"\ncenter = [0.1, -0.0]"),
      with(cone, "title = \"Rotating cone\"", "title = \"\"\"two\n\\\"lines\\\" \\\\ \\u0001 é\"\"\""),
      with(cone, "images = [\"surface\"]", "images = [\"heatmap\", \"contour\"]"),
      with(cone, "vtk = [\"density\", \"particles\"]", "vtk = []"),
      with(cone, "R = 0.25",
           "R = 0.25\ntiny = 4.9e-324\nhuge = 1.7976931348623157e308\nthird = \"1/3\"\nmillion = 1e20"),
      with(least, "exp(-x^2-y^2-z^2)", "x < 0.5 && y > 0 || z == 1 ? 1 : 0"),
      cone + "[reference]\nkind = \"exact\"\nrho = \"R*x*t\"\n[[check]]\nwhat = \"L1\"\nmax = 0.1\n",
      cone + "[effects.reaction]\nrate = \"R*x*t\"\n[effects.diffusion]\nD = \"R/100\"\n[effects.remesh]\n",
      cone +
          "[effects.diffusion]\nD = 0.01\nmethod = \"particle-exchange\"\ntolerance = 1e-5\n[effects.remesh]\nevery = "
          "7\n"
          "kernel = \"m4prime\"\ntolerance = 0\n",
      cone + "[effects.charge]\nmobility = \"-R\"\ndensity = \"R*x\"\ntolerance = 1e-5\n",
      cone + "[effects.charge]\nmobility = 1\n[effects.vortex]\n[effects.diffusion]\nD = 0.01\n",
      with(cone, "method = \"rk4\"", "method = \"dopri5\"\ntolerance = 1e-6"),
      with(cone, "cutoff = \"gauss2\"", "cutoff = \"two-gauss\"\nwidth_ratio = 1.5"),
      cone +
          "[reference]\nkind = \"none\"\n[[check]]\nwhat = \"mass\"\nmin = \"R\"\nmax = 1\n"
          "[[check]]\nwhat = \"mass\"\nmin = 1\nat = \"turn\"\n"};
  for (const std::string& text : texts) {
    const Case scene = parse(text);
    const std::string resolved = case_text(scene);
    const Case again = parse(resolved);
    expect_same(again, scene);
    EXPECT_EQ(case_text(again), resolved) << "resolving twice changes nothing";
  }
}

TEST(ResolvedCase, SpellsOutDefaultsAndOverrides) {
  const std::string resolved = case_text(parse(least, {"time.end=2/3"}));
  EXPECT_EQ(resolved, R"text(gaussdrift = 1

[case]
title = ""
cite = ""

[domain]
min = [0, 0, 0]
max = [1, 1, 1]

[velocity]
u = ["y", "z*t", "x"]

[density]
expression = "exp(-x^2-y^2-z^2)"

[particles]
per_axis = 10
overlap = 2
cutoff = "gauss2"
threshold = 1e-12

[time]
end = 0.6666666666666666
step = 0.1
method = "rk4"

[evaluate]
per_axis = 200
tolerance = 1e-08
method = "auto"

[output]
times = [0, 0.16666666666666666, 0.3333333333333333, 0.5, 0.6666666666666666]
vtk = ["density", "particles"]
images = ["slices"]
report = "html"

[reference]
kind = "characteristics"

[accuracy]
budget = "auto"
)text");
}

// --- the guide --------------------------------------------------------------------------------------------------

std::string file_text(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The part of docs/cases.md between two marks must be `generated`.
void expect_in_guide(const std::string& mark, const std::string& generated) {
  const std::string path = SOURCE_DIR "/docs/cases.md";
  const std::string guide = file_text(path), begin = "<!-- " + mark + ": begin", end = "<!-- " + mark + ": end -->";
  ASSERT_NE(guide.find(begin), std::string::npos) << path;
  ASSERT_NE(guide.find(end), std::string::npos) << path;
  const std::size_t first = guide.find('\n', guide.find(begin)) + 1, last = guide.find(end);
  EXPECT_EQ(guide.substr(first, last - first), generated)
      << "gaussdrift explain --markdown docs/cases.md writes this part";
}

TEST(CaseGuide, ListsTheKeysOfTheRegistry) { expect_in_guide("keys", "\n" + registry_markdown() + "\n"); }

TEST(CaseGuide, TellsWhichEffectsGoTogether) { expect_in_guide("effects", "\n" + effects_markdown() + "\n"); }

TEST(CaseGuide, ListsTheFunctions) { expect_in_guide("functions", "\n" + functions_markdown() + "\n"); }

TEST(CaseGuide, ShowsCasesThatAreValid) {
  const std::string guide = file_text(SOURCE_DIR "/docs/cases.md"), fence = "```toml\n";
  int found = 0;
  for (std::size_t at = guide.find(fence); at != std::string::npos; at = guide.find(fence, at + 1), ++found) {
    const std::string text =
        guide.substr(at + fence.size(), guide.find("```\n", at + fence.size()) - at - fence.size());
    // As if it stood in cases/, where the files are that it names.
    EXPECT_NO_THROW(EXPECT_TRUE(parse_case(text, SOURCE_DIR "/cases/guide.toml").warnings.empty())) << text;
  }
  EXPECT_GE(found, 2);
}

TEST(Registry, KnowsEveryKeyOnceInATableThatExists) {
  std::vector<std::string> seen;
  for (const Key& key : keys()) {
    const std::string label = std::string(key.table) + "." + std::string(key.name) + " " + std::string(key.value);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), label), 0) << label;
    seen.push_back(label);
    const auto known = table_names();
    EXPECT_TRUE(key.table.empty() || std::count(known.begin(), known.end(), key.table) == 1) << label;
    EXPECT_FALSE(key.meaning.empty()) << label;
    EXPECT_EQ(&find_key(key.table, key.name, key.value), &key);
    if (!key.with.empty()) {
      EXPECT_NO_THROW(find_key(key.table, key.with)) << label;
    }
  }
  EXPECT_THROW(find_key("time", "stpe"), std::logic_error);
}

// --- damage -----------------------------------------------------------------------------------------------------

/// Deletes, doubles, swaps and overwrites stretches of a text, or exchanges digits, which often leaves it valid.
std::string damaged(std::string text, std::mt19937& random) {
  static const std::string pieces[] = {
      "\"",  "[",   "]",    "=",          "\n", ".", "-", "e",        "0",    "9999999999",
      "nan", "inf", "'",    "{",          "}",  ",", "#", "\xC3\xA9", "\xFF", std::string(1, '\0'),
      "\t",  "\\",  "true", "1979-05-27", "[[", "x", "(", "^",        "1e400"};
  const int edits = 1 + int(random() % 3);
  for (int k = 0; k < edits && !text.empty(); ++k) {
    const std::size_t at = random() % text.size(), length = 1 + random() % 12;
    switch (random() % 6) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(random() % text.size(), length));
        break;
      case 2:
        std::swap(text[at], text[random() % text.size()]);
        break;
      case 3:
        text.replace(at, random() % 3, pieces[random() % std::size(pieces)]);
        break;
      default:
        if (const std::size_t digit = text.find_first_of("0123456789", at); digit != std::string::npos)
          text[digit] = static_cast<char>('0' + random() % 10);
        break;
    }
  }
  return text;
}

TEST(Damage, IsRefusedOrReadButNeverFatal) {
  std::mt19937 random(20260101);
  const std::string overrides[] = {"time.step=0.01", "output.times=[0,\"pi\"]", "particles.cutoff=gauss4",
                                   "params.R=1/3", "velocity.u=[\"y\",\"x\"]"};
  int read = 0, refused = 0;
  for (int k = 0; k < 2000; ++k) {
    const std::string text = k % 4 == 0 ? cone : damaged(k % 4 == 1 ? least : cone, random);
    const std::vector<std::string> given =
        k % 4 == 0 ? std::vector{damaged(overrides[random() % std::size(overrides)], random)}
                   : std::vector<std::string>{};
    try {
      const Case scene = parse(text, given);
      ++read;
      expect_same(parse(case_text(scene)), scene);
    } catch (const CaseError& error) {
      ++refused;
      const std::string message = error.what();
      EXPECT_EQ(message.substr(0, 7), "error: ") << message;
      EXPECT_NE(message.find("--> "), std::string::npos) << message;
    }
    if (testing::Test::HasFailure()) FAIL() << "the damaged case was\n" << text << (given.empty() ? "" : given[0]);
  }
  EXPECT_GT(read, 200) << "too few of the damaged cases were valid to say much";
  EXPECT_GT(refused, 200);
}

}  // namespace
}  // namespace gaussdrift::input
