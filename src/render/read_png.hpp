// Pictures read back, to look at what was drawn.
#pragma once

#include <filesystem>

#include "render/drawing.hpp"

namespace gaussdrift::render {

/// A PNG of 8-bit red, green, blue. Throws FileError.
Image read_png(const std::filesystem::path& file);

}  // namespace gaussdrift::render
