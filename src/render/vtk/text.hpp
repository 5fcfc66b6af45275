// Lines of text, drawn by VTK with FreeType.
#pragma once

#include <string>

#include "render/drawing.hpp"

namespace gaussdrift::render {

bool has_own_font();

/// In pixels.
double width_of(const std::string& line, const TextStyle& style);

Mask mask_of(const std::string& line, const TextStyle& style);

}  // namespace gaussdrift::render
