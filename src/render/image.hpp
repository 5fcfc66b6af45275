// A picture in memory, and what can be put on it. Pixels are counted from the lower left, and pixel (i, j) covers
// [i, i + 1] x [j, j + 1]. Later things cover earlier ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/colour.hpp"

namespace gaussdrift::render {

struct Point {
  double x = 0, y = 0;
};

/// A thick line: the points of its two sides, equally many.
struct Strip {
  std::vector<Point> left, right;
  Colour colour = ink;
};

/// How much of each pixel something covers, from the lower left, x fastest: 0 nothing, 255 all.
struct Mask {
  int left = 0, bottom = 0;  // of its first pixel, relative to where it is put
  int width = 0, height = 0;
  std::vector<std::uint8_t> cover;
};

struct Image {
  int width = 0, height = 0;
  std::vector<Colour> pixels;         // from the lower left, x fastest; where one is not opaque, over white
  std::vector<std::uint8_t> opacity;  // of the pixels; empty: all are opaque

  const Colour& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// A white one, or one that nothing covers yet.
Image blank_image(int width, int height, bool transparent);

/// columns x rows colours, x fastest, from (left, bottom) on. What lies beyond the edges is left out.
void put_colours(Image& image, int left, int bottom, int columns, int rows, const std::vector<Colour>& colours);

void put_mask(Image& image, int x, int y, const Mask& mask, const Colour& colour);

/// Puts thick lines on images of one size. 64 points of each pixel tell how much of it a line covers; where a line
/// overlaps itself it covers no more.
class StripPainter {
 public:
  void put(Image& image, const Strip& strip);

 private:
  void cover(const Image& image, Point a, Point b, Point c);

  std::vector<std::uint64_t> covered_;  // points of each pixel
  std::vector<std::size_t> touched_;    // pixels with some
};

}  // namespace gaussdrift::render
