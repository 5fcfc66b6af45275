// gaussdrift sum: the kinds of tables that it reads, and the kinds of files that it writes.
#include <gtest/gtest.h>

#include <cstring>

#include "program/program.hpp"
#include "program/sum_tables.hpp"

namespace gaussdrift {
namespace {

/// As numpy.save writes rows; in the order of Fortran where columns are given.
std::string npy(const Rows& rows, bool fortran) {
  const std::size_t m = rows.size(), n = rows[0].size();
  std::string head = std::string("{'descr': '<f8', 'fortran_order': ") + (fortran ? "True" : "False") + ", 'shape': (" +
                     std::to_string(m) + ", " + std::to_string(n) + "), }";
  head.resize(117, ' ');
  head += '\n';
  std::string bytes = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + head;
  for (std::size_t k = 0; k < m * n; ++k) {
    const double number = fortran ? rows[k % m][k / m] : rows[k / n][k % n];
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  return bytes;
}

/// The numbers of such a file that the program wrote, after its head.
struct Array {
  std::string shape;
  std::vector<double> numbers;
};
Array array_of(const std::string& bytes) {
  const std::size_t length = static_cast<unsigned char>(bytes.at(8)) + 256 * static_cast<unsigned char>(bytes.at(9));
  const std::string head = bytes.substr(10, length);
  EXPECT_EQ((10 + length) % 64, 0u);
  EXPECT_EQ(head.substr(0, 55), "{'descr': '<f8', 'fortran_order': True, 'shape': (" + head.substr(50, 5));
  Array array{head.substr(49, head.find(')') - 48), std::vector<double>((bytes.size() - 10 - length) / 8)};
  std::memcpy(array.numbers.data(), bytes.data() + 10 + length, 8 * array.numbers.size());
  return array;
}

std::vector<double> column(const Table& table, std::size_t k) {
  std::vector<double> numbers;
  for (const auto& row : table.rows) numbers.push_back(row[k]);
  return numbers;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

TEST(Sum, OfTheSameTableInOtherFormsHasTheSameBytes) {
  const ScratchFolder folder;
  const Rows rows = points(300, 3);
  const std::string text = csv("x,y,weight", rows), bare = text.substr(text.find('\n') + 1);
  write_file(folder / "S.csv", text);
  const Outcome sum = gaussdrift_in(folder, "sum --sources S.csv --sigma 5");
  ASSERT_EQ(sum.exit_code, 0) << sum.err;
  EXPECT_EQ(table_of(sum.out).rows.size(), 300u);
  write_file(folder / "german.csv", "\"x, km\";\"y;\";mass\r\n" + with(with(bare, ",", ";"), "\n", "\r\n"));
  write_file(folder / "tabs.txt", "x\ty\tweight\n" + with(bare, ",", "\t"));
  write_file(folder / "blanks.txt", "# from a program\n" + with(bare, ",", "   "));
  write_file(folder / "quoted.csv", "x,y,weight\n\"" + with(with(bare, ",", "\",\""), "\n", "\"\n\""));
  write_file(folder / "fortran.txt", "x y weight\n" + with(with(with(bare, "e", "D"), ",", " "), "\n", " # weight\n"));
  write_file(folder / "rows.npy", npy(rows, false));
  write_file(folder / "columns.npy", npy(rows, true));
  const std::string quoted = read_file(folder / "quoted.csv");
  write_file(folder / "quoted.csv", quoted.substr(0, quoted.size() - 1));
  for (const char* sources :
       {"german.csv --columns 1,2 --weight mass", "tabs.txt", "fortran.txt", "blanks.txt --columns 1,2 --weight 3",
        "quoted.csv", "rows.npy --weight 3", "columns.npy --weight 3", "columns.npy --columns 1,2 --weight 3",
        "- <S.csv", "- --weight 3 <columns.npy"}) {
    const Outcome other = gaussdrift_in(folder, std::string("sum --sigma 5 --sources ") + sources);
    EXPECT_EQ(other.exit_code, 0) << sources << other.err;
    EXPECT_EQ(other.out, sum.out) << sources;
  }
  const Outcome piped = gaussdrift_in(folder, "sum --sigma 5 --sources - --targets S.csv --columns x,y <S.csv");
  EXPECT_EQ(piped.out, sum.out) << piped.err;
}

TEST(Sum, WritesArraysWithTheAxesOfTheGrid) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv("x,y,weight", points(40, 3)));
  const std::string call = "sum --sources S.csv --sigma 5 ", grid = "--grid=0:1:4,0:2:3 ",
                    both = "--derivative 0,0 --derivative 1,0 ";
  const auto written = [&](const std::string& options, const std::string& name) {
    const Outcome sum = gaussdrift_in(folder, call + options + "--out " + name);
    EXPECT_EQ(sum.exit_code, 0) << sum.err;
    return read_file(folder / name);
  };
  const Array one = array_of(written(grid, "V.npy"));
  EXPECT_EQ(one.shape, "(4, 3)");
  EXPECT_EQ(one.numbers, column(table_of(written(grid, "V.csv")), 0));  // both have the first axis fastest
  const Table values = table_of(written(grid + both, "V.csv"));
  std::vector<double> all = column(values, 0);
  const Array two = array_of(written(grid + both, "V.npy"));
  EXPECT_EQ(two.shape, "(4, 3, 2)");
  for (const double value : column(values, 1)) all.push_back(value);
  EXPECT_EQ(two.numbers, all);
  EXPECT_EQ(array_of(written("", "W.npy")).shape, "(40,)");
  EXPECT_EQ(array_of(written(both, "W.npy")).shape, "(40, 2)");

  const std::string image = written(grid + both, "V.vti");
  EXPECT_NE(image.find("<ImageData WholeExtent=\"0 3 0 2 0 0\" Origin=\"0 0 0\" Spacing=\"0.3333333333333333 1 1\""),
            std::string::npos);
  EXPECT_LT(image.find("Name=\"d_0_0\""), image.find("Name=\"d_1_0\""));
  EXPECT_FALSE(fs::exists(folder / "V.vti.part"));
}

TEST(Sum, RefusesFilesThatItDoesNotReadOrWrite) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv("x,y,weight", points(4, 3)));
  write_file(folder / "S4.csv", csv("x,y,z,w,weight", points(4, 5)));
  write_file(folder / "S.parquet", "PAR1\7\7\7");
  write_file(folder / "S.h5", "\x89HDF\r\n\7\7");
  write_file(folder / "S.xlsx", "PK\3\4\7\7");
  write_file(folder / "S.npy", npy(points(4, 3), false).substr(0, 150));
  write_file(folder / "S.vti", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\"></VTKFile>\n");
  struct Refusal {
    int exit_code;
    const char *arguments, *said;
  };
  for (const auto& [exit_code, arguments, said] : std::vector<Refusal>{
           {3, "S.parquet", "S.parquet is a Parquet file; with Python: pandas.read_parquet("},
           {3, "S.h5", "HDF5 file; with Python: "},
           {3, "S.xlsx", "spreadsheets"},
           {3, "S.npy --weight 3", "S.npy is damaged: its head tells of 4 x 3 numbers, 96 bytes, and 22 bytes follow"},
           {3, "S.vti", "S.vti is not a file of points"},
           {3, "- <S.vti",
            "standard input is an XML file, as those of VTK are; a .vtp is read where its name is given"},
           {6, "-", "standard input is a device, not a table of points"},
           {3, "- < S.parquet", "standard input is a Parquet file"},
           {3, "S.csv --weight 4", "there is no column 4; 3 columns are there, counted from 1"},
           {2, "S.csv --weight y --columns x,y", "\"y\" is the weight, by --weight"},
           {2, "- --targets - <S.csv", "cannot both be -, standard input"},
           {2, "S.csv --out V.vti", "an image has values on a grid; give --grid, or a name such as V.npy"},
           {2, "S.csv --out V.h5", "a NumPy array (.npy), or on a grid as an image for ParaView (.vti)"},
           {2, "S4.csv --columns x,y,z,w --grid=0:1:2,0:1:2,0:1:2,0:1:2 --out V.vti",
            "an image has 1 to 3 axes, the grid 4"}}) {
    const Outcome refused = gaussdrift_in(folder, std::string("sum --sigma 1 --sources ") + arguments);
    EXPECT_EQ(refused.exit_code, exit_code) << arguments << refused.err;
    EXPECT_NE(refused.err.find(said), std::string::npos) << arguments << "\n" << refused.err;
    EXPECT_EQ(refused.out, "") << arguments;
    EXPECT_FALSE(fs::exists(folder / "V.vti"));
  }
}

}  // namespace
}  // namespace gaussdrift
