#include "render/image.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gaussdrift::render {

namespace {

std::size_t index_of(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

/// `cover` of 255.
void blend(Image& image, std::size_t pixel, const Colour& colour, unsigned cover) {
  if (cover == 0) return;
  const auto mixed = [cover](unsigned from, unsigned to) {
    return static_cast<std::uint8_t>(((255 - cover) * from + cover * to + 127) / 255);
  };
  Colour& there = image.pixels[pixel];
  for (std::size_t k = 0; k < 3; ++k) there[k] = mixed(there[k], colour[k]);
  if (!image.opacity.empty()) image.opacity[pixel] = mixed(image.opacity[pixel], 255);
}

}  // namespace

Image blank_image(int width, int height, bool transparent) {
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return {width, height, std::vector<Colour>(count, white), std::vector<std::uint8_t>(transparent ? count : 0, 0)};
}

void put_colours(Image& image, int left, int bottom, int columns, int rows, const std::vector<Colour>& colours) {
  const int from = std::max(0, -left), to = std::min(columns, image.width - left);
  if (from >= to) return;
  for (int j = std::max(0, -bottom); j < std::min(rows, image.height - bottom); ++j) {
    const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(columns);
    const std::size_t first = index_of(image, left + from, bottom + j), count = static_cast<std::size_t>(to - from);
    std::copy_n(colours.begin() + static_cast<std::ptrdiff_t>(row + static_cast<std::size_t>(from)), count,
                image.pixels.begin() + static_cast<std::ptrdiff_t>(first));
    if (!image.opacity.empty())
      std::fill_n(image.opacity.begin() + static_cast<std::ptrdiff_t>(first), count, std::uint8_t{255});
  }
}

void put_mask(Image& image, int x, int y, const Mask& mask, const Colour& colour) {
  const int left = x + mask.left, bottom = y + mask.bottom;
  for (int j = std::max(0, -bottom); j < std::min(mask.height, image.height - bottom); ++j)
    for (int i = std::max(0, -left); i < std::min(mask.width, image.width - left); ++i)
      blend(
          image, index_of(image, left + i, bottom + j), colour,
          mask.cover[static_cast<std::size_t>(j) * static_cast<std::size_t>(mask.width) + static_cast<std::size_t>(i)]);
}

void StripPainter::put(Image& image, const Strip& strip) {
  covered_.resize(image.pixels.size());
  for (std::size_t i = 1; i < strip.left.size(); ++i) {
    cover(image, strip.left[i - 1], strip.right[i - 1], strip.right[i]);
    cover(image, strip.left[i - 1], strip.right[i], strip.left[i]);
  }
  for (const std::size_t pixel : touched_) {
    blend(image, pixel, strip.colour, (255u * static_cast<unsigned>(std::popcount(covered_[pixel])) + 32) / 64);
    covered_[pixel] = 0;
  }
  touched_.clear();
}

// The points of a pixel lie in the middles of its 8 x 8 parts. Row by row of points the triangle is an interval.
void StripPainter::cover(const Image& image, Point a, Point b, Point c) {
  constexpr int parts = 8;
  const auto first_at = [](double at) { return std::ceil(at * parts - 0.5); };  // point at or after a coordinate
  const double low = std::min({a.y, b.y, c.y}), high = std::max({a.y, b.y, c.y});
  if (!(std::isfinite(low) && std::isfinite(high))) return;
  const auto rows = static_cast<double>(parts) * image.height, columns = static_cast<double>(parts) * image.width;
  const auto last = static_cast<long>(std::min(rows, first_at(high)));
  for (auto row = static_cast<long>(std::max(0., first_at(low))); row < last; ++row) {
    const double y = (static_cast<double>(row) + 0.5) / parts;
    double from = image.width, to = 0;
    for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}}) {
      if ((p.y <= y) == (q.y <= y)) continue;
      const double x = p.x + (y - p.y) / (q.y - p.y) * (q.x - p.x);
      from = std::min(from, x), to = std::max(to, x);
    }
    auto column = static_cast<long>(std::clamp(first_at(from), 0., columns));
    const auto end = static_cast<long>(std::clamp(first_at(to), 0., columns));
    while (column < end) {
      const long pixel = column / parts, next = std::min(end, (pixel + 1) * parts);
      const auto bits = ((std::uint64_t{1} << (next - column)) - 1) << (column % parts + parts * (row % parts));
      const std::size_t at = index_of(image, static_cast<int>(pixel), static_cast<int>(row / parts));
      if (covered_[at] == 0) touched_.push_back(at);
      covered_[at] |= bits;
      column = next;
    }
  }
}

}  // namespace gaussdrift::render
