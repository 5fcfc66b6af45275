// Which effects go together: the list, the reader and the program say the same.
#include "input/effect_rules.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "case_text.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "input/explain.hpp"

namespace gaussdrift::input {
namespace {

/// What a scene has beside transport.
struct Effects {
  bool reaction = false, diffusion = false, charge = false, vortex = false, remesh = false;
  bool exchange = false, own_charge = false, space = false;  // particle-exchange; a density of charge; three dimensions
};

/// The rules once more, written for this test alone.
bool go_together(const Effects& e) {
  if (e.charge && e.reaction && !e.own_charge) return false;
  if (e.charge && e.diffusion && (e.exchange || e.space)) return false;
  if (e.charge && e.remesh && e.own_charge) return false;
  if (e.vortex && (e.reaction || e.space)) return false;
  return !(e.vortex && e.diffusion && e.exchange);
}

std::string case_of(const Effects& e) {
  std::string text = case_text({.domain = e.space ? unit_cube : unit_square,
                                .velocity = e.space ? velocity_of({"0.1", "0", "0"}) : velocity_of({"0.1", "0"}),
                                .density = shape_of("gaussian", e.space ? "0, 0, 0" : "0, 0", "0.3"),
                                .particles = "per_axis = 6",
                                .time = "end = 0.02\nstep = 0.01",
                                .evaluate = "per_axis = 5",
                                .reference = not_compared});
  if (e.reaction) text += "[effects.reaction]\nrate = 1\n";
  if (e.diffusion)
    text += fmt::format("[effects.diffusion]\nD = 0.001\nmethod = \"{}\"\n",
                        e.exchange ? "particle-exchange" : "core-spreading");
  if (e.charge) text += fmt::format("[effects.charge]\nmobility = 0.01\n{}", e.own_charge ? "density = 1\n" : "");
  if (e.vortex) text += "[effects.vortex]\n";
  if (e.remesh) text += "[effects.remesh]\nevery = 1\n";
  return text;
}

// Every scene that the reader takes runs, and no other is refused.
TEST(EffectRules, AreWhatTheReaderAndTheProgramKeep) {
  int taken = 0;
  for (unsigned bits = 0; bits < 256; ++bits) {
    const auto bit = [&](unsigned k) { return (bits >> k & 1u) != 0; };
    const Effects e{bit(0), bit(1), bit(2), bit(3), bit(4), bit(5), bit(6), bit(7)};
    if ((e.exchange && !e.diffusion) || (e.own_charge && !e.charge)) continue;  // the same scene as without
    const std::string text = case_of(e);
    if (!go_together(e)) {
      EXPECT_THROW(parse_case(text, "scene.toml"), CaseError) << text;
      continue;
    }
    ReadResult read;
    ASSERT_NO_THROW(read = parse_case(text, "scene.toml")) << text;
    ++taken;
    if (e.reaction + e.diffusion + e.charge + e.vortex + e.remesh > 2) continue;  // pairs are what the rules are about
    Simulation simulation(read.spec, 1);
    if (e.space) {  // remeshing takes seconds there
      EXPECT_NO_THROW(simulation.prepare()) << text;
      continue;
    }
    EXPECT_EQ(simulation.run().frames.size(), 2u) << text;
  }
  EXPECT_GT(taken, 30);
}

TEST(EffectRules, AreToldInTheError) {
  try {
    parse_case(case_of({.reaction = true, .vortex = true}), "scene.toml");
    FAIL() << "vortex and reaction were taken together";
  } catch (const CaseError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("[effects.vortex] does not go with [effects.reaction]: the reaction changes the weights"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("vortex goes with charge, remesh; with diffusion if method = \"core-spreading\""),
              std::string::npos)
        << text;
  }
}

TEST(EffectRules, AreExplained) {
  const auto found = explain("effects");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].facts.size(), effect_names().size());
}

}  // namespace
}  // namespace gaussdrift::input
