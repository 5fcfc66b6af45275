// Texts of pictures: drawn once, and kept for the next picture, which mostly has the same.
#pragma once

#include <memory>
#include <string>

#include "render/drawing.hpp"

namespace gaussdrift::render {

/// A text in one line, put where its point is. Bytes that are no UTF-8 become question marks.
std::shared_ptr<const Mask> text_mask(const std::string& text, const TextStyle& style);

/// In pixels.
double width_of_text(const std::string& text, int size);

}  // namespace gaussdrift::render
