// The methods of docs/farfield.md are those of the library, in its words.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "farfield/farfield.hpp"

namespace {

TEST(FarfieldMethods, AreDocumentedInTheirOwnWords) {
  std::ifstream page(SOURCE_DIR "/docs/farfield.md");
  std::vector<std::string> rows, expected;
  std::string line;
  while (std::getline(page, line) && line != "## Methods") continue;
  while (std::getline(page, line) && line != "### direct")
    if (line.rfind("| `", 0) == 0) rows.push_back(line);
  for (const farfield::Method method : farfield::methods())
    expected.push_back("| `" + to_string(method) + "` | " + meaning(method) + " |");
  EXPECT_EQ(rows, expected);
}

}  // namespace
