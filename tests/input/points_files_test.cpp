// Tables of points that are no text: arrays of NumPy, points of ParaView.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "gaussdrift/error.hpp"
#include "gaussdrift/particles.hpp"
#include "input/points_table.hpp"
#include "message_of.hpp"
#include "scratch_folder.hpp"
#include "write/npy_file.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::input {
namespace {

using Numbers = std::vector<double>;
using Names = std::vector<std::string>;

constexpr std::size_t plenty = std::size_t{1} << 30;

/// As numpy.save writes it, with this head and these numbers.
template <class Number>
std::string npy(const std::string& head, const std::vector<Number>& numbers, char version = 1) {
  std::string bytes = std::string("\x93NUMPY") + version + '\0';
  for (int k = 0; k < (version == 1 ? 2 : 4); ++k) bytes += static_cast<char>(head.size() >> (8 * k) & 255);
  bytes += head;
  const std::size_t begin = bytes.size();
  bytes.resize(begin + numbers.size() * sizeof(Number));
  if (!numbers.empty()) std::memcpy(bytes.data() + begin, numbers.data(), numbers.size() * sizeof(Number));
  return bytes;
}
std::string head(const std::string& shape, const std::string& type = "<f8", const std::string& fortran = "False") {
  return "{'descr': '" + type + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }      \n";
}

PointsTable sources(const std::string& bytes, const PointsColumns& columns = {{}, "3", false}) {
  return parse_points_table(bytes, "S.npy", PointsRole::sources, plenty, columns);
}
std::string refusal(const std::string& bytes, const PointsColumns& columns = {{}, "3", false},
                    std::size_t limit = plenty) {
  return message_of<InputError>([&] { parse_points_table(bytes, "S.npy", PointsRole::sources, limit, columns); });
}

TEST(PointsOfNumPy, AreRowsInEitherOrderAndPrecision) {
  const std::vector<double> rows{1, 2, 10, 3, 0.1, 20}, columns{1, 3, 2, 0.1, 10, 20};
  for (const std::string& bytes : {npy(head("(2, 3)"), rows), npy(head("(2, 3)", "<f8", "True"), columns),
                                   npy(head("(2,3)"), rows, 2), npy(head("( 2 ,3,)"), rows, 3)}) {
    const PointsTable table = sources(bytes);
    EXPECT_EQ(table.coordinates, (Names{"1", "2"}));
    EXPECT_EQ(table.positions, (Numbers{1, 2, 3, 0.1}));
    EXPECT_EQ(table.weights, (Numbers{10, 20}));
  }
  const std::vector<float> singles{1, 2, 10, 3, 0.1F, 20};
  EXPECT_EQ(sources(npy(head("(2, 3)", "<f4"), singles)).positions, (Numbers{1, 2, 3, double(0.1F)}));
  EXPECT_EQ(sources(npy(head("(2, 3)"), rows), {{"2", "1"}, "3", false}).positions, (Numbers{2, 1, 0.1, 3}));
  EXPECT_EQ(sources(npy(head("(6,)"), rows), {{"1"}, "", true}).positions, rows);
  EXPECT_EQ(parse_points_table(npy(head("(3, 2)"), rows), "T.npy", PointsRole::targets, plenty).positions, rows);
  EXPECT_EQ(parse_named_columns(npy(head("(2, 3)"), rows), "S.npy", {"x", "y", "u"}, plenty).rows, rows);
}

TEST(PointsOfNumPy, AreRefusedWhereTheHeadIsNotTrue) {
  const std::vector<double> rows{1, 2, 10, 3, 0.1, 20};
  const std::string good = npy(head("(2, 3)"), rows);
  for (std::size_t length = 6; length < good.size(); ++length)
    EXPECT_NE(refusal(good.substr(0, length)).find("S.npy"), std::string::npos) << length;
  const std::vector<std::pair<std::string, std::string>> wrong{
      {good + " ", "S.npy is damaged: its head tells of 2 x 3 numbers, 48 bytes, and 49 bytes follow; save it again"},
      {npy(head("(3, 3)"), rows), "its head tells of 3 x 3 numbers, 72 bytes, and 48 bytes follow"},
      {npy(head("(4294967296, 4294967296)"), rows), "more than there can be, and 48 bytes follow"},
      {npy(head("(2305843009213693953, 8)"), rows), "more than there can be"},
      {npy(head("(2305843009213693952, 1)"), rows), "more than there can be"},
      {npy(head("(18446744073709551616, 1)"), rows), "a whole number below 2^64"},
      {npy(head("(-2, 3)"), rows), "a whole number below 2^64"},
      {npy(head("(2, 3, 1)"), rows), "S.npy has 3 axes; a table has two, rows and columns, or one"},
      {npy(head("()"), std::vector<double>{1}), "S.npy has 0 axes"},
      {npy(head("(0, 3)"), std::vector<double>{}), "S.npy has no points"},
      {npy(head("(9223372036854775807, 0)"), std::vector<double>{}), "there is no column 3; 0 columns are there"},
      {npy(head("(0, 9223372036854775807)"), std::vector<double>{}), "columns, at most 10000 are possible"},
      {npy(head("(2, 3)", ">f8"), rows), "numbers of the type \">f8\"; \"<f8\" and \"<f4\" are read"},
      {npy(head("(2, 3)", "<i8"), rows), "numbers of the type \"<i8\""},
      {npy(head("(2, 3)", "|O"), rows), "numbers of the type \"|O\""},
      {npy("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (2,), }", rows), "a structured array"},
      {npy("{'descr': '<f8', 'fortran_order': False}", rows), "it must have \"descr\", \"fortran_order\" and"},
      {npy("{'descr': '<f8', 'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)}", rows), "stands there twice"},
      {npy("{'descr': '<f8', 'fortran_order': 0, 'shape': (2, 3)}", rows), "True or False must stand here"},
      {npy("{'descr': '<f8", rows), "a word in quotation marks must stand here"},
      {npy("[]", rows), "'{' must stand here"},
      {npy(head("(2, 3)") + "x", rows), "more follows behind its closing bracket"},
      {npy(head("(2, 3)"), rows, 9), "version 9 of NumPy's format"},
      {std::string("\x93NUMPY\x02\x00\xFF\xFF\xFF\xFF", 12), "its head is longer than the file"}};
  for (const auto& [bytes, said] : wrong)
    EXPECT_NE(refusal(bytes).find(said), std::string::npos) << said << "\n" << refusal(bytes);
}

TEST(PointsOfNumPy, AreRefusedWhereColumnsAreNotToldOrNumbersAreNone) {
  const std::vector<double> rows{1, 2, 10, 3, std::numeric_limits<double>::quiet_NaN(), 20};
  const std::string bytes = npy(head("(2, 3)"), rows);
  EXPECT_EQ(refusal(bytes),
            "S.npy: \"2\" of point 2 (counted from 1) is nan; numbers must be finite, so leave the point out");
  EXPECT_EQ(refusal(bytes, {}),
            "S.npy: its columns have no names; say by number which is the weight, as in --columns 1,2 --weight 3");
  EXPECT_EQ(
      refusal(bytes, {{"x"}, "3", false}),
      "S.npy: there is no column \"x\": its columns have no names; give their numbers, as in --columns 1,2 --weight "
      "3");
  EXPECT_EQ(refusal(bytes, {{"1", "4"}, "3", false}),
            "S.npy: there is no column 4; 3 columns are there, counted from 1");
  EXPECT_NE(refusal(bytes, {{}, "3", false}, bytes.size() + 20).find("S.npy has 2 points and would take"),
            std::string::npos);
  EXPECT_EQ(message_of<InputError>([&] {
              parse_named_columns(bytes, "S.npy", {"x", "y"}, plenty);
            }),
            "S.npy: 3 columns are there; the columns must be x,y");
}

TEST(PointsOfNumPy, AreReadAsTheyWereWritten) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "V.npy";
  const Numbers values{1, 2, 3, -0.0, 5e-324, 1.7976931348623157e308};
  for (const std::vector<std::size_t>& shape : {std::vector<std::size_t>{6}, {2, 3}}) {
    std::FILE* out = std::fopen(file.c_str(), "wb");
    write::write_npy(out, shape, values.data());
    std::fclose(out);
    const std::string bytes = read_file(file);
    EXPECT_EQ((bytes.size() - 48) % 64, 0u);
    if (shape.size() == 1) {
      EXPECT_EQ(read_points_table(file, PointsRole::targets, plenty).positions, values);
    } else {
      EXPECT_EQ(read_points_table(file, PointsRole::sources, plenty, {{}, "3", false}).weights,
                (Numbers{5e-324, values[5]}));
    }
  }
}

class PointsOfParaView : public testing::Test {
 protected:
  /// Particles in the plane or in space, as a run writes them.
  void write(int dimension) {
    Particles particles;
    particles.dimension = dimension;
    std::vector<double> velocity;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < dimension; ++k) {
        velocity.push_back(10 * j + k + 1);
        particles.position[static_cast<std::size_t>(k)].push_back(velocity.back());
      }
      particles.alpha.push_back(0.5 * j);
      particles.id.push_back(j);
    }
    write::write_particles(file_, particles, velocity, 0);
  }
  std::string refused(const PointsColumns& columns, PointsRole role = PointsRole::sources) {
    return message_of<InputError>([&] { read_points_table(file_, role, plenty, columns); });
  }
  const ScratchFolder folder_;
  const std::filesystem::path file_ = folder_ / "S.vtp";
};

TEST_F(PointsOfParaView, ArePlacesAndAnyArrayIsTheWeight) {
  write(2);
  const PointsTable plane = read_points_table(file_, PointsRole::sources, plenty, {{}, "alpha", false});
  EXPECT_EQ(plane.coordinates, (Names{"x", "y"}));
  EXPECT_EQ(plane.positions, (Numbers{1, 2, 11, 12, 21, 22}));
  EXPECT_EQ(plane.weights, (Numbers{0, 0.5, 1}));
  EXPECT_TRUE(plane.doubts.empty());
  EXPECT_FALSE(has_third_coordinate(file_, plenty));
  const PointsTable turned = read_points_table(file_, PointsRole::sources, plenty, {{"u:1", "z"}, "id", false});
  EXPECT_EQ(turned.positions, (Numbers{2, 0, 12, 0, 22, 0}));
  EXPECT_EQ(turned.weights, (Numbers{0, 1, 2}));
  EXPECT_EQ(read_named_columns(file_, {"y", "x", "alpha"}, plenty).rows, (Numbers{2, 1, 0, 12, 11, 0.5, 22, 21, 1}));
  write(3);
  EXPECT_EQ(read_points_table(file_, PointsRole::targets, plenty).positions,
            (Numbers{1, 2, 3, 11, 12, 13, 21, 22, 23}));
  EXPECT_TRUE(has_third_coordinate(file_, plenty));
}

TEST_F(PointsOfParaView, AreRefusedWithTheArraysThatThereAre) {
  write(3);
  const std::string file = file_.string();
  EXPECT_EQ(refused({}), file +
                             ": there is no column \"weight\" among x, y, z, id, alpha, u:0, u:1, u:2; --weight names "
                             "another one; or add one, with 1 in every line if all sources count the same");
  EXPECT_NE(refused({{}, "alpa", false}).find("is \"alpha\" meant?"), std::string::npos);
  const std::string text = read_file(file_);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    other.replace(other.find(from), from.size(), to);
    write_file(file_, other);
    return refused({{}, "alpha", false});
  };
  EXPECT_NE(changed("NumberOfPoints=\"3\"", "NumberOfPoints=\"99999999999\"").find("at most"), std::string::npos);
  EXPECT_NE(changed("NumberOfPoints=\"3\"", "NumberOfPoints=\"1000000\"").find("has fewer numbers than"),
            std::string::npos);
  EXPECT_NE(changed("NumberOfPoints=\"3\"", "NumberOfPoints=\"-3\"").find("a whole number"), std::string::npos);
  EXPECT_NE(changed("type=\"PolyData\"", "type=\"ImageData\"").find("S.vtp is not a file of points"),
            std::string::npos);
  EXPECT_NE(changed("</Points>", "</Point>").find("S.vtp is damaged"), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::input
