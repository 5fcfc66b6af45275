// Animated PNG: a PNG whose further frames stand in parts of their own. Each frame holds the rectangle that changes [PNG25].
#include <cstdint>
#include <string>
#include <utility>

#include "render/film.hpp"
#include "render/png.hpp"

namespace gaussdrift::render {

namespace {

std::string big_endian_pair(long number) {
  return {static_cast<char>(number >> 8 & 0xFF), static_cast<char>(number & 0xFF)};
}

void write_apng(const Reel& reel, std::FILE* file) {
  constexpr long parts = 1000;  // of a second
  std::size_t sequence = 0;
  Image before;
  for (std::size_t i = 0; i < reel.frames; ++i) {
    Image frame = reel.frame(i);
    Changed part{0, 0, frame.width, frame.height};
    if (i == 0) {
      put_bytes(file, std::string(png_signature) + png_header(frame.width, frame.height, false));
      put_bytes(file, png_chunk("acTL", big_endian(reel.frames) + big_endian(0)));  // for ever
    } else {
      part = changed(before.pixels, frame.pixels, frame.width, frame.height);
    }
    const auto number = [](int n) { return big_endian(static_cast<std::size_t>(n)); };
    const int top = frame.height - part.bottom - part.rows;
    put_bytes(
        file,
        png_chunk("fcTL", big_endian(sequence++) + number(part.columns) + number(part.rows) + number(part.left) +
                              number(top) + big_endian_pair(reel.begin(i + 1, parts) - reel.begin(i, parts)) +
                              big_endian_pair(parts) + std::string(2, '\0')));  // stays, and replaces what was there
    const std::string pixels = png_pixels(frame, part.left, part.bottom, part.columns, part.rows);
    put_bytes(file, i == 0 ? png_chunk("IDAT", pixels) : png_chunk("fdAT", big_endian(sequence++) + pixels));
    before = std::move(frame);
  }
  put_bytes(file, png_chunk("IEND", ""));
}

}  // namespace

FilmKind apng_film() {
  return {.about = {.name = "apng", .meaning = "an animated PNG with all colours, which browsers show"},
          .bytes_of_pixel = 0.16,
          .write = write_apng};
}

}  // namespace gaussdrift::render
