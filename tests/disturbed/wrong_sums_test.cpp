// A program whose sums are wrong says so: the warning, exit code 4, and what is written all the same. PROGRAM is built
// from the sources of gaussdrift, and disturbed by wrong_sums.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "program/program.hpp"

namespace gaussdrift {
namespace {

/// 12 x 12 points of the unit square, of weight 1.
std::string table() {
  std::string text = "x,y,weight\n";
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) text += std::to_string(i / 11.) + "," + std::to_string(j / 11.) + ",1\n";
  return text;
}

std::size_t lines_of(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(WrongSum, OfGaussiansIsExitCode4WithAWarning) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", table());
  const Outcome wrong =
      gaussdrift_in(folder, "sum --sources S.csv --sigma 20 --tolerance 1e-3 --method hermite --out values.csv");
  EXPECT_EQ(wrong.exit_code, 4) << wrong.err;
  EXPECT_EQ(wrong.err.find("warning: d_0_0 is wrong by 0."), 0u) << wrong.err;
  EXPECT_NE(wrong.err.find(" where 0.001 is promised. This was found at 144 targets by summing all pairs. Do not use "
                           "these values. Use --method direct, which sums all pairs everywhere.\n"),
            std::string::npos)
      << wrong.err;
  EXPECT_EQ(lines_of(read_file(folder / "values.csv")), 145u) << "what was computed is there to be looked at";
  EXPECT_NE(wrong.out.find("method hermite"), std::string::npos) << wrong.out;

  const Outcome json =
      gaussdrift_in(folder, "sum --sources S.csv --sigma 20 --tolerance 1e-3 --method hermite --json --out values.csv");
  EXPECT_EQ(json.exit_code, 4);
  EXPECT_NE(json.out.find("\"kept\": false"), std::string::npos) << json.out;
}

TEST(WrongSum, OfPairsIsExitCode4WithAWarning) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", table());
  const Outcome wrong = gaussdrift_in(
      folder, "sum --kernel coulomb --sources S.csv --tolerance 1e-3 --method symmetric --out values.csv");
  EXPECT_EQ(wrong.exit_code, 4) << wrong.err;
  EXPECT_EQ(wrong.err.find("warning: the field is wrong by "), 0u) << wrong.err;
  EXPECT_EQ(wrong.err.find("the potential"), std::string::npos) << "which is right: " << wrong.err;
}

TEST(WrongSum, IsNoneWhereAllPairsAreSummed) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", table());
  for (const std::string kernel : {"--sigma 20", "--kernel coulomb"}) {
    const Outcome right = gaussdrift_in(folder, "sum --sources S.csv --method direct --out values.csv " + kernel);
    EXPECT_EQ(right.exit_code, 0) << right.err;
    EXPECT_EQ(right.err, "");
  }
}

}  // namespace
}  // namespace gaussdrift
