#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "read/file_bytes.hpp"
#include "read/grid_file_error.hpp"
#include "read/matrix.hpp"

namespace gaussdrift::read {

namespace {

constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
constexpr double most_pixels = 1e8, most_packed = 1040;  // zlib makes at most 1032 bytes of one

class Png {
 public:
  explicit Png(const std::filesystem::path& file) : bytes_(file) {
    data_.resize(static_cast<std::size_t>(bytes_.size()));
    data_.resize(bytes_.read(0, data_.data(), data_.size()));
  }

  Matrix grey() {
    read_chunks();
    const std::vector<unsigned char> rows = unpacked();
    Matrix matrix{width_, height_, std::vector<double>(width_ * height_)};
    for (std::size_t row = 0; row < height_; ++row)
      for (std::size_t column = 0; column < width_; ++column)
        matrix.values[(height_ - 1 - row) * width_ + column] = grey_of(rows.data() + row * row_bytes(), column);
    return matrix;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw GridFileError(fmt::format("{} {}", bytes_.name(), what), "save the picture as a PNG again");
  }

  std::uint32_t number_at(std::size_t at) const {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(data_[at + i]);
    return number;
  }

  void read_chunks() {
    if (std::string_view(data_.data(), std::min(data_.size(), signature.size())) != signature) fail("is no PNG");
    std::size_t at = signature.size();
    for (bool ended = false; !ended;) {
      if (data_.size() - at < 12) fail("is cut off");
      const std::size_t length = number_at(at);
      if (data_.size() - at - 12 < length) fail("is cut off");
      const std::string kind(data_.data() + at + 4, 4);
      const auto* from = reinterpret_cast<const Bytef*>(data_.data() + at + 4);
      if (crc32(0, from, static_cast<uInt>(length + 4)) != number_at(at + 8 + length))
        fail("is damaged: a checksum is wrong");
      const std::string_view content(data_.data() + at + 8, length);
      if (width_ == 0 && kind != "IHDR") fail("does not begin with a header");
      if (kind == "IHDR") read_header(content, at + 8);
      if (kind == "PLTE") palette_ = content;
      if (kind == "IDAT") packed_ += content;
      ended = kind == "IEND";
      at += 12 + length;
    }
  }

  void read_header(std::string_view content, std::size_t at) {
    if (content.size() != 13) fail("has a header of the wrong length");
    width_ = number_at(at), height_ = number_at(at + 4);
    depth_ = static_cast<unsigned char>(content[8]);
    colours_ = static_cast<unsigned char>(content[9]);
    constexpr std::array<std::size_t, 7> samples{1, 0, 3, 1, 2, 0, 4};
    const bool is_deep = depth_ == 8 || depth_ == 16, is_shallow = depth_ == 1 || depth_ == 2 || depth_ == 4;
    if (colours_ > 6 || samples[colours_] == 0 || !(is_deep || (is_shallow && (colours_ == 0 || colours_ == 3))) ||
        (colours_ == 3 && depth_ == 16))
      fail(fmt::format("has colours of the kind {} with {} bits, which there is not", colours_, depth_));
    if (content[12] != 0) fail("is interlaced, which is not read");
    if (width_ == 0 || height_ == 0 || static_cast<double>(width_) * static_cast<double>(height_) > most_pixels)
      fail(fmt::format("has {} x {} pixels; at most {:.0e} are read", width_, height_, most_pixels));
    samples_ = samples[colours_];
  }

  std::size_t row_bytes() const { return (width_ * samples_ * depth_ + 7) / 8; }

  std::vector<unsigned char> unpacked() const {
    const std::size_t row = row_bytes(), whole = height_ * (row + 1);
    if (static_cast<double>(whole) > most_packed * static_cast<double>(packed_.size()) + 64)
      fail("is damaged: pixels are missing");
    std::vector<unsigned char> filtered(whole);
    uLongf length = static_cast<uLongf>(whole);
    if (uncompress(filtered.data(), &length, reinterpret_cast<const Bytef*>(packed_.data()),
                   static_cast<uLong>(packed_.size())) != Z_OK ||
        length != whole)
      fail("is damaged: its pixels cannot be unpacked");
    const std::size_t back = std::max<std::size_t>(1, samples_ * depth_ / 8);
    std::vector<unsigned char> rows(height_ * row);
    for (std::size_t j = 0; j < height_; ++j) {
      const unsigned char filter = filtered[j * (row + 1)];
      if (filter > 4) fail("is damaged: a row has a filter that there is not");
      const unsigned char* from = filtered.data() + j * (row + 1) + 1;
      unsigned char* to = rows.data() + j * row;
      for (std::size_t i = 0; i < row; ++i) {
        const int left = i >= back ? to[i - back] : 0,
                  above = j > 0 ? to[static_cast<std::ptrdiff_t>(i) - static_cast<std::ptrdiff_t>(row)] : 0;
        const int corner = i >= back && j > 0 ? *(to + i - back - row) : 0;
        const std::array<int, 5> guess{0, left, above, (left + above) / 2, nearest(left, above, corner)};
        to[i] = static_cast<unsigned char>(from[i] + guess[filter]);
      }
    }
    return rows;
  }

  static int nearest(int left, int above, int corner) {
    const int p = left + above - corner;
    const int a = std::abs(p - left), b = std::abs(p - above), c = std::abs(p - corner);
    return a <= b && a <= c ? left : b <= c ? above : corner;
  }

  /// From 0 to 1; of a palette the number of the colour.
  double sample(const unsigned char* row, std::size_t number) const {
    if (depth_ == 16) return (256. * row[2 * number] + row[2 * number + 1]) / 65535;
    if (depth_ == 8) return colours_ == 3 ? row[number] : row[number] / 255.;
    const std::size_t bit = number * depth_;
    const int value = row[bit / 8] >> (8 - depth_ - bit % 8) & ((1 << depth_) - 1);
    return colours_ == 3 ? value : value / static_cast<double>((1 << depth_) - 1);
  }

  /// Grey stays what it is.
  static double luminance(double red, double green, double blue) {
    return green + 0.299 * (red - green) + 0.114 * (blue - green);
  }

  double grey_of(const unsigned char* row, std::size_t column) const {
    const auto at = [&](std::size_t k) { return sample(row, column * samples_ + k); };
    switch (colours_) {
      case 0:
        return at(0);
      case 2:
        return luminance(at(0), at(1), at(2));
      case 3: {
        const auto index = static_cast<std::size_t>(at(0));
        if (3 * index + 2 >= palette_.size()) fail("is damaged: a colour is not in its palette");
        const auto part = [&](std::size_t k) { return static_cast<unsigned char>(palette_[3 * index + k]) / 255.; };
        return luminance(part(0), part(1), part(2));
      }
      case 4:
        return at(0) * at(1);
      default:
        return luminance(at(0), at(1), at(2)) * at(3);
    }
  }

  FileBytes bytes_;
  std::string data_, palette_, packed_;
  std::size_t width_ = 0, height_ = 0, samples_ = 1, depth_ = 8, colours_ = 0;
};

}  // namespace

Matrix read_grey_png(const std::filesystem::path& file) { return Png(file).grey(); }

}  // namespace gaussdrift::read
