// The folder of a run may come from anybody: what reads its JSON says which file is wrong and why, and ends with exit code 6.
#include <gtest/gtest.h>

#include <algorithm>

#include "program/program.hpp"

namespace gaussdrift {
namespace {

class CraftedFolder : public testing::Test {
 protected:
  CraftedFolder() {
    write_file(folder / "a.toml", small_case);
    EXPECT_EQ(gaussdrift_in(folder, "run a.toml --out r --set 'output.report=\"none\"'").exit_code, 0);
  }
  void expect_refused(const std::string& arguments, const std::string& why) const {
    const Outcome out = gaussdrift_in(folder, arguments);
    EXPECT_EQ(out.exit_code, 6) << arguments << "\n" << out.err;
    EXPECT_NE(out.err.find("error: r/" + why), std::string::npos) << arguments << "\n" << out.err;
    EXPECT_EQ(std::count(out.err.begin(), out.err.end(), '\n'), 1) << out.err;
  }
  const ScratchFolder folder;
};

const std::string deep = R"({"complete": )" + std::string(200'000, '[');

TEST_F(CraftedFolder, ASummaryIsRefusedByEachVerbThatReadsIt) {
  const std::string honest = read_file(folder / "r/summary.json");
  std::string other = honest;
  other.replace(other.find("\"complete\": true"), 16, "\"complete\": [0]");
  write_file(folder / "r/summary.json", other);
  for (const char* verb : {"resume r", "report r", "render r", "compare r r"})
    expect_refused(verb, "summary.json is damaged: complete is neither true nor false; ");
  write_file(folder / "r/summary.json", deep);
  for (const char* verb : {"resume r", "report r", "render r", "compare r r"})
    expect_refused(verb, "summary.json is damaged: it is nested more than 50 deep; ");
  fs::resize_file(folder / "r/summary.json", std::uintmax_t{1} << 40);  // a hole: it takes no room
  for (const char* verb : {"resume r", "report r"})
    expect_refused(verb, "summary.json is damaged: it has 1099511627776 bytes, at most 268435456 are read; ");
  fs::remove(folder / "r/summary.json");
  EXPECT_EQ(gaussdrift_in(folder, "compare r r").exit_code, 0) << "the remedy";
}

TEST_F(CraftedFolder, AStatusIsRefusedByResumeAndByANewRun) {
  for (const auto& [text, why] : {std::pair<std::string, std::string>{deep, "it is nested more than 50 deep"},
                                  {std::string(2'000'000, ' '), "it has 2000000 bytes, at most 1000000 are read"},
                                  {R"({"kind": "run", "state": 3, "files": 3})", ""}}) {
    write_file(folder / "r/status.json", text);
    expect_refused("resume r", "status.json is damaged: " + (why.empty() ? "state is no text" : why));
    expect_refused("run a.toml --out r --force",
                   "status.json is damaged: " + (why.empty() ? "a member is missing or has another type" : why));
  }
  fs::remove(folder / "r/status.json");
  EXPECT_EQ(gaussdrift_in(folder, "resume r").exit_code, 0) << "the remedy";
}

TEST_F(CraftedFolder, AProvenanceIsRefusedByResumeAndNamedOnThePage) {
  write_file(folder / "r/provenance.json", deep);
  expect_refused("resume r", "provenance.json is damaged: it is nested more than 50 deep; remove it");
  ASSERT_EQ(gaussdrift_in(folder, "report r").exit_code, 0);
  EXPECT_NE(read_file(folder / "r/report.html").find("how the run was made: r/provenance.json is damaged: "),
            std::string::npos);
}

/// What is behind it may be a file of the reader, and would come onto a page or into a picture.
TEST_F(CraftedFolder, NoLinkThatLeadsOutOfItIsFollowed) {
  fs::copy(folder / "r", folder / "honest", fs::copy_options::recursive);
  for (const char* name : {"density/density_0001.vti", "density", "density.pvd"}) {
    fs::remove_all(folder / "r"), fs::copy(folder / "honest", folder / "r", fs::copy_options::recursive);
    fs::remove_all(folder / "r" / name);
    fs::create_symlink(folder / "honest" / name, folder / "r" / name);
    const std::string first = std::string(name) == "density" ? "density/density_000" : name;
    for (const char* verb : {"compare r honest", "compare honest r"}) expect_refused(verb, first);
    const Outcome compared = gaussdrift_in(folder, "compare r honest");
    EXPECT_NE(compared.err.find("is a link out of the folder of the run, or lies behind one"), std::string::npos)
        << compared.err;
    if (!draws_pictures) continue;
    expect_refused("render r --out drawn", first);
    const Outcome page = gaussdrift_in(folder, "report r");
    EXPECT_NE((page.out + page.err).find("is a link out of the folder of the run"), std::string::npos)
        << page.out << page.err;
  }
  fs::remove_all(folder / "r"), fs::copy(folder / "honest", folder / "r", fs::copy_options::recursive);
  fs::rename(folder / "r/density/density_0001.vti", folder / "r/mine.vti");
  fs::create_symlink("../mine.vti", folder / "r/density/density_0001.vti");
  EXPECT_EQ(gaussdrift_in(folder, "compare r honest").exit_code, 0) << "it leads to a file in the folder";
  for (const char* name : {"run.toml", "case.toml"}) {
    fs::remove_all(folder / "r"), fs::copy(folder / "honest", folder / "r", fs::copy_options::recursive);
    fs::remove(folder / "r" / name);
    fs::create_symlink(folder / "honest" / name, folder / "r" / name);
    expect_refused("resume r", std::string(name) + " is a link out of the folder of the run");
  }
}

TEST_F(CraftedFolder, AnEarlierStudyWhoseListIsDamagedIsNotMixedWithANewOne) {
  for (const std::string& text : {deep, std::string(R"({"experiments": [{"name": 3}]})"), std::string("{}")}) {
    write_file(folder / "r/study.json", text);
    expect_refused("study a.toml --out r --force", "study.json is damaged: ");
  }
}

}  // namespace
}  // namespace gaussdrift
