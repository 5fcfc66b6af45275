// Tables of points: what is read, and where each wrong one is refused.
#include <gtest/gtest.h>

#include <unistd.h>

#include <clocale>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.hpp"
#include "input/points_table.hpp"

namespace gaussdrift::input {
namespace {

constexpr std::size_t plenty = std::size_t{1} << 30;

PointsTable sources(std::string_view text) { return parse_points_table(text, "S.csv", PointsRole::sources, plenty); }
PointsTable targets(std::string_view text) { return parse_points_table(text, "T.csv", PointsRole::targets, plenty); }

/// The message with which a table is refused; "" if it is not.
std::string refusal(std::string_view text, PointsRole role = PointsRole::sources, std::size_t limit = plenty) {
  try {
    parse_points_table(text, "S.csv", role, limit);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

using Numbers = std::vector<double>;

TEST(PointsTable, ReadsCoordinatesInOrderAndTheWeightFromAnyPlace) {
  const PointsTable table = sources("x,weight,y\n1,10,2\n-3,-0.5,4e-1\n");
  EXPECT_EQ(table.coordinates, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(table.positions, (Numbers{1, 2, -3, 0.4}));
  EXPECT_EQ(table.weights, (Numbers{10, -0.5}));
  EXPECT_EQ(table.size(), 2u);
  EXPECT_EQ(table.dimension(), 2);
}

TEST(PointsTable, ReadsOneToFourCoordinates) {
  EXPECT_EQ(targets("x\n1\n").dimension(), 1);
  EXPECT_EQ(targets("a,b,c,d\n1,2,3,4\n5,6,7,8\n").size(), 2u);
  EXPECT_TRUE(targets("x\n1\n").weights.empty());
}

TEST(PointsTable, ReadsWhatSpreadsheetsWrite) {
  const Numbers expected{1, 2, 3, 4};
  EXPECT_EQ(targets("\xEF\xBB\xBFx,y\r\n1,2\r\n3,4\r\n").positions, expected);  // byte-order mark, CRLF
  EXPECT_EQ(targets("x,y\n1,2\n3,4").positions, expected);                      // no end of the last line
  EXPECT_EQ(targets("x,y\n1,2\n3,4\n\n \t\n\r\n").positions, expected);         // blank lines at the end
  EXPECT_EQ(targets("\"x\",\"y\"\n1,2\n3,4\n").positions, expected);            // quoted names
  EXPECT_EQ(targets(" x ,\ty\n 1 , 2\n3,4 \n").positions, expected);            // blanks around values
  EXPECT_EQ(targets("x,y\n+1,2.\n3.0e0,+.4E+1\n").positions, expected);         // signs, bare points
}

TEST(PointsTable, KeepsEveryBitOfANumber) {
  const PointsTable table = targets("x\n0.1\n1.7976931348623157e308\n5e-324\n-0\n2.2250738585072011e-308\n");
  EXPECT_EQ(table.positions, (Numbers{0.1, std::numeric_limits<double>::max(), 5e-324, -0.0, 2.2250738585072011e-308}));
  EXPECT_TRUE(std::signbit(table.positions[3]));
}

TEST(PointsTable, DoesNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) {
    if (!std::setlocale(LC_ALL, name)) continue;  // the machine may not have it
    EXPECT_EQ(targets("x\n1.5\n").positions, (Numbers{1.5})) << name;
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST(PointsTable, NamesFileLineAndColumnOfABadValue) {
  EXPECT_EQ(refusal("x,y,weight\n0,0,1\n1,zwei,1\n"), "S.csv:3:3: \"zwei\" is not a number in column \"y\"");
  EXPECT_EQ(refusal("x,y,weight\n0,0,1\n1, 2 m,1\n"), "S.csv:3:4: \"2 m\" is not a number in column \"y\"");
  EXPECT_EQ(refusal("x,y,weight\n0,,1\n"), "S.csv:2:3: there is no value in column \"y\"");
  EXPECT_EQ(refusal("x,weight\n0,\n"), "S.csv:2:3: there is no value in column \"weight\"");
  EXPECT_EQ(refusal("x,weight\n0,nan\n"), "S.csv:2:3: nan is not finite in column \"weight\"");
  EXPECT_EQ(refusal("x,weight\n-inf,1\n"), "S.csv:2:1: -inf is not finite in column \"x\"");
  EXPECT_EQ(refusal("x,weight\r\n1,1\r\n1e400,1\r\n"),
            "S.csv:3:1: \"1e400\" is outside the range of double precision in column \"x\"");
  for (const char* wrong : {"1e", "1d5", "0x10", "1_000", "--1", "+-1", "+", "-", ".", "1 2", "1;2", "\"1\"", "1.2.3"})
    EXPECT_NE(refusal(std::string("x,weight\n0,1\n") + wrong + ",1\n").find("S.csv:3:1: "), std::string::npos) << wrong;
}

TEST(PointsTable, NamesTheLineThatIsRagged) {
  EXPECT_EQ(refusal("x,y,weight\n0,0,1\n1,2\n"), "S.csv:3:4: 2 values where the header names 3 columns (x, y, weight)");
  EXPECT_EQ(refusal("x,weight\n0,1,2\n"), "S.csv:2:4: 3 values where the header names 2 columns (x, weight)");
  EXPECT_EQ(refusal("x,weight\n0,1,\n"), "S.csv:2:4: 3 values where the header names 2 columns (x, weight)");
  EXPECT_EQ(refusal("x,weight\n0,1\n\n2,1\n"), "S.csv:3:1: the line is blank, and points follow; remove it");
}

TEST(PointsTable, RefusesTablesWithoutPoints) {
  EXPECT_EQ(refusal(""), "S.csv is empty; it must have a header line and a line for every point");
  EXPECT_EQ(refusal("\xEF\xBB\xBF\r\n\r\n"), "S.csv is empty; it must have a header line and a line for every point");
  EXPECT_EQ(refusal("x,weight\n\n"), "S.csv:2: no points follow the header line");
}

TEST(PointsTable, RefusesHeadersThatItCannotTrust) {
  EXPECT_EQ(refusal("1,2,3\n4,5,6\n"), "S.csv:1:1: \"1\" is a number; the first line must name the columns");
  EXPECT_EQ(refusal("x,,weight\n1,2,3\n"), "S.csv:1:3: column 2 has no name");
  EXPECT_EQ(refusal("x,x,weight\n1,2,3\n"), "S.csv:1:3: column \"x\" is there twice");
  EXPECT_EQ(refusal("x;y;weight\n1;2;3\n"),
            "S.csv:1:1: \"x;y;weight\" is not the name of a column; columns are separated by commas");
  EXPECT_EQ(refusal("x,y\n1,2\n"),
            "S.csv:1:1: there is no column \"weight\" among x, y; add one, with 1 in every line if all sources count "
            "the same");
  EXPECT_EQ(refusal("x,weigth\n1,2\n"),
            "S.csv:1:1: there is no column \"weight\" among x, weigth; is \"weigth\" meant?");
  EXPECT_EQ(refusal("weight\n1\n"), "S.csv:1:1: there are no coordinates; sources have 1 to 4");
  EXPECT_EQ(refusal("a,b,c,d,e,weight\n1,2,3,4,5,6\n"),
            "S.csv:1:9: \"e\" would be coordinate 5; sources have 1 to 4 and a column \"weight\", nothing else");
  EXPECT_EQ(refusal("x,weight\n1,2\n", PointsRole::targets),
            "S.csv:1:3: targets have coordinates only; remove the column \"weight\"");
  EXPECT_EQ(refusal(std::string_view("\xFF\xFEx\0", 4)), "S.csv:1:1: the file is UTF-16; save it as UTF-8");
  EXPECT_NE(refusal(std::string_view("x\0,weight\n1,2\n", 13)).find("must be plain text"), std::string::npos);
}

TEST(PointsTable, RefusesSizesBeforeItAllocates) {
  std::string text = "x,y,z,weight\n";
  for (int i = 0; i < 1000; ++i) text += "1,2,3,4\n";
  EXPECT_EQ(refusal(text, PointsRole::sources, text.size() + 1001 * 32), "");  // the text and four doubles a line
  EXPECT_NE(refusal(text, PointsRole::sources, text.size()).find("would take"), std::string::npos);
}

TEST(PointsTable, ReadsAndRefusesFiles) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("gaussdrift-points-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const fs::path file = folder / "S.csv";
  std::string text = "x,weight\n";
  for (int i = 0; i < 300000; ++i) text += std::to_string(i) + ",1\n";  // more than one block of the reader
  std::ofstream(file, std::ios::binary) << text;
  const PointsTable table = read_points_table(file, PointsRole::sources, plenty);
  EXPECT_EQ(table.size(), 300000u);
  EXPECT_EQ(table.positions.back(), 299999);
  EXPECT_THROW(read_points_table(file, PointsRole::sources, 1000), InputError);
  EXPECT_THROW(read_points_table(folder / "none.csv", PointsRole::sources, plenty), FileError);
  EXPECT_THROW(read_points_table(folder, PointsRole::sources, plenty), FileError);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace gaussdrift::input
