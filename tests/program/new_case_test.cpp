// gaussdrift new: what a person who begins a case is given.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "parsed_json.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

std::vector<std::string> example_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(SOURCE_DIR "/cases"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(New, ListsEveryExample) {
  const ScratchFolder folder;
  const auto list = parsed_json(gaussdrift_in(folder, "new --json").out);
  std::vector<std::string> names;
  for (const auto& example : list) {
    names.push_back(example["name"]);
    EXPECT_NE(example["title"], "") << example["name"];
    EXPECT_NE(example["shows"], "") << example["name"] << " lacks its line # Shows: ...";
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, example_names());
  EXPECT_NE(gaussdrift_in(folder, "new").out.find("rotating_cone"), std::string::npos);
}

TEST(New, ListsExamplesByWhatTheyShow) {
  const ScratchFolder folder;
  EXPECT_EQ(gaussdrift_in(folder, "new --list").out, gaussdrift_in(folder, "new").out);
  const std::string diffusion = gaussdrift_in(folder, "new --list Diffusion").out;
  for (const char* name : {"random_walk", "uneven_diffusion"})
    EXPECT_NE(diffusion.find(name), std::string::npos) << diffusion;
  EXPECT_EQ(diffusion.find("rotating_cone"), std::string::npos) << diffusion;
  const Outcome none = gaussdrift_in(folder, "new --list weather");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("flows in the plane; flows in space"), std::string::npos) << none.err;
  // A topic that is written in another way would stand alone, at the end.
  const auto list = parsed_json(gaussdrift_in(folder, "new --json").out);
  EXPECT_EQ(list.front()["shows"], "flows in the plane");
  EXPECT_EQ(list.back()["shows"], "charges and vortices");
}

TEST(New, WritesEveryExampleAsItStandsAndItCanBeChecked) {
  const ScratchFolder folder;
  for (const std::string& name : example_names()) {
    const Outcome written = gaussdrift_in(folder, "new " + name);
    ASSERT_EQ(written.exit_code, 0) << written.err;
    EXPECT_EQ(read_file(folder / (name + ".toml")), read_file(SOURCE_DIR "/cases/" + name + ".toml"));
    const Outcome checked = gaussdrift_in(folder, "check " + name + ".toml --set particles.per_axis=21");
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    EXPECT_EQ(checked.err, "");  // no warnings
  }
}

TEST(New, KeepsAFileThatIsThere) {
  const ScratchFolder folder;
  write_file(folder / "rotating_cone.toml", "mine");
  const Outcome refused = gaussdrift_in(folder, "new rotating_cone");
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_EQ(read_file(folder / "rotating_cone.toml"), "mine");
  EXPECT_EQ(gaussdrift_in(folder, "new rotating_cone --force").exit_code, 0);
  EXPECT_NE(read_file(folder / "rotating_cone.toml"), "mine");
  EXPECT_EQ(gaussdrift_in(folder, "new rotating_cone --out scenes/mine").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "scenes/mine/rotating_cone.toml"));
}

TEST(New, NamesTheExampleThatWasMeant) {
  const ScratchFolder folder;
  const Outcome refused = gaussdrift_in(folder, "new rotating_come");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("did you mean \"rotating_cone\"?"), std::string::npos) << refused.err;
}

TEST(New, WritesABlankCaseThatRuns) {
  const ScratchFolder folder;
  ASSERT_EQ(gaussdrift_in(folder, "new --blank 2d").exit_code, 0);
  ASSERT_EQ(gaussdrift_in(folder, "new pond --blank 3d --set 'case.title=A pond'").exit_code, 0);
  EXPECT_NE(read_file(folder / "pond.toml").find("\ntitle = \"A pond\" "), std::string::npos);
  for (const char* name : {"scene.toml", "pond.toml"}) {
    const std::string file = name;
    const Outcome checked = gaussdrift_in(folder, "check " + file);
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    EXPECT_EQ(checked.err, "");
    const Outcome run = gaussdrift_in(
        folder, "run " + file + " --set particles.per_axis=16 --set evaluate.per_axis=16 --set 'output.images=[]'");
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  EXPECT_EQ(gaussdrift_in(folder, "new --blank 2d").exit_code, 6);
  EXPECT_EQ(gaussdrift_in(folder, "new --blank 4d").exit_code, 2);
}

TEST(New, WritesOtherValues) {
  const ScratchFolder folder;
  const Outcome written = gaussdrift_in(folder, "new rotating_cone --set time.step=0.01");
  ASSERT_EQ(written.exit_code, 0) << written.err;
  std::string expected = read_file(SOURCE_DIR "/cases/rotating_cone.toml");
  expected.replace(expected.find("0.001 "), 6, "0.01  ");
  EXPECT_EQ(read_file(folder / "rotating_cone.toml"), expected);

  const Outcome refused = gaussdrift_in(folder, "new gridded_wind --set time.stp=0.01");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("did you mean \"step\"?"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(folder / "gridded_wind.toml") || fs::exists(folder / "gridded_wind_0.vti"));
  EXPECT_EQ(gaussdrift_in(folder, "new --set time.step=0.01").exit_code, 2);
}

}  // namespace
}  // namespace gaussdrift
