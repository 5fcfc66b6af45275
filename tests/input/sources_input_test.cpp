// [[source]]: what a case may say, and what it may not.
#include <gtest/gtest.h>

#include <fstream>

#include "cases.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::input {
namespace {

std::string with_source(const std::string& lines, const std::string& more = "") {
  return errors(cone + "[[source]]\n" + lines + "\n" + more);
}

const std::string point = "point = [0.1, 0.2]\n", rate = point + "from = 1\nto = 2\nrate = \"turn * t\"\n";

TEST(Source, IsWrittenAsItIsRead) {
  const std::string three =
      cone + "[[source]]\n" + rate + "puffs = 7\n[[source]]\n" + point +
      "at = 1\namount = 0.1\n[[source]]\nshape = \"gaussian\"\ncenter = [0, 0]\nradius = 0.1\nat = 2\n";
  const Case spec = parse_case(three, "cone.toml").spec;
  ASSERT_EQ(spec.sources.size(), 3u);
  EXPECT_EQ(spec.sources[0].puffs, 7);
  const std::string text = gaussdrift::case_text(spec);
  expect_has(text, "[[source]]\npoint = [0.1, 0.2]\nfrom = 1\nto = 2\nrate = \"turn * t\"\npuffs = 7\n");
  expect_has(text, "[[source]]\npoint = [0.1, 0.2]\namount = 0.1\nat = 1\n");
  EXPECT_EQ(gaussdrift::case_text(parse_case(text, "again.toml").spec), text);
  EXPECT_EQ(gaussdrift::case_text(parse_case(cone, "cone.toml").spec).find("source"), std::string::npos);
}

TEST(Source, NeedsAPlaceATimeAndAnAmount) {
  EXPECT_EQ(with_source(rate), "");
  expect_has(with_source("at = 1"), "[source] has none of \"shape\", \"point\", \"points\"");
  expect_has(with_source(point), "[source] has none of \"at\", \"from\"");
  expect_has(with_source(rate + "at = 1"), "[source] has both \"from\" and \"at\"");
  expect_has(with_source(point + "at = 1"), "a point that releases at one time needs an \"amount\"");
  expect_has(with_source(point + "from = 1"), "a release over an interval needs \"to\"");
  expect_has(with_source(point + "from = 1\nto = 2"), "a release over an interval needs \"rate\"");
  expect_has(with_source(rate + "amount = 1"), "\"amount\" goes with \"at\", not with \"from\"");
  expect_has(with_source(point + "at = 1\namount = 1\npuffs = 3"), "\"puffs\" goes with \"from\", not with \"at\"");
  expect_has(with_source("shape = \"gaussian\"\ncenter = [0, 0]\nradius = 0.1\nat = 1\namount = 3"),
             "\"amount\" goes with \"point\"");
  expect_has(with_source(rate + "puffs = 0"), "source.puffs must be at least 1");
  expect_has(with_source(point + "at = -1\namount = 1"), "source.at = -1 lies before the run, which begins at 0");
  expect_has(with_source(point + "from = 2\nto = 1\nrate = \"1\""), "source.to = 1 must be later than from = 2");
  expect_has(with_source("point = [1.1, 0]\nat = 1\namount = 1"), "source.point lies outside the domain");
  expect_has(with_source(point + "from = 1\nto = 2\nrate = \"x\""),
             "source.rate depends on the time t alone, not on x");
}

TEST(Source, SaysWhatDoesNotGoWithIt) {
  expect_has(with_source(rate, "[reference]\nkind = \"characteristics\"\n"),
             "kind = \"characteristics\" does not go with [[source]]: paths that are traced back");
  for (const auto& [effect, why] : std::vector<std::pair<std::string, std::string>>{
           {"remesh]\nevery = 3", "remeshing makes new particles, on the lattice"},
           {"diffusion]\nD = 0.1\nmethod = \"particle-exchange\"", "adds particles during the run, on the lattice"},
           {"diffusion]\nD = 0.1", "all blobs have the same width"},
           {"charge]\nmobility = 1", "move each other"}}) {
    const std::string words = with_source(rate, "[effects." + effect + "\n");
    expect_has(words, "[[source]] does not go with [effects." + effect.substr(0, effect.find(']')) + "]: ");
    expect_has(words, why);
  }
  EXPECT_EQ(with_source(rate, "[effects.reaction]\nrate = \"1\"\n"), "");
  expect_has(with_source(rate, "[accuracy]\ntarget = 1e-3\n"),
             "no settings can be chosen for a target with [[source]]");
  EXPECT_EQ(with_source(rate, "[[check]]\nwhat = \"released\"\nmin = 1\n"), "");
  expect_has(errors(cone + "[[check]]\nwhat = \"released\"\nmin = 1\n"),
             "no [[source]] releases anything in this case");
  EXPECT_EQ(parse_case(cone + "[[source]]\n" + rate, "cone.toml").spec.reference.kind, ReferenceSpec::Kind::none);
}

TEST(Source, ReadsATableAndSaysWhichRowIsWrong) {
  const ScratchFolder folder;
  const auto errors_of = [&](const std::string& table, const std::string& more = "") -> std::string {
    std::ofstream(folder.path() / "p.csv") << table;
    try {
      parse_case(cone + "[[source]]\npoints = \"p.csv\"\n" + more, folder.path() / "cone.toml");
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(errors_of("x,y,t,amount\n0,0,1,2\n"), "");
  expect_has(errors_of("x,y,amount\n0,0,1\n"), "there is no column \"t\"");
  expect_has(errors_of("x,y,t,amount\n0,0,1,2\n0,7,1,2\n"), "p.csv:3:1: the point lies outside the domain");
  expect_has(errors_of("x,y,t,amount\n0,0,-1,2\n"), "p.csv:2:1: t = -1 lies before the run");
  expect_has(errors_of("x,y,t,amount\n0,0,1,2\n", "at = 1\n"), "\"at\" does not go with \"points\"");
}

TEST(HalfLife, StandsInPlaceOfARate) {
  const std::string reaction = cone + "[effects.reaction]\n";
  EXPECT_EQ(errors(reaction + "half_life = 2\n"), "");
  expect_has(errors(reaction + "half_life = 2\nrate = \"1\"\n"), "has both \"half_life\" and \"rate\"");
  expect_has(errors(reaction), "has neither \"rate\" nor \"half_life\"");
  expect_has(errors(reaction + "half_life = 0\n"), "effects.reaction.half_life must be greater than 0");
}

}  // namespace
}  // namespace gaussdrift::input
