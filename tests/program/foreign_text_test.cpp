// Text of cases, tables and names reaches terminal, page and log printable, and of other files only in part.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "program/program.hpp"

namespace gaussdrift {
namespace {

/// What would steer a terminal, or forge a line where lines are of no use.
void expect_printable(const std::string& text, const std::string& where) {
  for (const char c : text)
    ASSERT_TRUE(static_cast<unsigned char>(c) >= 32 || c == '\n' || c == '\t') << where << ":\n" << text;
  for (const char* unseen : {"\x7f", "\xC2\x9B", "\xE2\x80\xAE"})
    ASSERT_EQ(text.find(unseen), std::string::npos) << where << ":\n" << text;
}

std::string with_title(const std::string& title) {
  std::string text = small_case;
  return text.replace(text.find("[domain]"), 8,
                      "[case]\ntitle = \"" + title + "\"\ncite = \"" + title + "\"\n[domain]");
}

TEST(ForeignText, OfATitleIsPrintableEverywhere) {
  const ScratchFolder folder;
  const std::string steering = "\\u001B[2J\\u0007\\u009B31m\\u202E\\u007F\\nerror: forged";
  write_file(folder / "titled.toml", with_title(steering));
  const std::string shown = "\\x1b[2J\\x07\\u009b31m\\u202e\\u007f error: forged";
  const Outcome check = gaussdrift_in(folder, "check titled.toml");
  ASSERT_EQ(check.exit_code, 0) << check.err;
  expect_printable(check.out + check.err, "check");
  EXPECT_NE(check.out.find("title      " + shown), std::string::npos) << check.out;
  expect_printable(gaussdrift_in(folder, "check titled.toml --json").out, "check --json");

  const Outcome run = gaussdrift_in(folder, "run titled.toml --out r");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  expect_printable(run.out + run.err, "run");
  for (const char* file :
       {"log.txt", "report.html", "report.json", "summary.json", "run.toml", "view.py", "series.csv"})
    expect_printable(read_file(folder / "r" / file), file);
  EXPECT_NE(read_file(folder / "r" / "report.html").find(shown), std::string::npos);
  EXPECT_EQ(gaussdrift_in(folder, "check r/run.toml").exit_code, 0);
}

TEST(ForeignText, OfACaseIsPrintableInEveryRefusal) {
  const ScratchFolder folder;
  const std::string raw = "\x1b[31m\x07\xC2\x9B\xE2\x80\xAE\x7f";
  std::vector<std::string> wrong{raw + " = 1\n", "[domain]\nmin = " + raw + "\n", raw + "\n", "# " + raw + "\n[oops\n"};
  const std::string escaped = "\\u001B[31m\\u0007\\u009B\\u202E\\u007F\\n";
  const std::string text = small_case;
  for (const std::string& one :
       {"[domain]\n\"" + escaped + "\" = 1\n", "[domain]\nmin = \"" + escaped + "\"\n", "[\"" + escaped + "\"]\n",
        "[effects.\"" + escaped + "\"]\n", "[params]\n\"" + escaped + "\" = 1\n",
        "[velocity]\nu = [\"" + escaped + "\", \"0\"]\n", "[velocity]\nfile = \"" + escaped + "\"\n",
        "[velocity]\nfield = \"" + escaped + "\"\n", "[velocity]\ngaussians = \"" + escaped + "\"\n",
        "[time]\nmethod = \"" + escaped + "\"\n", "[output]\nimages = [\"" + escaped + "\"]\n"})
    wrong.push_back("gaussdrift = 1\n[domain]\nmin = [0, 0]\nmax = [1, 1]\n" +
                    (one.rfind("[domain]\n", 0) == 0 ? one.substr(9) : one));
  for (const std::string& one : wrong) {
    write_file(folder / "wrong.toml", one);
    const Outcome refused = gaussdrift_in(folder, "check wrong.toml");
    EXPECT_EQ(refused.exit_code, 3) << one << refused.err;
    expect_printable(refused.out + refused.err, one);
  }
  write_file(folder / "small.toml", small_case);
  const std::string shell = "\"$(printf '\\033[31m\\007\\302\\233')\"";
  for (const std::string& arguments :
       {"check small.toml --set " + shell + "=1", "check small.toml --set time.step=" + shell,
        "check small.toml --set case.title=" + shell, "check " + shell, "render " + shell, "compare a " + shell,
        "explain " + shell, "new " + shell, "run small.toml --out r --" + shell, shell,
        "study small.toml --vary " + shell, "reproduce " + shell, "sum --sources " + shell + " --sigma 1",
        "sum --kernel " + shell + " --sources small.toml"}) {
    const Outcome said = gaussdrift_in(folder, arguments);
    expect_printable(said.out + said.err, arguments);
    EXPECT_NE(said.exit_code, 1) << arguments << said.err;
  }
}

// A case may name any file that the user can read; an error must not hand its lines on.
TEST(ForeignText, OfFilesThatACaseNamesIsQuotedInPart) {
  const ScratchFolder folder;
  const std::string secret = "user:x:0:0:a line that is nobody's business:/home/user:/bin/sh";
  write_file(folder / "secret", secret + "\n" + secret + "\n");
  write_file(folder / "table", "x,y,u,v\n" + secret + ",0,0,0\n");
  for (const char* velocity : {"gaussians = \"secret\"", "gaussians = \"table\"", "file = \"secret\""}) {
    std::string text = small_case;
    const std::size_t at = text.find("[velocity]"), end = text.find("[density]");
    write_file(folder / "names.toml", text.replace(at, end - at, std::string("[velocity]\n") + velocity + "\n"));
    const Outcome refused = gaussdrift_in(folder, "check names.toml");
    EXPECT_EQ(refused.exit_code, 3) << velocity;
    EXPECT_EQ(refused.err.find(secret.substr(0, 28)), std::string::npos) << refused.err;
    EXPECT_EQ(refused.err.find("business"), std::string::npos) << refused.err;
  }
}

TEST(ForeignText, OfLongLinesIsCutAroundThePlace) {
  const ScratchFolder folder;
  const std::string lot(100000, 'x');
  write_file(folder / "long.toml", small_case + std::string("frames = [") + lot + "]\n");
  const Outcome refused = gaussdrift_in(folder, "check long.toml");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_LT(refused.err.size(), 2000u) << refused.err.substr(0, 3000);
  write_file(folder / "key.toml", small_case + std::string("\n[params]\n") + lot + " = \"a\"\n");
  const Outcome key = gaussdrift_in(folder, "check key.toml");
  EXPECT_EQ(key.exit_code, 3);
  EXPECT_LT(key.err.size(), 10000u);
}

}  // namespace
}  // namespace gaussdrift
