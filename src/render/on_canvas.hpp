// From an empty canvas to the file of a picture.
#pragma once

#include <filesystem>
#include <functional>

#include "render/canvas.hpp"

namespace gaussdrift::render {

/// Makes a canvas, lets `paint` fill it, and writes the PNG beside its name and renames it. One call draws at a time,
/// whatever the thread. Throws FileError; CommandLineError as check_available(); Error(ExitCode::internal) when the size is
/// not possible.
void on_canvas(int width, int height, const std::filesystem::path& png, const std::function<void(Canvas&)>& paint);

}  // namespace gaussdrift::render
