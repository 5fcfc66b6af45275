#include "reproduce/box_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "render/on_canvas.hpp"
#include "reproduce/neighbour_boxes.hpp"

namespace gaussdrift::reproduce {

namespace {

using render::Across;
using render::Along;
using render::Canvas;
using render::Colour;
using render::Point;
using render::Rectangle;

constexpr Colour turquoise{150, 220, 214}, light_green{205, 232, 180}, red{190, 40, 40};
constexpr int title_size = 26, text_size = 22, small = 18;

/// Boxes on a part of a canvas, with box (0, ..., 0) at the lower left.
struct Raster {
  Point corner;
  double side = 0;  // of a box, in pixels
  BoxIndices along;

  Rectangle whole() const { return {corner.x, corner.y, side * along[0], side * along[1]}; }
  Rectangle box(int i, int j) const { return {corner.x + side * i, corner.y + side * j, side, side}; }
  Rectangle box(std::size_t number) const {
    const auto columns = static_cast<std::size_t>(along[0]);
    return box(static_cast<int>(number % columns), static_cast<int>(number / columns));
  }
};

Point middle(const Rectangle& box) { return {box.x + box.width / 2, box.y + box.height / 2}; }

void lines_of(Canvas& canvas, const Raster& raster) {
  for (int j = 0; j < raster.along[1]; ++j)
    for (int i = 0; i < raster.along[0]; ++i) canvas.frame(raster.box(i, j), render::ink, 1.5);
}

/// A point with its name beside it.
void name_point(Canvas& canvas, Point at, const std::string& name) {
  constexpr double radius = 4;
  canvas.area({at.x - radius, at.y - radius, 2 * radius, 2 * radius}, render::ink);
  canvas.text({at.x + 12, at.y - 12}, name, {.size = text_size, .across = Across::left, .along = Along::top});
}

void title(Canvas& canvas, const std::string& text) {
  canvas.text({canvas.width() / 2.0, canvas.height() - 40.0}, text, {.size = title_size});
}

}  // namespace

void draw_box_with_its_corners(const std::filesystem::path& png) {
  render::on_canvas(960, 720, png, [](Canvas& canvas) {
    title(canvas, "A box B, spanned by lo and hi");
    const Rectangle box{180, 120, 560, 460};
    canvas.frame(box, render::ink, 2.5);
    name_point(canvas, {box.x, box.y}, "lo");
    name_point(canvas, {box.right(), box.top()}, "hi");
    name_point(canvas, middle(box), "c");
    name_point(canvas, {box.x + 0.72 * box.width, box.y + 0.27 * box.height}, "x");
    canvas.text({box.x + 24, box.top() - 24}, "B", {.size = title_size, .across = Across::left, .along = Along::top});
  });
}

void draw_numbered_boxes(const std::filesystem::path& png) {
  render::on_canvas(960, 720, png, [](Canvas& canvas) {
    title(canvas, "A bounding box (red), cut into subboxes");
    const Raster raster{{130, 100}, 104, {7, 5}};
    lines_of(canvas, raster);
    for (int j = 0; j < raster.along[1]; ++j)
      for (int i = 0; i < raster.along[0]; ++i) {
        const Rectangle box = raster.box(i, j);
        canvas.text(middle(box), fmt::format("{}", box_number({i, j}, raster.along)), {.size = title_size});
        canvas.text({box.right() - 18, box.y + 6}, fmt::format("{}, {}", i, j),
                    {.size = 15, .across = Across::right, .along = Along::bottom, .colour = {90, 90, 90}});
      }
    // Its sides are no multiples of the boxes' side: the last boxes reach beyond it.
    const Rectangle all = raster.whole();
    canvas.frame({all.x, all.y, all.width - 0.12 * raster.side, all.height - 0.2 * raster.side}, red, 4);
  });
}

void draw_neighbours(const std::filesystem::path& png) {
  render::on_canvas(1280, 1000, png, [](Canvas& canvas) {
    title(canvas, "Neighbour boxes of the box B");
    const BoxIndices along{7, 5}, of{3, 1};
    for (int panel = 0; panel < 4; ++panel) {
      const Raster raster{{70.0 + 610 * (panel % 2), 530.0 - 460 * (panel / 2)}, 76, along};
      const std::vector<std::size_t> found = neighbour_boxes(panel, of, along);
      for (const std::size_t number : found) canvas.area(raster.box(number), turquoise);
      lines_of(canvas, raster);
      canvas.text(middle(raster.box(of[0], of[1])), "B", {.size = title_size});
      const Rectangle all = raster.whole();
      canvas.text(
          {all.x + all.width / 2, all.y - 12},
          fmt::format("n {} {}: {} box{}", panel == 3 ? "≥" : "=", panel, found.size(), found.size() == 1 ? "" : "es"),
          {.size = text_size, .along = Along::top});
    }
  });
}

void draw_recursion(const std::filesystem::path& png) {
  render::on_canvas(960, 700, png, [](Canvas& canvas) {
    title(canvas, "The order in which the neighbours of B are found, n = 2");
    const BoxIndices along{7, 4}, of{1, 2};
    const Raster raster{{116, 130}, 104, along};
    const std::vector<std::size_t> found = neighbour_boxes(2, of, along);
    for (const std::size_t number : found) canvas.area(raster.box(number), turquoise);
    for (int j = 0; j < along[1]; ++j) canvas.area(raster.box(of[0], j), light_green);
    canvas.area(raster.box(of[0], of[1]), turquoise);
    lines_of(canvas, raster);
    for (std::size_t place = 0; place < found.size(); ++place) {
      const bool is_itself = found[place] == box_number(of, along);
      canvas.text(middle(raster.box(found[place])), is_itself ? "B" : fmt::format("{}", place), {.size = title_size});
    }
    canvas.text({raster.corner.x, 100},
                "First the second index moves (green, and B), then for each of its values the first one.",
                {.size = small, .across = Across::left, .along = Along::top});
  });
}

}  // namespace gaussdrift::reproduce
