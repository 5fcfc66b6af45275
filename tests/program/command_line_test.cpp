#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "parsed_json.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

TEST(CommandLine, AnswersHelpAndVersion) {
  const ScratchFolder folder;
  const Outcome help = gaussdrift_in(folder, "--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* word : {"run", "check", "reproduce", "Exit codes"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  EXPECT_EQ(gaussdrift_in(folder, "--version").out.rfind("gaussdrift ", 0), 0u);
  EXPECT_NE(gaussdrift_in(folder, "run --help").out.find("--set"), std::string::npos);
}

TEST(CommandLine, TellsWhatToDoFirst) {
  const ScratchFolder folder;
  const Outcome first = gaussdrift_in(folder, "");
  EXPECT_EQ(first.exit_code, 0) << first.err;
  int commands = 0;
  std::istringstream lines(first.out);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("  gaussdrift ", 0) == 0) {  // what it advises runs, in this order
      const bool runs = line.find(" run ") != std::string::npos;
      const Outcome followed = gaussdrift_in(folder, line.substr(13, line.find("  ", 13) - 13) +
                                                         (runs ? " --set time.step=0.1 --set 'output.images=[]'" : ""));
      EXPECT_EQ(followed.exit_code, 0) << line << "\n" << followed.err;
      ++commands;
    }
  EXPECT_EQ(commands, 5) << first.out;
}

TEST(CommandLine, RefusesWhatItDoesNotKnow) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  for (const char* wrong : {"fly", "run", "run small.toml --frce", "run small.toml --threads 0",
                            "run small.toml --threads two", "reproduce moon"}) {
    const Outcome refused = gaussdrift_in(folder, wrong);
    EXPECT_EQ(refused.exit_code, 2) << wrong;
    EXPECT_EQ(refused.err.rfind("error: ", 0), 0u) << refused.err;
    EXPECT_EQ(refused.out, "") << wrong;
  }
  EXPECT_FALSE(fs::exists(folder / "output"));
}

TEST(CommandLine, NamesTheVerbThatWasMeant) {
  const ScratchFolder folder;
  const Outcome refused = gaussdrift_in(folder, "chekc small.toml");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("there is no command \"chekc\"; did you mean \"check\"?"), std::string::npos)
      << refused.err;
}

TEST(CommandLine, NamesTheOptionThatWasMeant) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  write_file(folder / "S.csv", "x,weight\n0,1\n");
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"run small.toml --frce", "run has no option \"--frce\", did you mean --force?"},
      {"run small.toml --acc 1e-3", "did you mean --accuracy?"},
      {"run small.toml -force", "run has no option \"-force\", did you mean --force?"},
      {"run small.toml --time.step=0.1", "keys of the case are set by --set time.step=0.1"},
      {"check small.toml --force", "check has no option \"--force\"; it belongs to new, run, study"},
      {"sum --source S.csv --sigma 1", "sum has no option \"--source\", did you mean --sources?"},
      {"sum --sources S.csv --sigma 1 --toleranc=1e-3", "did you mean --tolerance?"},
      {"run small.toml more.toml", "\"more.toml\" is one word too many; gaussdrift run --help shows its options"},
      {"small.toml", "to run the case write: gaussdrift run small.toml"},
      {"plot small.toml", "there is no command \"plot\"; did you mean \"render\"?"},
      {"run small.toml --\x1b[31m", "run has no option \"--\\x1b[31m\""}};
  for (const auto& [arguments, said] : wrong) {
    std::string quoted;
    for (const char c : arguments) quoted += c == '\x1b' ? "\"$(printf '\\033')\"" : std::string(1, c);
    const Outcome refused = gaussdrift_in(folder, quoted);
    EXPECT_EQ(refused.exit_code, 2) << arguments;
    EXPECT_NE(refused.err.find(said), std::string::npos) << arguments << "\n" << refused.err;
    EXPECT_EQ(refused.out, "") << arguments;
  }
  EXPECT_FALSE(fs::exists(folder / "output"));
}

TEST(CommandLine, NoticesThatStandardOutputCannotBeWritten) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome lost = gaussdrift_in(folder, "check small.toml >/dev/full");
  EXPECT_EQ(lost.exit_code, 6);
  EXPECT_NE(lost.err.find("standard output cannot be written"), std::string::npos) << lost.err;
}

TEST(CommandLine, GivesAllErrorsOfACaseAndExitsWith3) {
  const ScratchFolder folder;
  std::string text = small_case;
  text.replace(text.find("per_axis = 60"), 13, "per_axis = 60\noverlapp = 2");
  text.replace(text.find("step = 0.05"), 11, "step = -0.05");
  write_file(folder / "wrong.toml", text);
  for (const char* verb : {"run", "check"}) {
    const Outcome refused = gaussdrift_in(folder, std::string(verb) + " wrong.toml");
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.err.find("unknown key \"overlapp\" in [particles]; did you mean \"overlap\"?"), std::string::npos)
        << refused.err;
    EXPECT_NE(refused.err.find("wrong.toml:17:1"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("step = -0.05"), std::string::npos) << refused.err;
  }
  EXPECT_FALSE(fs::exists(folder / "output"));
}

TEST(CommandLine, ExitsWith6WhereTheCaseCannotBeRead) {
  const ScratchFolder folder;
  const Outcome refused = gaussdrift_in(folder, "run nowhere.toml");
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_NE(refused.err.find("nowhere.toml"), std::string::npos) << refused.err;
}

TEST(Check, DescribesACaseWithoutRunningIt) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome check = gaussdrift_in(folder, "check small.toml");
  ASSERT_EQ(check.exit_code, 0) << check.err;
  for (const char* part : {"small  2D  [-1,1]x[-1,1]   div u = 0   max|u|", "3 600 on the lattice", "transport only",
                           "126 steps", "3 frames of 1 600 points"})
    EXPECT_NE(check.out.find(part), std::string::npos) << part << " in:\n" << check.out;
  EXPECT_FALSE(fs::exists(folder / "output"));
}

TEST(Check, FindsTheDivergenceOfAFlow) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome check = gaussdrift_in(folder, "check small.toml --json --set 'velocity.u=[\"0.5*x\", \"0.25*y\"]'");
  ASSERT_EQ(check.exit_code, 0) << check.err;
  EXPECT_NEAR(parsed_json(check.out)["largest_divergence"].get<double>(), 0.75,
              1e-15);  // exact for a linear field up to rounding
}

TEST(Check, AcceptsAFieldThatIsFiniteWhereParticlesWillBe) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  // Particles move right with the place where the root begins: they never meet it, though their first places do.
  const std::string options =
      " small.toml --set 'density.center=[0,0]' --set density.radius=0.1 --set time.end=1 --set output.frames=2 "
      "--set 'velocity.u=[\"1 + 0*sqrt(x - t + 0.2)\",\"0\"]'";
  EXPECT_EQ(gaussdrift_in(folder, "check" + options).exit_code, 0);
  EXPECT_EQ(gaussdrift_in(folder, "run" + options).exit_code, 0);
}

TEST(Check, RefusesAFieldThatIsNotFinite) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  EXPECT_EQ(gaussdrift_in(folder, "check small.toml --set 'velocity.u=[\"log(-1 - x*x)\", \"0\"]'").exit_code, 4);
}

TEST(Study, LeavesATableAndChartsAndAPage) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const Outcome out = gaussdrift_in(folder, "study small.toml --vary time.step=0.2,0.1 --repeats 1 --out st");
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_NE(out.out.find("=> "), std::string::npos) << out.out;
  for (const char* file : {"st/study.csv", "st/study.json", "st/study.md"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  EXPECT_EQ(gaussdrift_in(folder, "study small.toml --vary time.step=0.2 --repeats 1 --out st").exit_code, 6);
  EXPECT_EQ(gaussdrift_in(folder, "study small.toml --vary time.step=0.2 --repeats 1 --out st --force --csv all.csv")
                .exit_code,
            0);
  EXPECT_TRUE(fs::exists(folder / "all.csv"));
  // What is left of an interrupted study is not replaced either; a table that cannot be written loses nothing else.
  fs::remove(folder / "st/study.json");
  EXPECT_EQ(gaussdrift_in(folder, "study small.toml --vary time.step=0.2 --repeats 1 --out st").exit_code, 6);
  EXPECT_EQ(gaussdrift_in(folder, "study small.toml --vary time.step=0.2 --repeats 1 --out kept --csv st").exit_code,
            6);
  for (const char* file : {"kept/study.csv", "kept/study.json", "kept/study.md"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  EXPECT_EQ(gaussdrift_in(folder, "study nowhere.toml --seconds 90.5").exit_code, 6) << "a fraction is no wrong word";
  EXPECT_EQ(gaussdrift_in(folder, "study small.toml --vary time.step").exit_code, 2);
  EXPECT_EQ(gaussdrift_in(folder, "study small.toml --vary time.stop=1,2").exit_code, 3);
}

TEST(Study, OfTwoProcessesIntoOneFolderIsThatOfOneOfThem) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const std::string study = "'" PROGRAM "' study small.toml --repeats 1 --threads 1 --out st --vary time.step=";
  const Outcome both = outcome_of(
      folder, study + "0.2 >one.txt 2>&1 & " + study + "0.1 >two.txt 2>&1; echo second $?; wait $!; echo first $?");
  const bool second = both.out.find("second 0") != std::string::npos;
  EXPECT_NE(second, both.out.find("first 0") != std::string::npos) << both.out;
  EXPECT_NE(both.out.find(second ? "first 6" : "second 6"), std::string::npos) << both.out;
  const std::string refused = read_file(folder / (second ? "one.txt" : "two.txt"));
  EXPECT_TRUE(refused.find("st is in use: process ") != std::string::npos ||
              refused.find("st holds an earlier study") != std::string::npos)
      << refused;
  const std::string table = read_file(folder / "st/study.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2) << table;
}

TEST(Reproduce, ListsWhatItCan) {
  const ScratchFolder folder;
  const Outcome list = gaussdrift_in(folder, "reproduce");
  EXPECT_EQ(list.exit_code, 0);
  for (const char* what : {"cone", "fgtd", "kernels", "rbf", "interpolation"})
    EXPECT_NE(list.out.find(std::string("\n  ") + what + "  "), std::string::npos) << what;
}

TEST(Reproduce, GivesOneTableAsJsonOrText) {
  const ScratchFolder folder;
  const Outcome json = gaussdrift_in(folder, "reproduce fgtd --table 4.6 --json");
  EXPECT_EQ(json.exit_code, 0) << json.err;
  const auto document = parsed_json(json.out);
  ASSERT_EQ(document["tables"].size(), 1u);
  EXPECT_EQ(document["tables"][0]["table"], "4.6");
  EXPECT_EQ(document["tables"][0]["rows"].size(), 9u);
  // What nobody published agrees with nothing: the promise of auto, and the largest sum.
  const auto& numbers = document["tables"][0]["rows"][0]["numbers"];
  EXPECT_EQ(numbers[0]["agrees"], true);
  EXPECT_EQ(numbers[0]["comparison"], "order of magnitude");
  EXPECT_TRUE(numbers[4]["agrees"].is_null());
  EXPECT_TRUE(document["disagreements"].empty());
  const Outcome text = gaussdrift_in(folder, "reproduce fgtd 3.2");
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("112320 112320"), std::string::npos) << text.out;
}

TEST(Reproduce, DrawsTheFigureThatIsNamed) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  const Outcome json = gaussdrift_in(folder, "reproduce figures 5.1 --out pictures --json");
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const auto list = parsed_json(json.out);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["figure"], "5.1a");
  for (const auto& figure : list) EXPECT_GT(fs::file_size(folder / figure["file"].get<std::string>()), 10'000u);
  std::size_t pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder / "pictures")) pictures += entry.path().extension() == ".png";
  EXPECT_EQ(pictures, 2u);
  for (const std::string number : {"2.1", "3.1", "3.2", "3.3", "3.4", "3.5", "4.1"}) {
    const Outcome drawn = gaussdrift_in(folder, "reproduce figures " + number + " --out pictures --json");
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    for (const auto& figure : parsed_json(drawn.out))
      EXPECT_GT(fs::file_size(folder / figure["file"].get<std::string>()), 5'000u) << figure["figure"];
  }
}

TEST(Reproduce, RefusesATableThatThereIsNot) {
  const ScratchFolder folder;
  for (const char* wrong :
       {"reproduce fgtd 4.10", "reproduce claims 3.5", "reproduce cone 4.6", "reproduce cone --full",
        "reproduce figures 9.9", "reproduce cone --out x", "reproduce rbf 1", "reproduce interpolation 1"})
    EXPECT_EQ(gaussdrift_in(folder, wrong).exit_code, 2) << wrong;
}

}  // namespace
}  // namespace gaussdrift
