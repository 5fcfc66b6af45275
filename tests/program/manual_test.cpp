// gaussdrift manual: the page for man(1), and completions that shells understand.
#include <gtest/gtest.h>

#include <string>

#include "program/program.hpp"

namespace gaussdrift {
namespace {

bool is_there(const ScratchFolder& folder, const std::string& command) {
  return outcome_of(folder, "command -v " + command).exit_code == 0;
}

TEST(Manual, NamesEveryCommandAndOptionThatHelpNames) {
  const ScratchFolder folder;
  const std::string page = gaussdrift_in(folder, "manual").out;
  for (const char* part : {"gaussdrift run", "gaussdrift manual", "\\fB\\-\\-stop\\-after\\fR \\fITIME\\fR",
                           ".SH EXIT STATUS", "Range: 1 to 1024.", "\\fB\\-\\-animation\\fR [\\fIKIND\\fR]"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(gaussdrift_in(folder, "manual --completions tcsh").exit_code, 2);
}

TEST(Manual, IsSetWithoutWarnings) {
  const ScratchFolder folder;
  if (!is_there(folder, "man")) GTEST_SKIP() << "there is no man (Debian: man-db)";
  ASSERT_EQ(gaussdrift_in(folder, "manual > gaussdrift.1").exit_code, 0);
  const Outcome shown = outcome_of(folder, "MANWIDTH=80 LC_ALL=C.UTF-8 man --warnings -l gaussdrift.1");
  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_EQ(shown.err, "");
  EXPECT_NE(shown.out.find("SYNOPSIS"), std::string::npos) << shown.out;
}

/// What bash offers after these words, the last of which may be empty.
std::string bash_offers(const ScratchFolder& folder, const std::string& words) {
  return outcome_of(folder, "bash --norc -c 'set -u; . ./gaussdrift.bash; COMP_WORDS=(gaussdrift " + words +
                                "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); COMPREPLY=(); _gaussdrift; printf \"%s \" "
                                "\"${COMPREPLY[@]}\"'")
      .out;
}

TEST(Completions, OfBashOfferVerbsOptionsAndValues) {
  const ScratchFolder folder;
  if (!is_there(folder, "bash")) GTEST_SKIP() << "there is no bash";
  ASSERT_EQ(gaussdrift_in(folder, "manual --completions bash > gaussdrift.bash").exit_code, 0);
  EXPECT_EQ(outcome_of(folder, "bash -n gaussdrift.bash").err, "");
  write_file(folder / "a b.toml", "");
  write_file(folder / "table.csv", "");
  fs::create_directory(folder / "scenes");
  EXPECT_EQ(bash_offers(folder, "re"), "resume report render reproduce ");
  EXPECT_EQ(bash_offers(folder, "run --st"), "--stop-after ");
  EXPECT_EQ(bash_offers(folder, "new rotating_c"), "rotating_cone ");
  EXPECT_EQ(bash_offers(folder, "check x.toml --set time.st"), "time.start= time.step= ");
  EXPECT_EQ(bash_offers(folder, "render out --velocity ar"), "arrows ");
  EXPECT_EQ(bash_offers(folder, "run \"\""), "scenes a b.toml ");
  EXPECT_EQ(bash_offers(folder, "run x.toml --out s"), "scenes ");
  EXPECT_EQ(bash_offers(folder, "fit t"), "table.csv ");
}

TEST(Completions, OfZshCanBeRead) {
  const ScratchFolder folder;
  if (!is_there(folder, "zsh")) GTEST_SKIP() << "there is no zsh (Debian: zsh)";
  ASSERT_EQ(gaussdrift_in(folder, "manual --completions zsh > _gaussdrift").exit_code, 0);
  // Loaded as zsh loads it: the first call defines the function. _arguments is asked whether it takes every line.
  const Outcome loaded = outcome_of(folder,
                                    "zsh -f -c 'fpath=($PWD $fpath); autoload -Uz compinit; compinit -D -u; whence -w "
                                    "_gaussdrift; print $_comps[gaussdrift]; zsh -n _gaussdrift'");
  EXPECT_EQ(loaded.err, "");
  EXPECT_EQ(loaded.out, "_gaussdrift: function\n_gaussdrift\n");
}

TEST(Completions, OfFishOfferVerbsOptionsAndValues) {
  const ScratchFolder folder;
  if (!is_there(folder, "fish")) GTEST_SKIP() << "there is no fish (Debian: fish)";
  ASSERT_EQ(gaussdrift_in(folder, "manual --completions fish > gaussdrift.fish").exit_code, 0);
  const auto offers = [&](const std::string& line) {
    return outcome_of(folder,
                      "HOME=. fish --no-config -c 'source gaussdrift.fish; complete -C \"gaussdrift " + line + "\"'")
        .out;
  };
  EXPECT_EQ(offers("chec").rfind("check\tdescribe a case", 0), 0u) << offers("chec");
  EXPECT_EQ(offers("run --stop").rfind("--stop-after\tstop after this time", 0), 0u) << offers("run --stop");
  EXPECT_EQ(offers("new rotating_c"), "rotating_cone\n");
  EXPECT_EQ(offers("render out --velocity ar").rfind("arrows\t", 0), 0u);
}

}  // namespace
}  // namespace gaussdrift
