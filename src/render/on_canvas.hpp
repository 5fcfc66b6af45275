// A picture from nothing to its file.
#pragma once

#include <filesystem>
#include <functional>

#include "render/canvas.hpp"

namespace gaussdrift::render {

/// Makes a canvas, lets `paint` fill it, and writes the PNG beside its name and renames it. One call draws at a time,
/// whatever the thread. Throws FileError; Error(ExitCode::internal) when drawing is not available or the size is not
/// possible.
void on_canvas(int width, int height, const std::filesystem::path& png, const std::function<void(Canvas&)>& paint);

}  // namespace gaussdrift::render
