// The library that draws: loaded for the first picture, until the process ends.
#pragma once

#include <string>

#include "render/drawing.hpp"

namespace gaussdrift::render {

/// Empty if pictures can be drawn, else the reason and the remedy. Looked at once. Throws Error (exit code 3) where memory
/// is too short for it.
const std::string& missing_drawing();

/// Throws Error(ExitCode::internal) where pictures cannot be drawn.
Drawing& drawing();

}  // namespace gaussdrift::render
