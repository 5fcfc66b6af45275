// Densities from pictures and from rows of numbers.
#include <zlib.h>

#include <string>
#include <vector>

#include "grid_files.hpp"

namespace gaussdrift::input {
namespace {

using Numbers = std::vector<double>;

class Matrices : public GridFile {
 protected:
  static std::string number(std::size_t value) {
    std::string bytes;
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
  }
  static std::string chunk(const std::string& kind, const std::string& content) {
    const std::string all = kind + content;
    return number(content.size()) + all +
           number(crc32(0, reinterpret_cast<const Bytef*>(all.data()), static_cast<uInt>(all.size())));
  }
  /// `rows`: with their filters.
  static std::string png(std::size_t width, std::size_t height, int depth, int colours, const std::string& rows,
                         const std::string& palette = "", int interlaced = 0) {
    std::string packed(compressBound(rows.size()), '\0');
    uLongf length = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(rows.data()),
             rows.size());
    packed.resize(length);
    return std::string("\x89PNG\r\n\x1a\n") +
           chunk("IHDR", number(width) + number(height) + static_cast<char>(depth) + static_cast<char>(colours) +
                             std::string(2, '\0') + static_cast<char>(interlaced)) +
           (palette.empty() ? "" : chunk("PLTE", palette)) + chunk("IDAT", packed) + chunk("IEND", "");
  }
  static std::string bytes(const std::vector<int>& values) {
    std::string all;
    for (const int value : values) all += static_cast<char>(value);
    return all;
  }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
  static read::GridRequest request() {
    return {.missing = read::Missing::keep, .frame = read::Frame{{0, 0, 0}, {2, 2, 0}}};
  }
  /// The values of the 2 x 2 cells, from the lower left.
  Numbers cells(const std::string& name) const {
    const auto data = read::read_grid(folder_ / name, request());
    EXPECT_EQ(data->axis[0], (Numbers{0, 0.5, 1.5, 2}));
    const Numbers& all = data->values[0];
    return {all[5], all[6], all[9], all[10]};
  }
};

TEST_F(Matrices, of_a_table_fill_the_frame_with_the_first_row_on_top) {
  write("rho.csv", "# a remark\n1, 2\n\n3,4e0 # the lower row\n");
  EXPECT_EQ(cells("rho.csv"), (Numbers{3, 4, 1, 2}));
  write("rho.csv", "1 2\n3\t4");
  EXPECT_EQ(cells("rho.csv"), (Numbers{3, 4, 1, 2}));
  write("rho.csv", "\"1\";2D0\n3.0d+00;\"0.4D1\"\n");
  EXPECT_EQ(cells("rho.csv"), (Numbers{3, 4, 1, 2}));
  write("rho.csv", "1,2\n3,x\n");
  EXPECT_NE(refusal("rho.csv", request()).find("rho.csv:2:3: \"x\" is not a number"), std::string::npos);
  write("rho.csv", "1,,2\n");
  EXPECT_NE(refusal("rho.csv", request()).find("rho.csv:1:3: \"\" is not a number"), std::string::npos);
  write("rho.csv", "1,2\n3\n");
  EXPECT_NE(refusal("rho.csv", request()).find("rho.csv:2: 1 numbers stand here, and 2 in the rows before"),
            std::string::npos);
}

TEST_F(Matrices, of_a_picture_are_its_grey) {
  write("a.png", png(2, 2, 8, 0, bytes({0, 0, 51, 0, 102, 255})));
  EXPECT_EQ(cells("a.png"), (Numbers{0.4, 1, 0, 0.2}));
  write("a.png", png(2, 2, 16, 0, bytes({0, 0, 0, 255, 255, 0, 128, 0, 0, 1})));
  EXPECT_EQ(cells("a.png"), (Numbers{32768 / 65535., 1 / 65535., 0, 1}));
  write("a.png", png(2, 2, 1, 0, bytes({0, 0x40, 0, 0x80})));
  EXPECT_EQ(cells("a.png"), (Numbers{1, 0, 0, 1}));
  write("a.png", png(2, 2, 8, 2, bytes({0, 255, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0, 0})));
  EXPECT_EQ(cells("a.png"), (Numbers{0.114, 0, 0.299, 1 - 0.299 - 0.114}));
  write("a.png", png(2, 2, 8, 4, bytes({0, 255, 51, 255, 255, 0, 0, 255, 51, 0})));
  EXPECT_EQ(cells("a.png"), (Numbers{0, 0, 0.2, 1}));
  write("a.png", png(2, 2, 2, 3, bytes({0, 0x10, 0, 0x40}), bytes({0, 0, 0, 255, 255, 255})));
  EXPECT_EQ(cells("a.png"), (Numbers{1, 0, 0, 1}));
}

TEST_F(Matrices, of_a_picture_are_unfiltered) {
  // 10 20 / 30 50 by each filter in the second row; the first one by the difference from the left.
  for (const auto& [filter, first, second] :
       std::vector<std::array<int, 3>>{{0, 30, 50}, {1, 30, 20}, {2, 20, 30}, {3, 25, 25}, {4, 20, 20}}) {
    write("a.png", png(2, 2, 8, 0, bytes({1, 10, 10, filter, first, second})));
    EXPECT_EQ(cells("a.png"), (Numbers{30 / 255., 50 / 255., 10 / 255., 20 / 255.})) << filter;
  }
}

TEST_F(Matrices, of_a_damaged_picture_are_refused) {
  const std::string whole = png(2, 2, 8, 0, bytes({0, 0, 51, 0, 102, 255}));
  for (const std::size_t length : {std::size_t{0}, std::size_t{8}, std::size_t{20}, whole.size() - 1}) {
    write("a.png", whole.substr(0, length));
    EXPECT_NE(refusal("a.png", request()), "") << length;
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string other = whole;
    other[at] = static_cast<char>(other[at] ^ 4);
    write("a.png", other);
    EXPECT_NE(refusal("a.png", request()), "") << at;
  }
  write("a.png", png(2, 2, 8, 0, bytes({0, 0, 51, 0, 102, 255}), "", 1));
  EXPECT_NE(refusal("a.png", request()).find("is interlaced"), std::string::npos);
  write("a.png", png(9999, 9999, 8, 0, bytes({0, 0, 51})));
  EXPECT_NE(refusal("a.png", request()).find("pixels are missing"), std::string::npos);
}

TEST_F(Matrices, fill_the_domain_of_a_case) {
  write("rho.csv", "1,2\n3,4\n");
  const auto read = [&](const std::string& density) {
    const std::size_t from = cone.find("[density]"), to = cone.find("[particles]");
    return parse_case(std::string(cone).replace(from, to - from, "[density]\n" + density + "\n\n"),
                      folder_ / "cone.toml")
        .spec;
  };
  const Case spec = read("file = \"rho.csv\"");
  const auto& data = *std::get<FileDensitySpec>(spec.density[0]).data;
  EXPECT_EQ(data.axis[1], (Numbers{-1, -0.5, 0.5, 1}));
  EXPECT_NE(message("file = \"rho.csv\""), "") << "a table is no velocity on a grid";
}

}  // namespace
}  // namespace gaussdrift::input
