// From an empty canvas to a picture, in memory or in its file.
#pragma once

#include <filesystem>
#include <functional>

#include "render/canvas.hpp"

namespace gaussdrift::render {

struct Background {
  bool transparent = false;
  double type = 1;  // how many times as large as usual letters, lines and margins are
};

/// Of pictures for slides.
constexpr double large_type = 1.5;

/// Makes a canvas and lets `paint` fill it. Several threads may do so; of pictures with scenes one is drawn at a time.
/// Throws CommandLineError as check_available(); Error(ExitCode::internal) when the size is not possible.
Image painted(int width, int height, const Background& background, const std::function<void(Canvas&)>& paint);

/// The same, written beside its name as a PNG and renamed. Throws FileError too.
void on_canvas(int width, int height, const std::filesystem::path& png, const std::function<void(Canvas&)>& paint);

}  // namespace gaussdrift::render
