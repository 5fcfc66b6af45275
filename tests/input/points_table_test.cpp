// Tables of points: what is read, and where each wrong one is refused.
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <filesystem>
#include <limits>

#include "gaussdrift/error.hpp"
#include "input/points_table.hpp"
#include "message_of.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::input {
namespace {

constexpr std::size_t enough_bytes = std::size_t{1} << 30;

PointsTable sources_in(std::string_view text) {
  return parse_points_table(text, "S.csv", PointsRole::sources, enough_bytes);
}
PointsTable targets(std::string_view text) {
  return parse_points_table(text, "T.csv", PointsRole::targets, enough_bytes);
}

/// The message with which a table is refused; "" if it is not.
std::string refusal_of_table(std::string_view text, PointsRole role = PointsRole::sources,
                             std::size_t limit = enough_bytes) {
  try {
    parse_points_table(text, "S.csv", role, limit);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

using Numbers = std::vector<double>;

TEST(PointsTable, ReadsCoordinatesInOrderAndTheWeightFromAnyPlace) {
  const PointsTable table = sources_in("x,weight,y\n1,10,2\n-3,-0.5,4e-1\n");
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

TEST(PointsTable, LeavesCommentsOutAnywhere) {
  const PointsTable table =
      sources_in("# made by a tool\n\n#\nx,y,weight\n# first, second\n0,0,1\n  # indented\n1,2,3\n#end");
  EXPECT_EQ(table.coordinates, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(table.positions, (Numbers{0, 0, 1, 2}));
  EXPECT_EQ(table.weights, (Numbers{1, 3}));
  // Places are those of the file, comments counted.
  EXPECT_EQ(refusal_of_table("# one\nx,weight\n# two\n1,1\n# three\n2,a\n"),
            "S.csv:6:3: \"a\" is not a number in column \"weight\"");
  EXPECT_EQ(refusal_of_table("# one\nx,wait\n"),
            "S.csv:2:1: there is no column \"weight\" among x, wait; --weight names another one; or add one, with 1 in "
            "every line if all sources count the same");
  // As numpy.savetxt writes its header.
  EXPECT_EQ(refusal_of_table("# x,weight\n0,1\n"),
            "S.csv:2:1: \"0\" is a number, and the names of the columns seem to stand in the comment above; remove the "
            "# of line 1");
  EXPECT_EQ(refusal_of_table("# only words\n"),
            "S.csv is empty; it must have a line of names and a line for every point");
}

TEST(PointsTable, ReadsExponentsAsFortranWritesThem) {
  EXPECT_EQ(targets("x,y\n1.5D+00,2d0\n-0.25D-2,+1.D3\n\"1D1\", .5d+1\n").positions,
            (Numbers{1.5, 2, -0.0025, 1000, 10, 5}));
  EXPECT_EQ(targets("x\n0.10000000000000000000000000000000000000000000000000D1\n").positions, (Numbers{1}));
  EXPECT_EQ(refusal_of_table("x,weight\n1.5-103,1\n"),
            "S.csv:2:1: \"1.5-103\" is not a number in column \"x\"; the e of its exponent is missing, as Fortran "
            "leaves it out");
  EXPECT_EQ(
      refusal_of_table("x,weight\n********,1\n"),
      "S.csv:2:1: \"********\" is not a number in column \"x\"; Fortran writes stars where a number does not fit");
  EXPECT_EQ(refusal_of_table("x,weight\n1D999,1\n").substr(0, 22), "S.csv:2:1: \"1D999\" is ");
  for (const char* wrong : {"1d", "d5", "1d5d", "1d5-", "1d-+5", "nand1", "\"1d", "\"1d2", "1e5d2", "1d+", "0x1d2",
                            "1 d5", "1.5d0.5", "inf", "1e400", "1e-400"})
    EXPECT_NE(refusal_of_table(std::string("x,weight\n") + wrong + ",1\n").find("S.csv:2:1: "), std::string::npos)
        << wrong;
}

TEST(PointsTable, FindsTheSeparatorInTheLineOfNames) {
  for (const char* text :
       {"x,y,weight\n1,-2,3\n4,5,6\n", "x;y;weight\n1;-2;3\n4 ; 5; 6 \n", "x\ty\tweight\n1\t-2\t3\n4\t 5\t6\n",
        "x y weight\n1 -2 3\n  4\t5  6  \n", " x  y   weight \n1\t-2 3\n4 5 6\n",
        "\"x\";\"y\";weight\n1;\"-2\";3\n\"4\";\"5\";\"6\"\n"}) {
    const PointsTable table = sources_in(text);
    EXPECT_EQ(table.coordinates, (std::vector<std::string>{"x", "y"})) << text;
    EXPECT_EQ(table.positions, (Numbers{1, -2, 4, 5})) << text;
    EXPECT_EQ(table.weights, (Numbers{3, 6})) << text;
  }
  EXPECT_EQ(refusal_of_table("x,y,weight\n0 0 1\n"),
            "S.csv:2:6: 1 value where 3 columns are named (x, y, weight); separate them by commas, not by blanks");
  EXPECT_EQ(refusal_of_table("x;y;weight\n0,0,1\n"),
            "S.csv:2:6: 1 value where 3 columns are named (x, y, weight); separate them by semicolons, not by commas");
  EXPECT_EQ(refusal_of_table("x y weight\n0 0\n"), "S.csv:2:4: 2 values where 3 columns are named (x, y, weight)");
  EXPECT_EQ(refusal_of_table("x\ty\tweight\n0\t\t1\n"), "S.csv:2:3: there is no value in column \"y\"");
  EXPECT_EQ(refusal_of_table("x,weight\n1,5,2,0\n"),
            "S.csv:2:4: 4 values where 2 columns are named (x, weight); the decimal sign is a point, not a comma");
  EXPECT_EQ(refusal_of_table("x;weight\n1,5;2\n"),
            "S.csv:2:1: \"1,5\" is not a number in column \"x\"; the decimal sign is a point, not a comma");
  EXPECT_NE(refusal_of_table("x,weight\r0,1\r").find("lines end with a carriage return alone"), std::string::npos);
}

TEST(PointsTable, ReadsCellsInQuotationMarks) {
  EXPECT_EQ(targets("x,y\n\"1\",\"2\"\n\" 3 \" , \"+4e0\"\n").positions, (Numbers{1, 2, 3, 4}));
  // Names with separators and quotation marks in them, and labels that are not looked at.
  const std::string text =
      "\"label, or \"\"name\"\"\",\"x, east\",\"y \"\"north\"\"\",weight\n\"a, b\",1,2,3\n\"say \"\"c\"\"\",4,5,6\n5\" "
      "pipe,7,8,9\n";
  const PointsTable table =
      parse_points_table(text, "S.csv", PointsRole::sources, enough_bytes, {{"x, east", "y \"north\""}, "", false});
  EXPECT_EQ(table.coordinates, (std::vector<std::string>{"x, east", "y \"north\""}));
  EXPECT_EQ(table.positions, (Numbers{1, 2, 4, 5, 7, 8}));
  EXPECT_EQ(table.weights, (Numbers{3, 6, 9}));
  const PointsTable german = parse_points_table("\"x, km\";y;mass\n0;1;2\n", "S.csv", PointsRole::sources, enough_bytes,
                                                {{"x, km", "y"}, "mass", false});
  EXPECT_EQ(german.positions, (Numbers{0, 1}));
  EXPECT_EQ(refusal_of_table("x,weight\n\"1\n\",2\n"), "S.csv:2:3: 1 value where 2 columns are named (x, weight)");
  EXPECT_EQ(refusal_of_table("x,weight\n\"one\",2\n"), "S.csv:2:1: \"one\" is not a number in column \"x\"");
  EXPECT_EQ(refusal_of_table("x,weight\n\"\",2\n"), "S.csv:2:1: there is no value in column \"x\"");
}

TEST(PointsTable, TakesColumnsByNumberAndAnyColumnAsWeight) {
  const auto read = [](std::string_view text, const PointsColumns& columns, PointsRole role = PointsRole::sources) {
    return parse_points_table(text, "S.csv", role, enough_bytes, columns);
  };
  const std::string named = "id,x,y,mass\n7,1,2,3\n8,4,5,6\n", bare = "7 1 2 3\n8 4 5 6\n";
  for (const std::string& text : {named, bare}) {
    const PointsTable table = read(text, {{"2", "3"}, "4", false});
    EXPECT_EQ(table.positions, (Numbers{1, 2, 4, 5}));
    EXPECT_EQ(table.weights, (Numbers{3, 6}));
    EXPECT_EQ(read(text, {{"3"}, "", false}, PointsRole::targets).positions, (Numbers{2, 5}));
  }
  EXPECT_EQ(read(named, {{"y", "x"}, "mass", false}).positions, (Numbers{2, 1, 5, 4}));
  EXPECT_EQ(read(named, {{"y", "2"}, "mass", false}).coordinates, (std::vector<std::string>{"y", "x"}));
  EXPECT_EQ(read(bare, {{}, "4", false}).positions, (Numbers{7, 1, 2, 8, 4, 5}));
  EXPECT_EQ(read("x,y\n1,2\n3,4\n", {{}, "", true}).weights, (Numbers{1, 1}));
  const auto refused = [&](std::string_view text, const PointsColumns& columns) {
    return message_of<InputError>([&] { read(text, columns); });
  };
  EXPECT_EQ(refused(named, {{"2", "5"}, "4", false}),
            "S.csv:1:1: there is no column 5; 4 columns are there, counted from 1");
  EXPECT_EQ(refused(named, {{"0"}, "4", false}),
            "S.csv:1:1: there is no column 0; 4 columns are there, counted from 1");
  EXPECT_EQ(refused(named, {{"2", "x"}, "4", false}), "S.csv:1:4: the column \"x\" is named twice as a coordinate");
  EXPECT_EQ(refused(named, {{"2"}, "x", false}), "S.csv:1:4: the column \"x\" is not a coordinate of sources");
  EXPECT_EQ(refused(named, {{"x"}, "mas", false}),
            "S.csv:1:1: there is no column \"mas\" among id, x, y, mass; is \"mass\" meant?");
  EXPECT_EQ(
      refused("x,weight,mass\n1,2,3\n", {{}, "mass", false}),
      "S.csv:1:3: is the column \"weight\" a coordinate? --columns x takes the others, --columns x,weight takes all");
  EXPECT_NE(
      refused("0,1,2\n5,6,7\n", {{"1", "2"}, "3", false}).find("S.csv:1:1: \"0,1,2\" counts the columns, as pandas"),
      std::string::npos);
  EXPECT_NE(
      refused(bare, {{"x"}, "4", false}).find("S.csv:1:1: \"7\" is a number; the first line must name the columns"),
      std::string::npos);
}

TEST(PointsTable, LeavesOutCommentsAtTheEndOfALine) {
  EXPECT_EQ(targets("x,y\n1,2 # first, of two\n3,4\t#\n").positions, (Numbers{1, 2, 3, 4}));
  EXPECT_EQ(
      parse_points_table("name,x\nno #3,1\n", "T.csv", PointsRole::targets, enough_bytes, {{"x"}, "", false}).positions,
      (Numbers{1}));
  EXPECT_EQ(
      refusal_of_table("x,weight\n1,2#3\n"),
      "S.csv:2:3: \"2#3\" is not a number in column \"weight\"; a comment has a line of its own, or a blank before "
      "its #");
}

TEST(PointsTable, AsksAboutColumnsWhoseNamesAreNoCoordinates) {
  EXPECT_EQ(refusal_of_table("id,x,y,weight\n1,0,0,1\n2,1,0,1\n"),
            "S.csv:1:1: is the column \"id\" a coordinate? --columns x,y takes the others, --columns id,x,y takes all");
  EXPECT_EQ(refusal_of_table("x,y,Time,weight\n1,0,0,1\n").substr(0, 42),
            "S.csv:1:5: is the column \"Time\" a coordina");
  EXPECT_EQ(refusal_of_table("t,weight\n0,1\n"), "S.csv:1:1: is the column \"t\" a coordinate? Say so by --columns t");
  for (const char* name : {"index", "idx", "no", "row", "step", "timestamp", "mass", "u", "Unnamed: 0"})
    for (const PointsRole role : {PointsRole::sources, PointsRole::targets})
      EXPECT_NE(refusal_of_table(
                    std::string("x,") + name + (role == PointsRole::sources ? ",weight\n0,1,1\n" : "\n0,1\n"), role)
                    .find("a coordinate?"),
                std::string::npos)
          << name;
  EXPECT_NE(refusal_of_table(",x,weight\n0,1,1\n").find("pandas writes such a column"), std::string::npos);
}

TEST(PointsTable, DoubtsColumnsBesideAxesAndColumnsThatCount) {
  EXPECT_TRUE(sources_in("x,y,weight\n0,0,1\n1,1,1\n2,2,1\n").doubts.empty());
  EXPECT_TRUE(sources_in("X1,x_2,x[3],weight\n0,0,1,1\n").doubts.empty());
  EXPECT_TRUE(sources_in("lon,lat,weight\n0,0,1\n").doubts.empty());
  EXPECT_TRUE(sources_in("a,b,weight\n0.5,1,1\n").doubts.empty());
  EXPECT_EQ(
      sources_in("x,y,speed,weight\n0,0,7,1\n").doubts,
      (std::vector<std::string>{"S.csv: the column \"speed\" is read as a coordinate; --columns x,y leaves it out, "
                                "--columns x,y,speed says that it is one"}));
  EXPECT_EQ(sources_in("station,east,weight\n1,0.5,1\n2,0.25,1\n3,0,1\n").doubts,
            (std::vector<std::string>{"S.csv: the column \"station\" counts the lines and is read as a coordinate; "
                                      "--columns east leaves it out, --columns station,east says that it is one"}));
}

TEST(PointsTable, TakesTheCoordinatesThatAreNamed) {
  const std::string text = "id,y,label,x,weight\n7,1,north,2,10\n8,3,south,4,20\n";
  const PointsTable table =
      parse_points_table(text, "S.csv", PointsRole::sources, enough_bytes, {{"x", "y"}, "", false});
  EXPECT_EQ(table.coordinates, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(table.positions, (Numbers{2, 1, 4, 3}));
  EXPECT_EQ(table.weights, (Numbers{10, 20}));
  EXPECT_TRUE(table.doubts.empty());
  EXPECT_EQ(parse_points_table(text, "T.csv", PointsRole::targets, enough_bytes, {{"id"}, "", false}).positions,
            (Numbers{7, 8}));
  const auto refused = [&](const CoordinateNames& names) {
    try {
      parse_points_table(text, "S.csv", PointsRole::sources, enough_bytes, {names, "", false});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({"x", "lable"}),
            "S.csv:1:1: there is no column \"lable\" among id, y, label, x, weight; is \"label\" meant?");
  EXPECT_EQ(refused({"x", "label"}), "S.csv:2:5: \"north\" is not a number in column \"label\"");
  EXPECT_EQ(refused({"x", "weight"}), "S.csv:1:14: the column \"weight\" is not a coordinate of sources");
}

TEST(PointsTable, SaysWhatAFileIsThatIsNoTable) {
  const auto said = [](std::string_view beginning) {
    return refusal_of_table(std::string(beginning) + std::string(100, '\7'));
  };
  EXPECT_EQ(
      said("CDF\1"),
      "S.csv is a NetCDF file; with Python: xarray.open_dataset(\"in.nc\").to_dataframe().reset_index()"
      ".to_csv(\"out.csv\", index=False). A table is text: a line of names, as in x,y,weight, then a line of numbers "
      "for every point, separated by commas, semicolons, tabs or blanks");
  EXPECT_NE(said("\x89HDF").find("is a NetCDF-4 or HDF5 file"), std::string::npos);
  EXPECT_NE(said("PK\3\4").find("as spreadsheets"), std::string::npos);
  EXPECT_NE(said("PAR1").find("a Parquet file; with Python: pandas.read_parquet"), std::string::npos);
  EXPECT_NE(said("\x89HDF").find("h5py"), std::string::npos);
  EXPECT_NE(said("<VTKFile").find("ParaView"), std::string::npos);
  EXPECT_NE(said("# vtk DataFile Version 3.0\n").find("ParaView"), std::string::npos);
}

// What stands in a file reaches the terminal in part, and without what steers it.
TEST(PointsTable, QuotesLittleAndOnlyWhatIsPrintable) {
  EXPECT_EQ(
      refusal_of_table("root:x:0:0:root:/root:/bin/bash\n"),
      "S.csv:1:1: there is no column \"weight\" among root:x:0:0:root:/root:/b...; --weight names another one; or "
      "add one, with 1 in every line if all sources count the same");
  const std::string steering = "\x1b[2J\x07\xc2\x9b\xe2\x80\xae\xff";
  for (const std::string& text :
       {steering + ",weight\n1,1\n", "x," + steering + "\n1,1\n", "x,weight\n" + steering + ",1\n",
        "x,weight\n1" + steering + "\n", steering + "\n", steering + " " + steering + "\n"}) {
    const std::string message = refusal_of_table(text);
    EXPECT_FALSE(message.empty());
    for (const char c : message) EXPECT_TRUE(c >= 32 && c < 127) << message;
    EXPECT_LT(message.size(), 200u) << message;
  }
  std::string many = "x";
  for (int k = 0; k < 1000; ++k) many += ",name" + std::to_string(k);
  EXPECT_LT(refusal_of_table(many + "\n1\n").size(), 300u);
}

TEST(PointsTable, NamesFileLineAndColumnOfABadValue) {
  EXPECT_EQ(refusal_of_table("x,y,weight\n0,0,1\n1,zwei,1\n"), "S.csv:3:3: \"zwei\" is not a number in column \"y\"");
  EXPECT_EQ(refusal_of_table("x,y,weight\n0,0,1\n1, 2 m,1\n"), "S.csv:3:4: \"2 m\" is not a number in column \"y\"");
  EXPECT_EQ(refusal_of_table("x,y,weight\n0,,1\n"), "S.csv:2:3: there is no value in column \"y\"");
  EXPECT_EQ(refusal_of_table("x,weight\n0,\n"), "S.csv:2:3: there is no value in column \"weight\"");
  EXPECT_EQ(refusal_of_table("x,weight\n0,nan\n"), "S.csv:2:3: nan is not finite in column \"weight\"");
  EXPECT_EQ(refusal_of_table("x,weight\n-inf,1\n"), "S.csv:2:1: -inf is not finite in column \"x\"");
  EXPECT_EQ(refusal_of_table("x,weight\r\n1,1\r\n1e400,1\r\n"),
            "S.csv:3:1: \"1e400\" is outside the range of double precision in column \"x\"");
  for (const char* wrong : {"1e", "0x10", "1_000", "--1", "+-1", "-+1", "+", "-", ".", "1 2", "1;2", "1\"", "1.2.3"})
    EXPECT_NE(refusal_of_table(std::string("x,weight\n0,1\n") + wrong + ",1\n").find("S.csv:3:1: "), std::string::npos)
        << wrong;
}

TEST(PointsTable, NamesTheLineThatIsRagged) {
  EXPECT_EQ(refusal_of_table("x,y,weight\n0,0,1\n1,2\n"),
            "S.csv:3:4: 2 values where 3 columns are named (x, y, weight)");
  EXPECT_EQ(refusal_of_table("x,weight\n0,1,2\n"), "S.csv:2:4: 3 values where 2 columns are named (x, weight)");
  EXPECT_EQ(refusal_of_table("x,weight\n0,1,\n"), "S.csv:2:4: 3 values where 2 columns are named (x, weight)");
  EXPECT_EQ(refusal_of_table("x,weight\n0,1\n\n2,1\n"), "S.csv:3:1: the line is blank, and points follow; remove it");
}

TEST(PointsTable, RefusesTablesWithoutPoints) {
  EXPECT_EQ(refusal_of_table(""), "S.csv is empty; it must have a line of names and a line for every point");
  EXPECT_EQ(refusal_of_table("\xEF\xBB\xBF\r\n\r\n"),
            "S.csv is empty; it must have a line of names and a line for every point");
  EXPECT_EQ(refusal_of_table("x,weight\n\n"), "S.csv:1: no points follow the line of names");
}

TEST(PointsTable, RefusesHeadersThatItCannotTrust) {
  EXPECT_EQ(
      refusal_of_table("1,2,3\n4,5,6\n"),
      "S.csv:1:1: \"1\" is a number; the first line must name the columns, as in x,y,weight, unless columns are chosen "
      "by number, as in --columns 1,2 --weight 3");
  EXPECT_EQ(refusal_of_table("x,,weight\n1,2,3\n"), "S.csv:1:3: column 2 has no name");
  EXPECT_EQ(refusal_of_table("x,x,weight\n1,2,3\n"), "S.csv:1:3: column \"x\" is there twice");
  EXPECT_EQ(
      refusal_of_table("x,y\n1,2\n"),
      "S.csv:1:1: there is no column \"weight\" among x, y; --weight names another one; or add one, with 1 in every "
      "line if all sources count the same");
  EXPECT_EQ(refusal_of_table("x,weigth\n1,2\n"),
            "S.csv:1:1: there is no column \"weight\" among x, weigth; is \"weigth\" meant? --weight weigth takes it");
  EXPECT_EQ(refusal_of_table("weight\n1\n"), "S.csv:1:1: there are no coordinates; sources have 1 to 4");
  EXPECT_EQ(refusal_of_table("a,b,c,d,e,weight\n1,2,3,4,5,6\n"),
            "S.csv:1:9: \"e\" would be coordinate 5; sources have 1 to 4: name them, as in --columns x,y");
  EXPECT_EQ(
      refusal_of_table("x,weight\n1,2\n", PointsRole::targets),
      "S.csv:1:3: targets have coordinates only; remove the column \"weight\", or name the coordinates by --columns");
  EXPECT_NE(refusal_of_table(std::string_view("\xFF\xFEx\0", 4)).find("S.csv is UTF-16; save it as UTF-8"),
            std::string::npos);
  EXPECT_NE(refusal_of_table(std::string_view("x\0,weight\n1,2\n", 13)).find("S.csv is no text"), std::string::npos);
}

TEST(PointsTable, RefusesSizesBeforeItAllocates) {
  std::string text = "x,y,z,weight\n";
  for (int i = 0; i < 1000; ++i) text += "1,2,3,4\n";
  EXPECT_EQ(refusal_of_table(text, PointsRole::sources, text.size() + 1001 * 32),
            "");  // the text and four doubles a line
  EXPECT_NE(refusal_of_table(text, PointsRole::sources, text.size()).find("would take"), std::string::npos);
}

TEST(PointsTable, ReadsAndRefusesFiles) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "S.csv";
  std::string text = "x,weight\n";
  for (int i = 0; i < 300000; ++i) text += std::to_string(i) + ",1\n";  // more than one block of the reader
  write_file(file, text);
  const PointsTable table = read_points_table(file, PointsRole::sources, enough_bytes);
  EXPECT_EQ(table.size(), 300000u);
  EXPECT_EQ(table.positions.back(), 299999);
  EXPECT_THROW(read_points_table(file, PointsRole::sources, 1000), InputError);
  EXPECT_THROW(read_points_table(folder / "none.csv", PointsRole::sources, enough_bytes), FileError);
  EXPECT_THROW(read_points_table(folder.path(), PointsRole::sources, enough_bytes), FileError);
}

}  // namespace
}  // namespace gaussdrift::input
