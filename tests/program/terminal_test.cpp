// A terminal, pipe or disk that takes no text costs the text and nothing else; progress fits the terminal that it is
// on.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <sstream>
#include <thread>

#include "parsed_json.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

/// With a warning after the run, and checks: the last output is so small that its tolerance cannot be promised.
const std::string late_warning = small_case + "[[check]]\nwhat = \"mass\"\nmax = 1\n";
const std::string leaving =
    "run small.toml --set 'velocity.u=[\"1\",\"0\"]' --set time.end=1 --set time.step=0.1 --set 'output.times=[0, 1]' ";

/// Without the page and the budget, which take longer than the run.
const std::string bare_case = small_case + "report = \"none\"\n[accuracy]\nbudget = \"none\"\n";

const std::array<const char*, 7> last_files{"summary.json", "report.html", "report.json",    "log.txt",
                                            "series.csv",   "density.pvd", "provenance.json"};

class EveryVerb : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    const std::string verb = GetParam();
    if (!draws_pictures && (verb.starts_with("render") || verb.starts_with("doctor"))) GTEST_SKIP() << without_pictures;
    write_file(folder_ / "small.toml", bare_case);
    write_file(folder_ / "s.csv", "x,weight\n0,1\n1,2\n");
    ASSERT_EQ(gaussdrift_in(folder_, "run small.toml --out done").exit_code, 0);
  }
  Outcome call(const std::string& redirection) const {
    return gaussdrift_in(folder_, std::string(GetParam()) + redirection);
  }
  ScratchFolder folder_;
};

TEST_P(EveryVerb, EndsAsEverWhereStandardErrorTakesNothing) { EXPECT_EQ(call(" 2>/dev/full").exit_code, 0); }

TEST_P(EveryVerb, SaysThatStandardOutputIsLostAndEndsWith6) {
  const Outcome out = call(" >/dev/full");
  EXPECT_EQ(out.exit_code, 6);
  EXPECT_NE(out.err.find("standard output"), std::string::npos) << out.err;
  EXPECT_EQ(call(" <&- >&- 2>&-").exit_code, 6);
}

TEST_P(EveryVerb, SaysNothingWhereTheReaderOfAPipeIsGone) {
  // A pipe without a reader: the subshell holds its writing end alone.
  const Outcome out = gaussdrift_in(folder_, "--version; mkfifo gone; exec 3<>gone 4>gone 3<&-; '" PROGRAM "' " +
                                                 std::string(GetParam()) + " >&4; code=$?; rm gone; exit $code");
  EXPECT_EQ(out.exit_code, 6) << out.err;
  EXPECT_EQ(out.err.find("error"), std::string::npos) << out.err;
}

INSTANTIATE_TEST_SUITE_P(Terminal, EveryVerb,
                         testing::Values("new", "new rotating_cone --force", "explain", "--help", "check small.toml",
                                         "run small.toml --out a --force", "report done", "render done --times 0",
                                         "compare done done", "doctor",
                                         "study small.toml --vary time.step=0.2 --repeats 1 --out s --force",
                                         "sum --sources s.csv --sigma 1", "reproduce"),
                         [](const auto& verb) { return "Verb" + std::to_string(verb.index); });

TEST(Terminal, TakesNoErrorMessageAndTheCodeIsThatOfTheError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const ScratchFolder folder;
  write_file(folder / "bad.toml", "gaussdrift = 1\n[velocity]\nu = 3\n");
  for (const char* stream : {" 2>/dev/full", " 2>&-", " >&- 2>&-"}) {
    EXPECT_EQ(gaussdrift_in(folder, std::string("check missing.toml") + stream).exit_code, 6) << stream;
    EXPECT_EQ(gaussdrift_in(folder, std::string("check bad.toml") + stream).exit_code, 3) << stream;
    EXPECT_EQ(gaussdrift_in(folder, std::string("chekc bad.toml") + stream).exit_code, 2) << stream;
  }
}

TEST(Terminal, ThatTakesNothingCostsNoFileOfARun) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const ScratchFolder folder;
  write_file(folder / "small.toml", late_warning);
  const Outcome heard = gaussdrift_in(folder, leaving + "--out heard");
  ASSERT_EQ(heard.exit_code, 0) << heard.err;
  ASSERT_NE(heard.err.find("cannot be promised"), std::string::npos) << heard.err;
  const auto series = parsed_json(read_file(folder / "heard/summary.json")).at("frames");
  int number = 0;
  for (const auto& [streams, code] :
       {std::pair{" 2>/dev/full", 0}, {" 2>&-", 0}, {" >/dev/full 2>/dev/full", 6}, {" <&- >&- 2>&-", 6}}) {
    const std::string name = "run" + std::to_string(++number);
    EXPECT_EQ(gaussdrift_in(folder, leaving + "--out " + name + streams).exit_code, code) << streams;
    for (const char* file : last_files) EXPECT_TRUE(fs::exists(folder / name / file)) << streams << ": " << file;
    const auto summary = parsed_json(read_file(folder / name / "summary.json"));
    EXPECT_EQ(summary.at("checks").size(), 1u);
    EXPECT_EQ(summary.at("frames").size(), series.size());
    EXPECT_NE(read_file(folder / name / "log.txt").find("cannot be promised"), std::string::npos) << streams;
    // No file of the run got the number of a closed stream, and with it the text.
    EXPECT_EQ(read_file(folder / name / "density/density_0001.vti"),
              read_file(folder / "heard/density/density_0001.vti"));
    EXPECT_EQ(read_file(folder / name / "case.toml"), late_warning);
  }
}

TEST(Terminal, ThatTakesNothingDoesNotHideAFailedCheck) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case + "[[check]]\nwhat = \"mass\"\nmax = 1e-9\n");
  EXPECT_EQ(gaussdrift_in(folder, "run small.toml --out a >/dev/full 2>/dev/full").exit_code, 5);
  EXPECT_NE(read_file(folder / "a/log.txt").find("FAILED"), std::string::npos);
}

/// A terminal of so many columns (0: not known) that keeps what is written to it.
class PseudoTerminal {
 public:
  explicit PseudoTerminal(unsigned short columns) : master_(posix_openpt(O_RDWR | O_NOCTTY)) {
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) return;
    name_ = ptsname(master_);
    slave_ = open(name_.c_str(), O_RDWR | O_NOCTTY);
    winsize size{};
    size.ws_col = columns, size.ws_row = columns ? 24 : 0;
    ioctl(slave_, TIOCSWINSZ, &size);
    reader_ = std::thread([this] {
      std::array<char, 4096> piece;
      for (ssize_t taken; (taken = read(master_, piece.data(), piece.size())) > 0;) {
        const std::lock_guard lock(mutex_);
        text_.append(piece.data(), static_cast<std::size_t>(taken));
        more_.notify_all();
      }
    });
  }
  ~PseudoTerminal() {
    text();
    if (master_ >= 0) close(master_);
  }
  const std::string& name() const { return name_; }
  /// Waits until it has shown these words. False if that takes a minute.
  bool shows(const std::string& words) {
    std::unique_lock lock(mutex_);
    return more_.wait_for(lock, std::chrono::minutes(1), [&] { return text_.find(words) != std::string::npos; });
  }
  /// All of it, once the last writer has gone.
  const std::string& text() {
    if (reader_.joinable()) {
      close(slave_);
      reader_.join();
    }
    return text_;
  }

 private:
  int master_, slave_ = -1;
  std::string name_, text_;
  std::mutex mutex_;
  std::condition_variable more_;
  std::thread reader_;
};

std::string said_on(unsigned short columns, const std::string& environment) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", bare_case);
  PseudoTerminal terminal(columns);
  if (terminal.name().empty()) return "no pseudo terminal";
  const Outcome run = gaussdrift_in(folder, "run small.toml 2>" + terminal.name(),
                                    "unset COLUMNS NO_COLOR; export TERM=xterm;" + environment);
  EXPECT_EQ(run.exit_code, 0);
  return terminal.text();
}

TEST(Progress, IsOneLineThatIsTakenBackOnATerminal) {
  const std::string text = said_on(120, "");
  if (text == "no pseudo terminal") GTEST_SKIP() << text;
  EXPECT_EQ(text.rfind("\r\033[K", 0), 0u) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  EXPECT_EQ(text.substr(text.size() - 4), "\r\033[K") << text;
}

TEST(Progress, IsCutToTheWidthOfTheTerminal) {
  for (const auto& [columns, environment] : {std::pair{50, ""}, {120, "export COLUMNS=50;"}}) {
    const std::string text = said_on(static_cast<unsigned short>(columns), environment);
    if (text == "no pseudo terminal") GTEST_SKIP() << text;
    const std::string first = text.substr(4, text.find('\r', 4) - 4);
    EXPECT_EQ(first.size(), 49u) << first;
  }
}

TEST(Progress, IsPlainWhereALineCannotBeTakenBack) {
  for (const auto& [columns, environment] : {std::pair{120, "export TERM=dumb;"},
                                             {120, "unset TERM;"},
                                             {120, "export NO_COLOR=1;"},
                                             {20, ""},
                                             {0, ""},
                                             {120, "export COLUMNS=20;"},
                                             {120, "export COLUMNS=0;"}}) {
    const std::string text = said_on(static_cast<unsigned short>(columns), environment);
    EXPECT_EQ(text.find('\033'), std::string::npos) << columns << environment << text;
    EXPECT_EQ(text.find('\r'), std::string::npos) << columns << environment << text;
  }
  const std::string empty = said_on(120, "export NO_COLOR=;");  // set to nothing, it asks for nothing
  EXPECT_TRUE(empty == "no pseudo terminal" || empty.find('\033') != std::string::npos) << empty;
}

// The program waits for its table until the line is there.
TEST(Progress, OfASumTellsWhatItIsAt) {
  const ScratchFolder folder;
  PseudoTerminal terminal(120);
  if (terminal.name().empty()) GTEST_SKIP() << "no pseudo terminal";
  ASSERT_EQ(mkfifo((folder / "S.csv").c_str(), 0600), 0);
  const int writer = open((folder / "S.csv").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(writer, 0);
  Outcome sum;
  std::thread program([&] {
    sum = gaussdrift_in(folder, "sum --sources S.csv --sigma 1 2>" + terminal.name(),
                        "unset COLUMNS NO_COLOR; export TERM=xterm;");
  });
  EXPECT_TRUE(terminal.shows("\r\033[Kreading S.csv  "));
  const std::string table = "x,weight\n0,1\n";
  EXPECT_EQ(write(writer, table.data(), table.size()), static_cast<ssize_t>(table.size()));
  close(writer);
  program.join();
  EXPECT_EQ(sum.out, "d_0\n1\n");
  const std::string& text = terminal.text();
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  EXPECT_EQ(text.substr(text.size() - 4), "\r\033[K") << text;
}

TEST(Explain, BreaksLinesAtTheWidthOfTheTerminalAlone) {
  const ScratchFolder folder;
  const auto longest = [](const std::string& text) {
    std::istringstream in(text);
    std::size_t length = 0;
    for (std::string line; std::getline(in, line);) length = std::max(length, line.size());
    return length;
  };
  PseudoTerminal terminal(60);
  if (terminal.name().empty()) GTEST_SKIP() << "no pseudo terminal";
  EXPECT_EQ(gaussdrift_in(folder, "explain >" + terminal.name(), "unset COLUMNS;").exit_code, 0);
  EXPECT_LE(longest(terminal.text()), 61u) << "60, and the carriage return that a terminal adds";
  EXPECT_GT(longest(gaussdrift_in(folder, "explain", "export COLUMNS=60;").out), 100u) << "for grep, in a pipe";
}

}  // namespace
}  // namespace gaussdrift
