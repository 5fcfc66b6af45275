// Pictures as PNG files. [PNG25]
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "render/image.hpp"

namespace gaussdrift::render {

/// A PNG of 8-bit red, green, blue, and opacity where the image has it. Quick rather than as small as can be.
std::string png_of(const Image& image);

/// A part of a PNG file: length, type of four letters, data, check sum.
std::string png_chunk(std::string_view type, std::string_view data);

/// Size, depth and kind of the pixels: the first part.
std::string png_header(int width, int height, bool with_opacity);

constexpr std::string_view png_signature{"\x89PNG\r\n\x1a\n", 8};

/// Four bytes, the highest first.
std::string big_endian(std::size_t number);

/// The compressed pixels of the part of an image from (left, bottom) on, as the data of a part.
std::string png_pixels(const Image& image, int left, int bottom, int columns, int rows);

}  // namespace gaussdrift::render
