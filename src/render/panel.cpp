#include "render/panel.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "render/on_canvas.hpp"
#include "render/picture.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {

void draw_panels(const std::vector<Panel>& panels, const std::filesystem::path& png) {
  constexpr int width = 640, height = 480;
  std::map<std::string, std::pair<double, double>> extremes;  // of each quantity, 0 among them
  for (const Panel& panel : panels) {
    auto& [low, high] = extremes[panel.quantity];
    for (const double value : panel.density.rho) low = std::min(low, value), high = std::max(high, value);
  }
  std::vector<Image> images;
  for (const Panel& panel : panels) {
    const Style& style = panel_style(panel.density.lattice.dimension, panel.is_difference);
    const auto [low, high] = extremes[panel.quantity];
    const auto [range_min, range_max] = panel.is_difference ? symmetric_range(low, high) : rounded_range(low, high);
    const PictureOptions options{.title = panel.title,
                                 .quantity = panel.quantity,
                                 .time = panel.time,
                                 .date = panel.date,
                                 .planes = panel.planes,
                                 .range_min = range_min,
                                 .range_max = range_max,
                                 .width = width,
                                 .height = height};
    if (panel.lines.empty()) {
      images.push_back(picture_of(style, panel.density, options));
      continue;
    }
    images.push_back(painted(width, height, {}, [&](Canvas& canvas) {
      draw_lines_over(canvas, panel.density, panel.lines, {options.range_min, options.range_max}, options);
    }));
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
