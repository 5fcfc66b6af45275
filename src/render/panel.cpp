#include "render/panel.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include "render/on_canvas.hpp"
#include "render/picture.hpp"
#include "render/read_png.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {

namespace {

/// A file that is gone at the end, also where drawing fails.
struct Scratch {
  explicit Scratch(std::filesystem::path name) : file(std::move(name)) {}
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path file;
};

}  // namespace

void draw_panels(const std::vector<Panel>& panels, const std::filesystem::path& png) {
  constexpr int width = 640, height = 480;
  double low = 0, high = 0, low_error = 0, high_error = 0;
  for (const Panel& panel : panels)
    for (const double value : panel.density.rho) {
      double &least = panel.is_error ? low_error : low, &most = panel.is_error ? high_error : high;
      least = std::min(least, value), most = std::max(most, value);
    }
  const auto [range_min, range_max] = rounded_range(low, high);
  const auto [error_min, error_max] = symmetric_range(low_error, high_error);
  std::vector<Image> images;
  for (const Panel& panel : panels) {
    // A hidden file by its name (write/part_file.hpp), so that what a killed process leaves is removed; no other has two
    // numbers behind that of the process.
    const Scratch part(png.parent_path() / fmt::format(".gaussdrift-{}-0-0.part", getpid()));
    const Style& style = panel_style(panel.density.lattice.dimension, panel.is_error);
    draw(style, panel.density,
         {.title = panel.title,
          .quantity = style.quantity,
          .time = panel.time,
          .range_min = panel.is_error ? error_min : range_min,
          .range_max = panel.is_error ? error_max : range_max,
          .width = width,
          .height = height},
         part.file);
    images.push_back(read_png(part.file));
  }
  const int rows = (static_cast<int>(panels.size()) + 1) / 2, columns = panels.size() > 1 ? 2 : 1;
  on_canvas(columns * width, rows * height, png, [&](Canvas& canvas) {
    for (std::size_t i = 0; i < images.size(); ++i) {
      const int column = static_cast<int>(i) % 2, row = static_cast<int>(i) / 2;
      canvas.image(column * width, (rows - 1 - row) * height, width, height, images[i].pixels);
    }
  });
}

}  // namespace gaussdrift::render
