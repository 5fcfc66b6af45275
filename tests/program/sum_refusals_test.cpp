// gaussdrift sum: every wrong call is refused with its exit code, in the words of who typed it.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "parsed_json.hpp"
#include "program/program.hpp"
#include "program/sum_tables.hpp"

namespace gaussdrift {
namespace {

/// Names of the libraries and of their options mean nothing to the reader of an error.
void expect_users_words(const std::string& text) {
  for (const char* internal : {"fgtd:", "farfield:", "rbf:", "Options", "memory_limit", "::"})
    EXPECT_EQ(text.find(internal), std::string::npos) << text;
}

TEST(Sum, RefusesAWrongCommandLine) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv(headers[2], points(10, 3)));
  write_file(folder / "T.csv", csv(target_headers[2], points(10, 2)));
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"--sigma 2", "--sources"},
      {"--sources S.csv", "--sigma"},
      {"--sources S.csv --sigma 0", "--sigma 0: must be positive"},
      {"--sources S.csv --sigma nan", "--sigma nan: must be positive"},
      {"--sources S.csv --sigma two", "--sigma"},
      {"--sources S.csv --sigma 2 --kernel coulomb", "--sigma belongs to the kernel gauss"},
      {"--sources S.csv --kernel log --derivative 1,0", "gives potential and field"},
      {"--sources S.csv --kernel log --method hermite", "there are auto, direct, tree, symmetric"},
      {"--sources S.csv --kernel vortex", "there are gauss, coulomb, log"},
      {"--sources S.csv --kernel log --tolerance 1", "must lie in (0, 1)"},
      {"--sources S.csv", "--sigma is missing"},
      {"--sources S.csv --sigma 2 --method hermit", "is \"hermite\" meant?"},
      {"--sources S.csv --sigma 2 --tolerance 1", "--tolerance 1: must lie in"},
      {"--sources S.csv --sigma 2 --tolerance -1e-3", "--tolerance -0.001: must lie in"},
      {"--sources S.csv --sigma 2 --threads 0", "--threads"},
      {"--sources S.csv --sigma 2 --derivative 0,1,2",
       "--derivative 0,1,2 has 3 numbers, but the sources have 2 (x, y)"},
      {"--sources S.csv --sigma 2 --derivative 1", "--derivative 1 has 1 number, but"},
      {"--sources S.csv --sigma 2 --derivative=-1,0", "\"-1\" in \"-1,0\" is not an order"},
      {"--sources S.csv --sigma 2 --derivative 1,,0", "\"\" in \"1,,0\" is not an order"},
      {"--sources S.csv --sigma 2 --derivative 1.5,0", "\"1.5\" in \"1.5,0\" is not an order"},
      {"--sources S.csv --sigma 2 --derivative 1,0 --derivative 0,0 --derivative 1,0",
       "--derivative 1,0 is there twice"},
      {"--sources S.csv --sigma 2 --derivative 2000000000,2000000000", "the orders add up to 4e+09, at most 16"},
      {"--sources S.csv --sigma 1e300 --derivative 8,8", "of a Gaussian with --sigma 1e+300"},
      {"--sources S.csv --sigma 2 --seconds 0", "--seconds 0: must be positive"},
      {"--sources S.csv --sigma 2 --r 0.5 --tolerance 1e-3", "--tolerance excludes --r"},
      {"--sources S.csv --sigma 2 --r 0", "--r 0, must be positive"},
      {"--sources S.csv --sigma 2 --p 0", "--p 0, must lie in 1 .. 1000"},
      {"--sources S.csv --sigma 2 --n -1", "--n -1: must be a whole number from 0, or all"},
      {"--sources S.csv --sigma 2 --n two", "--n two: must be a whole number from 0, or all"},
      {"--sources S.csv --sigma 2 --p 9 --method cells", "belong to the method hermite, not to cells"},
      {"--sources S.csv --kernel log --p 9", "belong to the method hermite of the kernel gauss, not to log"},
      {"--sources S.csv --sigma 2 --seconds soon", "--seconds"},
      {"--sources S.csv --sigma 2 --grid=0:1:3", "--grid has 1 axis, but"},
      {"--sources S.csv --sigma 2 --grid=0:1:3,0:1", "\"0:1\" is not an axis"},
      {"--sources S.csv --sigma 2 --grid=0:1:3,0:1:0", "\"0:1:0\" has no positive count"},
      {"--sources S.csv --sigma 2 --grid=0:1:3,0:1:-2", "has no positive count"},
      {"--sources S.csv --sigma 2 --grid=0:1:3,1:0:2", "\"1:0:2\" does not ascend"},
      {"--sources S.csv --sigma 2 --grid=0:1:3,0:1:1", "has one node between two ends"},
      {"--sources S.csv --sigma 2 --grid=0:inf:3,0:1:2", "\"0:inf:3\" is not finite"},
      {"--sources S.csv --sigma 2 --grid=-1e308:1e308:3,0:1:2", "is not finite"},
      {"--sources S.csv --sigma 2 --grid=1:1.0000000000000002:10,0:1:2", "cannot be told apart"},
      {"--sources S.csv --sigma 2 --grid=0:1:2,0:1:2 --targets T.csv", "--grid"},
      {"--sources S.csv --sigma 2 --json", "add --out FILE"},
      {"--sources S.csv --sigma 2 --json --out -", "add --out FILE"},
      {"--sources S.csv --sigma 2 --out S.csv", "would replace a table"},
      {"--sources S.csv --targets T.csv --sigma 2 --out ./T.csv", "would replace a table"},
      {"--sources S.csv --sigma 2 --columns x,,y", "--columns x,,y: a name is missing"},
      {"--sources S.csv --sigma 2 --columns x,x", "\"x\" is there twice"},
      {"--sources S.csv --sigma 2 --columns x,weight", "\"weight\" is no coordinate"},
      {"--sources S.csv --sigma 2 --columns a,b,c,d,e", "names 5 coordinates"},
      {"--sources S.csv --sigma 2 --bandwith 2", "--bandwidth"}};
  for (const auto& [arguments, said] : wrong) {
    const Outcome refused = gaussdrift_in(folder, "sum " + arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments << "\n" << refused.err;
    EXPECT_EQ(refused.err.rfind("error: ", 0), 0u) << refused.err;
    EXPECT_NE(refused.err.find(said), std::string::npos) << arguments << "\n" << refused.err;
    expect_users_words(refused.err);
    EXPECT_EQ(refused.out, "") << arguments;
  }
}

TEST(Sum, RefusesWrongTablesAndWritesNothing) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", "x,y,weight\n0,0,1\n1,1,1\n");
  write_file(folder / "bad.csv", "x,y,weight\n0,0,1\n0,nan,1\n");
  write_file(folder / "plain.csv", "x,y\n0,0\n");
  write_file(folder / "empty.csv", "");
  write_file(folder / "swapped.csv", "y,x\n0,0\n");
  write_file(folder / "line.csv", "x\n0\n");
  write_file(folder / "ragged.csv", "x,y\n0,0\n1\n");
  write_file(folder / "words.csv", "x,y\n0,0\n1,zwei\n");
  write_file(folder / "numbered.csv", "id,x,y,weight\n1,0,0,1\n2,1,0,1\n");
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"--sources bad.csv", "bad.csv:3:3: nan is not finite in column \"y\""},
      {"--sources plain.csv", "plain.csv:1:1: there is no column \"weight\""},
      {"--sources empty.csv", "empty.csv is empty"},
      {"--sources numbered.csv", "numbered.csv:1:1: is the column \"id\" a coordinate? --columns x,y takes the others"},
      {"--sources S.csv --columns x,z", "S.csv:1:1: there is no column \"z\" among x, y, weight"},
      {"--sources S.csv --targets bad.csv", "bad.csv:1:5: targets have coordinates only"},
      {"--sources S.csv --targets ragged.csv", "ragged.csv:3:2: 1 value where 2 columns are named"},
      {"--sources S.csv --targets words.csv", "words.csv:3:3: \"zwei\" is not a number in column \"y\""},
      {"--sources S.csv --targets line.csv", "targets have 1 coordinates (x), sources have 2 (x, y)"},
      {"--sources S.csv --targets swapped.csv", "in the order y, x, those of the sources in the order x, y"},
      {"--sources S.csv --tolerance 1e-15", "--tolerance 1e-15 cannot be promised"},
      {"--sources S.csv --tolerance 1e-3 --derivative 8,8", "cannot be promised for derivatives above order 12"},
      {"--sources S.csv --grid=0:1:100000,0:1:100000", "1e+10 targets with 1 value would take 80 GB"},
      {"--sources S.csv --grid=0:1:18446744073709551615,0:1:18446744073709551615", "would take"}};
  for (const auto& [arguments, said] : wrong) {
    const Outcome refused = gaussdrift_in(folder, "sum --sigma 2 --out V.csv " + arguments);
    EXPECT_EQ(refused.exit_code, 3) << arguments << "\n" << refused.err;
    EXPECT_EQ(refused.err.rfind("error: ", 0), 0u) << refused.err;
    EXPECT_NE(refused.err.find(said), std::string::npos) << arguments << "\n" << refused.err;
    expect_users_words(refused.err);
    EXPECT_EQ(refused.out, "") << arguments;
    EXPECT_FALSE(fs::exists(folder / "V.csv")) << arguments;
    EXPECT_FALSE(fs::exists(folder / "V.csv.part")) << arguments;
  }
}

// Two charges: the kernels by their formulas.
TEST(Sum, RefusesChargesInTheWrongDimension) {
  const ScratchFolder folder;
  write_file(folder / "S1.csv", "x,weight\n0,1\n");
  write_file(folder / "S3.csv", "x,y,z,weight\n0,0,0,2\n");
  for (const char* arguments : {"coulomb --sources S1.csv", "log --sources S3.csv"}) {
    const Outcome refused = gaussdrift_in(folder, std::string("sum --out V.csv --kernel ") + arguments);
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_NE(refused.err.find("dimensions, the sources have"), std::string::npos) << refused.err;
    EXPECT_FALSE(fs::exists(folder / "V.csv"));
  }
}

TEST(Sum, TellsWhatFarfieldRefusesInTheUsersWords) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", "x,y,z,weight\n1,1,1,1\n0,0,0,1\n1e-200,0,0,1\n");
  const Outcome close = gaussdrift_in(folder, "sum --kernel coulomb --sources S.csv");
  EXPECT_EQ(close.exit_code, 4);
  EXPECT_NE(close.err.find("the field at target 2 (counted from 1) exceeds the range"), std::string::npos) << close.err;
  expect_users_words(close.err);
  const Outcome sharp = gaussdrift_in(folder, "sum --kernel coulomb --sources S.csv --method tree --tolerance 1e-15");
  EXPECT_EQ(sharp.exit_code, 3);
  EXPECT_NE(sharp.err.find("--tolerance 1e-15 cannot be promised by tree"), std::string::npos) << sharp.err;
  expect_users_words(sharp.err);
}

// hermite in 4D has boxes with p^4 numbers each: minutes to hours where all pairs take a second.
TEST(Sum, RefusesAMethodThatWouldTakeTooLong) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv(headers[4], points(20000, 5)));
  const Outcome slow = gaussdrift_in(
      folder, "sum --sources S.csv --sigma 100 --tolerance 1e-12 --method hermite --threads 1 --out V.csv");
  EXPECT_EQ(slow.exit_code, 3) << slow.err;
  EXPECT_NE(slow.err.find("hermite would take about "), std::string::npos) << slow.err;
  EXPECT_NE(slow.err.find("only sums of up to 5 minutes are begun. Use --method auto, which takes about "),
            std::string::npos)
      << slow.err;
  EXPECT_FALSE(fs::exists(folder / "V.csv"));
  // Any method of both libraries keeps to --seconds, auto too.
  write_file(folder / "P.csv", csv(headers[3], points(1500, 4)));
  for (const char* method : {"--sigma 30 --method auto", "--sigma 30 --method direct", "--sigma 30 --method hermite",
                             "--sigma 30 --method cells", "--sigma 30 --method chebyshev", "--sigma 30 --method spread",
                             "--kernel coulomb --method auto", "--kernel coulomb --method direct",
                             "--kernel coulomb --method tree", "--kernel coulomb --method symmetric"}) {
    const Outcome refused = gaussdrift_in(folder, std::string("sum --sources P.csv --seconds 1e-9 ") + method);
    EXPECT_EQ(refused.exit_code, 3) << method << refused.err;
    EXPECT_NE(refused.err.find("would take about "), std::string::npos) << method << refused.err;
    EXPECT_EQ(refused.out, "") << method;
  }
}

TEST(Sum, ExitsWith4WhereASumIsNotFinite) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", "x,weight\n0,1e308\n0,1e308\n");
  const Outcome refused = gaussdrift_in(folder, "sum --sources S.csv --sigma 1 --out V.csv");
  EXPECT_EQ(refused.exit_code, 4) << refused.err;
  EXPECT_NE(refused.err.find("d_0 at target 1"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(folder / "V.csv"));
}

TEST(Sum, ExitsWith6WhereFilesFail) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", "x,weight\n0,1\n");
  write_file(folder / "file", "");
  fs::create_directory(folder / "folder");
  for (const char* arguments :
       {"--sources none.csv", "--sources folder", "--sources S.csv --targets none.csv", "--sources S.csv --out folder",
        "--sources S.csv --out file/V.csv", "--sources S.csv --out /dev/full", "--sources S.csv >/dev/full"}) {
    const Outcome refused = gaussdrift_in(folder, std::string("sum --sigma 2 ") + arguments);
    EXPECT_EQ(refused.exit_code, 6) << arguments << "\n" << refused.err;
    EXPECT_EQ(refused.err.rfind("error: ", 0), 0u) << refused.err;
  }
}

}  // namespace
}  // namespace gaussdrift
