// The text of a case with other values, and the case to fill in.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "case_text.hpp"
#include "gaussdrift/read_case.hpp"
#include "input/blank_case.hpp"
#include "input/edit_case.hpp"
#include "input/examples.hpp"
#include "message_of.hpp"

namespace gaussdrift {
namespace {

using input::blank_case;
using input::with_settings;

const std::filesystem::path here = SOURCE_DIR "/cases/edited.toml";

std::string read(const std::string& text, const std::vector<std::string>& settings = {}) {
  return case_text(parse_case(text, here, settings).spec);
}

TEST(EditedCase, IsTheCaseWithOverrides) {
  const std::vector<std::string> settings = {"case.title=two words",  "time.step=0.0125",
                                             "particles.overlap = 3", "output.fields=[\"gradient\"]",
                                             "accuracy.budget=none",  "evaluate.per_axis=33"};
  int edited = 0;
  for (const input::ExampleFile& file : input::example_files()) {
    if (!file.name.ends_with(".toml")) continue;
    const std::string text(file.bytes);
    for (const std::string& setting : settings) {
      std::string expected;
      try {
        expected = read(text, {setting});
      } catch (const CaseError&) {
        continue;  // does not go with this case
      }
      EXPECT_EQ(read(with_settings(text, {setting})), expected) << file.name << " " << setting;
      ++edited;
    }
  }
  EXPECT_GT(edited, 150);
}

TEST(EditedCase, KeepsAllElse) {
  const std::string text =
      "gaussdrift = 1  # first\n[domain]\nmin = [-1, # left\n       -1] # below\nmax = [1, 1]\n"
      "[time]\nend = \"1 # of them\"\n\n[params] # none\n";
  EXPECT_EQ(with_settings(text, {"domain.min=[-2, -2]", "time.end=2", "time.step=0.1", "params.R=1", "check.max=3"}),
            "gaussdrift = 1  # first\n[domain]\nmin = [-2, -2] # below\nmax = [1, 1]\n"
            "[time]\nend = 2\nstep = 0.1\n\n[params] # none\nR = 1\n\n[check]\nmax = 3\n");
  EXPECT_EQ(with_settings("[[velocity]]\nu = [1, 0]\n[[velocity]]\nu = [0, 1]\n", {"velocity[2].u=[0, 2]"}),
            "[[velocity]]\nu = [1, 0]\n[[velocity]]\nu = [0, 2]\n");
  EXPECT_EQ(with_settings("time = {end = 1, step = 0.1}\n", {"time.step=0.2"}), "time = {end = 1, step = 0.2}\n");
  EXPECT_NE(message_of<InputError>([] { with_settings("time = {end = 1}\n", {"time.step=0.2"}); }).find("by hand"),
            std::string::npos);
}

/// A line of the blank case that is switched off: "# overlap = 2".
bool is_off(const std::string& line) { return line.rfind("# ", 0) == 0 && (line[2] == '[' || line.find(" = ") < 30); }

TEST(BlankCase, CanBeReadWithEveryLineThatIsSwitchedOff) {
  for (const int dimensions : {2, 3}) {
    const std::string blank = blank_case(dimensions);
    EXPECT_TRUE(parse_case(blank, here).warnings.empty());
    std::vector<std::string> lines;
    std::istringstream stream(blank);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    int on = 0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (!is_off(lines[k])) continue;
      std::vector<std::string> changed = lines;
      std::size_t last = k;  // a table is switched on with all its keys
      if (lines[k][2] == '[')
        while (last + 1 < lines.size() && is_off(lines[last + 1])) ++last;
      for (std::size_t line = k; line <= last; ++line) changed[line].erase(0, 2);
      std::string text;
      for (const std::string& line : changed) text += line + "\n";
      EXPECT_NO_THROW(parse_case(text, here)) << lines[k];
      k = last;
      ++on;
    }
    EXPECT_GE(on, 11);
  }
}

}  // namespace
}  // namespace gaussdrift
