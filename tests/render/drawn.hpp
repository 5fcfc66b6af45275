// A density as a picture, read back.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <set>

#include "render/read_png.hpp"
#include "render/styles.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::render {

inline Image drawn(const Style& style, const DensityGrid& density, const PictureOptions& options = {}) {
  const ScratchFolder folder;
  draw(style, density, options, folder / "p.png");
  EXPECT_EQ(folder.count(), 1u);
  return read_png(folder / "p.png");
}

inline std::size_t colours_of(const Image& image) {
  return std::set<Colour>(image.pixels.begin(), image.pixels.end()).size();
}

}  // namespace gaussdrift::render
