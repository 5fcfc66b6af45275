// docs/tutorial.md: a reader who follows it gets the files, lines and numbers that the page shows. Only the pictures
// are left out.
#include <gtest/gtest.h>

#include <cmath>

#include <utility>
#include <vector>

#include "program/program.hpp"

namespace gaussdrift {
namespace {

std::vector<std::string> split(const std::string& text, const std::string& between) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(between, begin)) != std::string::npos; begin = end + between.size())
    parts.push_back(text.substr(begin, end - begin));
  if (begin < text.size()) parts.push_back(text.substr(begin));
  return parts;
}

/// What stands between the fences of a page.
struct Page {
  std::vector<std::string> pieces;  // of case files
  std::vector<std::string> lines;   // that the program says
};

Page read_page(const std::string& file) {
  Page page;
  std::string kind;
  bool inside = false;
  for (const std::string& line : split(read_file(SOURCE_DIR "/" + file), "\n")) {
    if (line.rfind("```", 0) == 0) {
      inside = !inside;
      kind = inside ? line.substr(3) : "";
      if (kind == "toml") page.pieces.emplace_back();
    } else if (inside && kind == "toml") {
      page.pieces.back() += line + "\n";
    } else if (inside) {
      page.lines.push_back(line);
    }
  }
  return page;
}

/// The lines of the page that begin with `start`, in its order. Of a line that ends with "..." the rest is not shown.
std::vector<std::string> shown(const Page& page, const std::string& start) {
  const std::string cut = " ...";
  std::vector<std::string> found;
  for (const std::string& line : page.lines)
    if (line.rfind(start, 0) == 0)
      found.push_back(line.ends_with(cut) ? line.substr(0, line.size() - cut.size()) : line);
  return found;
}

std::string header(const std::string& table) { return table.substr(0, table.find_first_of(" \n")); }

/// The case with the tables of a piece in place of those of the same name. Tables stand apart by an empty line.
std::string with(const std::string& text, const std::string& piece, const std::string& instead_of = "") {
  std::string result;
  for (const std::string& table : split(text, "\n\n")) {
    bool replaced = header(table) == instead_of;
    for (const std::string& fresh : split(piece, "\n\n")) replaced |= header(table) == header(fresh);
    if (!replaced) result += table + (table.back() == '\n' ? "\n" : "\n\n");
  }
  return result + piece;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The density is compared on the whole grid, as it is for a picture of the error.
const std::string numbers_and_budget =
    " --force --set 'output.images=[]' --set 'output.vtk=[]' --set output.report=none --set reference.points=26600";
const std::string numbers_alone = numbers_and_budget + " --set accuracy.budget=none";

TEST(Readme, FirstSceneComesOutAsShown) {
  const Page page = read_page("README.md");
  const ScratchFolder folder;
  ASSERT_EQ(page.pieces.size(), 1u);
  write_file(folder / "cone.toml", page.pieces[0]);
  const std::string quiet =
      " --set 'output.images=[]' --set 'output.vtk=[]' --set output.report=none --set reference.points=40000";
  const Outcome run = gaussdrift_in(folder, "run cone.toml" + quiet);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* start : {"error  at", "budget", "hint"}) {
    ASSERT_EQ(shown(page, start).size(), 1u);
    EXPECT_TRUE(contains(run.out, shown(page, start)[0])) << run.out;
  }
  const Outcome chosen = gaussdrift_in(folder, "run cone.toml --force --accuracy 1e-3" + quiet);
  EXPECT_EQ(chosen.exit_code, 0) << chosen.err;
  EXPECT_TRUE(contains(chosen.out, "target 0.001: achieved ")) << chosen.out;
}

TEST(Tutorial, SmallestSceneRunsAndATypingErrorIsNamed) {
  const Page page = read_page("docs/tutorial.md");
  const ScratchFolder folder;
  ASSERT_EQ(page.pieces.size(), 7u);
  write_file(folder / "bay.toml", page.pieces[0]);
  const Outcome run = gaussdrift_in(folder, "run bay.toml --set 'output.images=[]'");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(shown(page, "open").size(), 1u);
  const std::string open = shown(page, "open")[0];
  EXPECT_TRUE(contains(run.out, open.substr(0, open.find(", pictures")))) << run.out;
  EXPECT_TRUE(fs::exists(folder / "output/bay/report.html"));

  std::string wrong = page.pieces[0];
  wrong.replace(wrong.find("radius"), 6, "radus");
  write_file(folder / "bay.toml", wrong);
  const Outcome refused = gaussdrift_in(folder, "run bay.toml --force");
  EXPECT_EQ(refused.exit_code, 3);
  for (const char* start : {"error: unknown", "  -->"}) {
    ASSERT_EQ(shown(page, start).size(), 1u);
    EXPECT_TRUE(contains(refused.err, shown(page, start)[0])) << refused.err;
  }
}

TEST(Tutorial, ShowsTheNumbersOfEveryStep) {
  const Page page = read_page("docs/tutorial.md");
  const ScratchFolder folder;
  ASSERT_EQ(page.pieces.size(), 7u);
  const auto warnings = shown(page, "warning:"), errors = shown(page, "error  at"), budgets = shown(page, "budget"),
             checks = shown(page, "check  passed");
  ASSERT_EQ(warnings.size(), 1u);
  ASSERT_EQ(errors.size(), 3u);
  ASSERT_EQ(budgets.size(), 1u);
  ASSERT_EQ(checks.size(), 2u);

  std::string scene = with(with(page.pieces[0], page.pieces[1], "[velocity]"), page.pieces[2]);
  write_file(folder / "bay.toml", scene);
  const Outcome eddy = gaussdrift_in(folder, "run bay.toml" + numbers_and_budget);
  EXPECT_EQ(eddy.exit_code, 0) << eddy.err;
  EXPECT_TRUE(contains(eddy.err, warnings[0])) << eddy.err;
  EXPECT_TRUE(contains(eddy.out, errors[0])) << eddy.out;
  EXPECT_TRUE(contains(eddy.out, budgets[0])) << eddy.out;
  const Outcome chosen = gaussdrift_in(folder, "run bay.toml --accuracy 0.05" + numbers_and_budget);
  EXPECT_EQ(chosen.exit_code, 0) << chosen.err;
  EXPECT_TRUE(contains(chosen.out, "chosen particles.per_axis = ")) << chosen.out;
  EXPECT_TRUE(contains(chosen.out, "target 0.05: achieved ")) << chosen.out;
  EXPECT_FALSE(contains(chosen.err, "false gaps")) << chosen.err;

  scene = with(scene, page.pieces[3]);
  write_file(folder / "bay.toml", scene);
  const Outcome fine = gaussdrift_in(folder, "run bay.toml" + numbers_alone);
  EXPECT_EQ(fine.exit_code, 0) << fine.err;
  EXPECT_FALSE(contains(fine.err, "warning")) << fine.err;
  EXPECT_TRUE(contains(fine.out, errors[1])) << fine.out;

  const std::string& whole = page.pieces[6];
  for (std::size_t piece = 1; piece < 6; ++piece)
    for (const std::string& table : split(page.pieces[piece], "\n\n")) EXPECT_TRUE(contains(whole, table)) << table;
  write_file(folder / "bay.toml", whole);
  const Outcome run = gaussdrift_in(folder, "run bay.toml" + numbers_alone);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(contains(run.out, errors[2])) << run.out;
  for (const std::string& check : checks) EXPECT_TRUE(contains(run.out, check)) << run.out;
}

TEST(Readme, CitationNamesTheVersionOfTheProgram) {
  const ScratchFolder folder;
  const std::string told = gaussdrift_in(folder, "--version").out, citation = read_file(SOURCE_DIR "/CITATION.cff");
  const std::size_t at = citation.find("\nversion: ");
  ASSERT_NE(at, std::string::npos);
  const std::string version = citation.substr(at + 10, citation.find('\n', at + 10) - at - 10);
  EXPECT_TRUE(contains(told, version)) << told;
  EXPECT_TRUE(contains(read_file(SOURCE_DIR "/CHANGELOG.md"), "## [" + version + "]"));
}

/// The scene with other words in place of some of its own.
std::string replaced(std::string scene, const std::vector<std::pair<std::string, std::string>>& words) {
  for (const auto& [own, other] : words) {
    EXPECT_TRUE(contains(scene, own)) << scene;
    scene.replace(scene.find(own), own.size(), other);
  }
  return scene;
}

/// The scene of the README, coarser, where a page is about commands and not about numbers. It keeps the picture "error",
/// which does not go with every setting.
std::string coarse_cone() {
  return replaced(read_page("README.md").pieces[0],
                  {{"per_axis = 300", "per_axis = 50"},
                   {"step = 0.01", "step = 0.2"},
                   {"times  = [0, \"pi\", \"2*pi\"]", "times  = [\"2*pi\"]"},
                   {"[\"surface\", \"error\"]", draws_pictures ? "[\"error\"]" : "[]"}});
}

/// The scene of the tutorial with the eddy.
std::string bay_with_eddy() {
  const Page page = read_page("docs/tutorial.md");
  return replaced(with(with(page.pieces[0], page.pieces[1], "[velocity]"), page.pieces[2]),
                  {{"images = [\"heatmap\", \"error\"]", "images = []"}});
}

/// A hundred scattered points and a value, for the commands that read one.
std::string scattered(const std::string& names, int columns) {
  std::string text = names + "\n";
  for (int point = 0; point < 100; ++point)
    for (int column = 0; column < columns; ++column) {
      const double number = std::fmod(0.37 * (point + 1) * (column + 1) + 0.11 * point * point, 1);
      text += std::to_string(number) + (column + 1 < columns ? "," : "\n");
    }
  return text;
}

TEST(Pages, EveryCommandOfTroubleAndUsageRuns) {
  const ScratchFolder folder;
  write_file(folder / "cloud.csv", scattered("x,y,rho", 3));
  write_file(folder / "wind.csv", scattered("x,y,z,u", 4));
  write_file(folder / "cone.toml", coarse_cone());
  write_file(folder / "bay.toml", bay_with_eddy());
  write_file(folder / "quakes.txt", "# depth longitude latitude\n10 0.5 1\n12 -1 0.25\n30 2 -3\n");
  for (const char* name : {"docs/trouble.md", "docs/usage.md"}) {
    const Page page = read_page(name);
    int commands = 0;
    for (const std::string& line : page.lines)  // the table of usage.md
      if (line == "id,x,y,weight") write_file(folder / "S.csv", line + "\n1,0,0,1\n2,1,0,1\n");
    for (const std::string& line : shown(page, "gaussdrift ")) {
      const std::string arguments = line.substr(11, line.find(" #") - 11);
      if (!draws_pictures && (arguments.starts_with("render") || arguments.starts_with("doctor"))) continue;
      const bool built_in = arguments.rfind("run rotating_cone.toml", 0) == 0;  // smaller: other tests run it whole
      const Outcome outcome = gaussdrift_in(
          folder,
          arguments +
              (built_in ? " --set time.step=0.2 --set 'output.images=[]' --set 'output.vtk=[\"density\"]'" : ""));
      EXPECT_EQ(outcome.exit_code, 0) << line << "\n" << outcome.err;
      ++commands;
    }
    EXPECT_GE(commands, 6) << name;
  }
}

}  // namespace
}  // namespace gaussdrift
