// gaussdrift explain: what a person who writes a case is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "parsed_json.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

TEST(Explain, TellsAKeyByItsNameAndByItsSymbol) {
  const ScratchFolder folder;
  const Outcome by_name = gaussdrift_in(folder, "explain particles.per_axis");
  ASSERT_EQ(by_name.exit_code, 0) << by_name.err;
  for (const char* part : {"particles.per_axis", "The spacing h is the same on all axes", "a whole number",
                           "at least 2", "required", "n_g"})
    EXPECT_NE(by_name.out.find(part), std::string::npos) << part << " in:\n" << by_name.out;
  for (const char* symbol : {"n_g", "'$n_{g}$'"}) {
    const std::string told = gaussdrift_in(folder, std::string("explain ") + symbol).out;
    EXPECT_TRUE(told.starts_with(by_name.out + "\n")) << told;  // then as a symbol of the thesis
    EXPECT_NE(told.find("[Sch06, Table A.3]"), std::string::npos) << told;
  }
  EXPECT_NE(gaussdrift_in(folder, "explain per_axis").out.find("evaluate.per_axis"), std::string::npos);
}

TEST(Explain, TellsAKeyOfSeveralFieldsOnce) {
  const ScratchFolder folder;
  const std::string text = gaussdrift_in(folder, "explain circulation").out;
  EXPECT_NE(text.find("goes with  field = \"lamb_oseen\", field = \"burgers\""), std::string::npos) << text;
  EXPECT_EQ(text.find("velocity.circulation"), text.rfind("velocity.circulation")) << text;
}

TEST(Explain, NamesTheWordThatWasMeant) {
  const ScratchFolder folder;
  const Outcome refused = gaussdrift_in(folder, "explain overlapp");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.out, "");
  EXPECT_NE(refused.err.find("did you mean \"overlap\"?"), std::string::npos) << refused.err;
  EXPECT_EQ(gaussdrift_in(folder, "explain overlap --schema").exit_code, 2);
}

TEST(Explain, SaysWhatIsPossibleInPlaceOfWordsOfOtherPrograms) {
  const ScratchFolder folder;
  EXPECT_NE(gaussdrift_in(folder, "explain wrap").err.find("edges = [\"periodic\""), std::string::npos);
  EXPECT_NE(gaussdrift_in(folder, "explain sgn").err.find("write sign(a)"), std::string::npos);
  EXPECT_NE(gaussdrift_in(folder, "explain effects").out.find("vortex goes with charge, remesh"), std::string::npos);
}

TEST(Explain, GivesTheSameAsJson) {
  const ScratchFolder folder;
  const auto one = parsed_json(gaussdrift_in(folder, "explain overlap --json").out);
  ASSERT_EQ(one["meanings"].size(), 1u);
  EXPECT_EQ(one["meanings"][0]["name"], "particles.overlap");
  EXPECT_EQ(one["meanings"][0]["facts"]["default"], "2");
  const auto all = parsed_json(gaussdrift_in(folder, "explain --json").out);
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const auto& key) { return key["key"] == "density.slot_width"; }));
  // Every key of the list is one that can be explained, and stands in the overview or goes with a named formula.
  const std::string overview = gaussdrift_in(folder, "explain").out;
  for (const auto& key : all) {
    const std::string name = key["key"].get<std::string>();
    EXPECT_TRUE(key.contains("goes with") ||
                overview.find("  " + name.substr(name.rfind('.') + 1)) != std::string::npos)
        << name;
  }
}

TEST(Explain, PrintsASchemaThatIsClosedAgainstUnknownKeys) {
  const ScratchFolder folder;
  const auto schema = parsed_json(gaussdrift_in(folder, "explain --schema").out);
  EXPECT_EQ(schema["additionalProperties"], false);
  const auto& particles = schema["properties"]["particles"];
  EXPECT_EQ(particles["additionalProperties"], false);
  EXPECT_EQ(particles["required"], nlohmann::json({"per_axis"}));
  EXPECT_EQ(particles["properties"]["per_axis"]["anyOf"][0], nlohmann::json({{"type", "integer"}, {"minimum", 2.0}}));
  // A parameter is there beside its shape alone.
  int with_slot = 0;
  for (const auto& variant : schema["properties"]["density"]["anyOf"][0]["oneOf"])
    if (variant["properties"].contains("slot_width")) {
      EXPECT_EQ(variant["properties"]["shape"]["const"], "slotted_disk");
      ++with_slot;
    }
  EXPECT_EQ(with_slot, 1);
}

TEST(Explain, WritesTheGeneratedPartsOfTheGuide) {
  const ScratchFolder folder;
  const std::string guide = read_file(SOURCE_DIR "/docs/cases.md");
  std::string damaged = guide;
  damaged.replace(damaged.find("| `overlap` |"), 13, "| `overlapp` |");
  write_file(folder / "cases.md", damaged);
  EXPECT_EQ(gaussdrift_in(folder, "explain --markdown cases.md").exit_code, 0);
  EXPECT_EQ(read_file(folder / "cases.md"), guide);
  write_file(folder / "other.md", "no marks");
  EXPECT_EQ(gaussdrift_in(folder, "explain --markdown other.md").exit_code, 3);
  EXPECT_EQ(gaussdrift_in(folder, "explain --markdown missing.md").exit_code, 6);
}

}  // namespace
}  // namespace gaussdrift
