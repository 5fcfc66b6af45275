// Pictures read back, to look at what was drawn.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "render/colour.hpp"

namespace gaussdrift::render {

struct Image {
  int width = 0, height = 0;
  std::vector<Colour> pixels;  // from the lower left, x fastest

  const Colour& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// A PNG of 8-bit red, green, blue. Throws FileError.
Image read_png(const std::filesystem::path& file);

}  // namespace gaussdrift::render
