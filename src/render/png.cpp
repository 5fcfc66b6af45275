#include "render/png.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace gaussdrift::render {

namespace {

using Row = std::vector<std::uint8_t>;

/// Colours over white are taken off it where something shines through.
void copy_row(const Image& image, int left, int y, int columns, Row& row) {
  const std::size_t first =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(left);
  std::size_t at = 0;
  for (std::size_t pixel = first; pixel < first + static_cast<std::size_t>(columns); ++pixel) {
    const Colour& colour = image.pixels[pixel];
    if (image.opacity.empty()) {
      for (const std::uint8_t part : colour) row[at++] = part;
      continue;
    }
    const int opacity = image.opacity[pixel];
    for (const std::uint8_t part : colour)
      row[at++] = static_cast<std::uint8_t>(
          opacity == 0 ? 0 : std::clamp(255 + (255 * (part - 255) - opacity / 2) / opacity, 0, 255));
    row[at++] = static_cast<std::uint8_t>(opacity);
  }
}

/// The differences from the pixel at the left, and from the one above; the smaller ones are written.
void filter_row(const Row& above, const Row& row, std::size_t pixel, Row& beside, Row& over, std::string& out) {
  long of_beside = 0, of_over = 0;
  const auto size = [](std::uint8_t difference) { return std::abs(static_cast<std::int8_t>(difference)); };
  for (std::size_t i = 0; i < row.size(); ++i)
    over[i] = static_cast<std::uint8_t>(row[i] - above[i]), of_over += size(over[i]);
  for (std::size_t i = 0; i < pixel; ++i) beside[i] = row[i];
  for (std::size_t i = pixel; i < row.size(); ++i)
    beside[i] = static_cast<std::uint8_t>(row[i] - row[i - pixel]), of_beside += size(beside[i]);
  const bool upwards = of_over <= of_beside;
  out += static_cast<char>(upwards ? 2 : 1);
  const Row& chosen = upwards ? over : beside;
  out.append(chosen.begin(), chosen.end());
}

std::string deflated(const std::string& bytes) {
  constexpr int level = 4;
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, 15, 9, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int result = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw std::runtime_error("zlib could not compress a picture");
  return packed;
}

}  // namespace

std::string big_endian(std::size_t number) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift & 0xFF);
  return bytes;
}

std::string png_chunk(std::string_view type, std::string_view data) {
  std::string chunk = big_endian(data.size());
  chunk.append(type).append(data);
  const uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(chunk.data()) + 4, chunk.size() - 4);
  return chunk + big_endian(sum);
}

std::string png_header(int width, int height, bool with_opacity) {
  std::string data = big_endian(static_cast<std::size_t>(width)) + big_endian(static_cast<std::size_t>(height));
  data += '\x08';                          // bits
  data += with_opacity ? '\x06' : '\x02';  // red, green, blue
  data.append(3, '\0');
  return png_chunk("IHDR", data);
}

std::string png_pixels(const Image& image, int left, int bottom, int columns, int rows) {
  const std::size_t pixel = image.opacity.empty() ? 3 : 4, bytes = pixel * static_cast<std::size_t>(columns);
  Row above(bytes, 0), row(bytes), beside(bytes), over(bytes);
  std::string filtered;
  filtered.reserve((bytes + 1) * static_cast<std::size_t>(rows));
  for (int y = bottom + rows - 1; y >= bottom; --y) {
    copy_row(image, left, y, columns, row);
    filter_row(above, row, pixel, beside, over, filtered);
    std::swap(above, row);
  }
  return deflated(filtered);
}

std::string png_of(const Image& image) {
  return std::string(png_signature) + png_header(image.width, image.height, !image.opacity.empty()) +
         png_chunk("IDAT", png_pixels(image, 0, 0, image.width, image.height)) + png_chunk("IEND", "");
}

}  // namespace gaussdrift::render
