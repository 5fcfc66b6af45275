// domain.edges: what a case may say, and what it may not.
#include <gtest/gtest.h>

#include "cases.hpp"

namespace gaussdrift::input {
namespace {

/// The message of a case with these edges; empty: it is valid.
std::string with_edges(const std::string& edges, const std::vector<std::string>& more = {},
                       const std::string& text = cone) {
  std::vector<std::string> overrides{"domain.edges=" + edges};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return errors(text, overrides);
}

TEST(Edges, AreOneWordOrTwoAnAxis) {
  const Case spec = parse_case(cone, "cone.toml", {"domain.edges=[\"periodic\", [\"closed\", \"open\"]]"}).spec;
  EXPECT_EQ(spec.domain.edges[0], (std::array{Edge::periodic, Edge::periodic}));
  EXPECT_EQ(spec.domain.edges[1], (std::array{Edge::closed, Edge::open}));
  EXPECT_TRUE(spec.domain.has_edges() && spec.domain.has(Edge::open) &&
              !parse_case(cone, "cone.toml").spec.domain.has_edges());
  const std::string text = gaussdrift::case_text(spec);
  expect_has(text, "edges = [\"periodic\", [\"closed\", \"open\"]]\n");
  EXPECT_EQ(parse_case(text, "again.toml").spec.domain.edges, spec.domain.edges);
  EXPECT_EQ(gaussdrift::case_text(parse_case(cone, "cone.toml").spec).find("edges"), std::string::npos);
}

TEST(Edges, ThatAreNoneAreRefused) {
  expect_has(with_edges("\"periodic\""), "domain.edges must be a list with one of");
  expect_has(with_edges("[\"open\"]"), "domain.edges needs 2 words, one for each axis of the domain, found 1");
  expect_has(with_edges("[\"open\", \"perodic\"]"),
             "unknown value \"perodic\" for domain.edges along y; did you mean \"periodic\"?");
  expect_has(with_edges("[\"open\", 3]"), "domain.edges along y must be a string");
  expect_has(with_edges("[[\"open\"], \"open\"]"), "the ends of x need one word, or 2 words, found 1");
  expect_has(with_edges("[\"open\", [\"closed\", \"periodic\"]]"), "one end of y is periodic, the other is not");
  expect_has(with_edges("[\"open\", [\"closed\", [\"open\"]]]"), "must be a string");
}

TEST(Coast, IsReadWrittenAndRefusedWhereItDoesNotGo) {
  for (const auto& [word, rule] :
       {std::pair{"stop", AtCoast::stop}, {"slide", AtCoast::slide}, {"remove", AtCoast::remove}}) {
    const ReadResult read = parse_case(cone, "cone.toml", {std::string("domain.coast=") + word});
    EXPECT_EQ(read.spec.domain.coast, rule);
    ASSERT_EQ(read.warnings.size(), 1u);
    expect_has(read.warnings[0], "domain.coast has no effect: there is no land");
    EXPECT_EQ(parse_case(gaussdrift::case_text(read.spec), "again.toml").spec.domain.coast, rule);
  }
  EXPECT_EQ(gaussdrift::case_text(parse_case(cone, "cone.toml").spec).find("coast"), std::string::npos);
  const auto with_coast = [](const std::string& text) { return errors(text, {"domain.coast=stop"}); };
  expect_has(errors(cone, {"domain.coast=stopp"}), "did you mean \"stop\"?");
  expect_has(with_coast(cone + "[effects.remesh]\nevery = 3\n"), "domain.coast does not go with [effects.remesh]");
  expect_has(with_coast(cone + "[effects.diffusion]\nD = 0.1\nmethod = \"particle-exchange\"\n"),
             "method = \"core-spreading\" goes with a coast");
  expect_has(with_coast(cone + "[accuracy]\ntarget = 1e-3\n"),
             "no settings can be chosen for a target with domain.coast");
  expect_has(with_coast(cone + "[[check]]\nwhat = \"left\"\nmax = 1\n"), "no particle can leave this run");
  expect_has(errors(cone + "[[check]]\nwhat = \"stopped\"\nmax = 1\n", {}), "no particle of this run stops");
}

TEST(Edges, NeedASpacingThatDividesTheLength) {
  EXPECT_EQ(with_edges("[\"periodic\", \"closed\"]", {"domain.max=[1, 0.5]", "particles.per_axis=301"}), "");
  const std::string words = with_edges("[\"periodic\", \"closed\"]", {"domain.max=[1, 0.5]", "particles.per_axis=300"});
  expect_has(words,
             "the spacing 0.00668896 of the particle lattice does not divide the length 1.5 of y, whose ends are "
             "periodic or closed");
  expect_has(words, "per_axis = 297 or 301 does it");
  EXPECT_EQ(with_edges("[\"periodic\", \"open\"]", {"domain.max=[1, 0.5]", "particles.per_axis=300"}), "");
  expect_has(with_edges("[\"periodic\", \"closed\"]", {"domain.max=[1, \"pi\"]"}),
             "make the lengths of the domain small multiples of one length");
}

TEST(Edges, DoNotGoWithWhatKnowsNothingOfThem) {
  const std::string remesh = cone + "[effects.remesh]\nevery = 3\n",
                    exchange = cone + "[effects.diffusion]\nD = 0.1\nmethod = \"particle-exchange\"\n",
                    spreading = cone + "[effects.diffusion]\nD = 0.1\n",
                    charge = cone + "[effects.charge]\nmobility = 1\n", target = cone + "[accuracy]\ntarget = 1e-3\n";
  for (const std::string edges : {"[\"open\", \"open\"]", "[\"periodic\", \"closed\"]"}) {
    const bool open = edges.find("open") != std::string::npos;
    EXPECT_EQ(with_edges(edges, {}, remesh), "");
    EXPECT_EQ(with_edges(edges, {}, spreading), "");
    if (!open) {
      EXPECT_EQ(with_edges(edges, {}, exchange), "");
      EXPECT_EQ(with_edges(edges, {}, target), "");
      continue;
    }
    expect_has(with_edges(edges, {}, exchange), "particle-exchange does not go with open edges: what diffuses");
    expect_has(with_edges(edges, {}, exchange), "method = \"core-spreading\" or \"random-walk\"");
    expect_has(with_edges(edges, {}, target), "no settings can be chosen for a target with open edges");
  }
  for (const char* edges :
       {"[\"periodic\", \"closed\"]", "[\"periodic\", \"open\"]", "[[\"closed\", \"open\"], \"unbounded\"]"})
    EXPECT_EQ(with_edges(edges, {}, charge), "");
  expect_has(with_edges("[\"periodic\", \"closed\"]", {"effects.charge.tolerance=1e-12"}, charge),
             "must be at least 1e-11 with edges that are periodic or closed, found 1e-12");
  expect_has(with_edges("[\"periodic\", \"closed\"]", {"domain.max=[1, 99]", "particles.per_axis=501"}, charge),
             "domain.edges does not go with [effects.charge]: the domain along x has the length 2, must be at least");
  const std::string in_space =
      "gaussdrift = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nedges = [\"periodic\", \"periodic\", \"open\"]\n"
      "[velocity]\nu = [\"0\", \"0\", \"0\"]\n[density]\nexpression = \"1\"\n[particles]\nper_axis = 21\n"
      "[time]\nend = 1\nstep = 0.1\n[effects.charge]\nmobility = 1\n";
  expect_has(errors(in_space, {}),
             "in three dimensions the images of particles are summed where all axes are periodic or");
  EXPECT_EQ(with_edges("[\"open\", \"unbounded\"]", {}, charge), "");
  EXPECT_EQ(with_edges("[\"unbounded\", \"unbounded\"]", {}, remesh), "") << "as if nothing were said";
}

TEST(Edges, AreCheckedByTheirNames) {
  const auto check = [](const std::string& lines, const std::string& edges = "[\"open\", [\"open\", \"closed\"]]") {
    return with_edges(edges, {}, cone + "[[check]]\nmax = 1\n" + lines + "\n");
  };
  EXPECT_EQ(check("what = \"left\""), "");
  EXPECT_EQ(check("what = \"left\"\nby = \"y_min\""), "");
  EXPECT_EQ(check("what = \"inside\"", "[\"periodic\", \"unbounded\"]"), "");
  expect_has(check("what = \"left\"\nby = \"y_max\""), "no particle of this run leaves by \"y_max\"");
  expect_has(check("what = \"left\"\nby = \"y_max\""), "reasons to leave: x_min, x_max, y_min");
  expect_has(check("what = \"left\"", "[\"periodic\", \"closed\"]"), "no particle can leave this run");
  expect_has(check("what = \"mass\"\nby = \"x_min\""), "\"by\" goes with what = \"left\", not with \"mass\"");
  expect_has(errors(cone + "[[check]]\nwhat = \"inside\"\nmax = 1\n"),
             "counted only where domain.edges or domain.coast is given");
}

}  // namespace
}  // namespace gaussdrift::input
