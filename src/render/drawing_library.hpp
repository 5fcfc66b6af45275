// The library that draws: loaded for the first picture, until the process ends.
#pragma once

#include <mutex>
#include <string>

#include "render/drawing.hpp"

namespace gaussdrift::render {

/// Empty if pictures can be drawn, else the reason and the remedy. Looked at once. Throws Error (exit code 3) where memory
/// is too short for it.
const std::string& missing_drawing();

/// Throws Error(ExitCode::internal) where pictures cannot be drawn. Whoever calls what it has, or has one of its scenes,
/// holds drawing_mutex().
Drawing& drawing();

/// VTK and GLEW share their state between all windows. The same thread may lock it again.
std::recursive_mutex& drawing_mutex();

}  // namespace gaussdrift::render
