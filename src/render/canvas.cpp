#include "render/canvas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "gaussdrift/error.hpp"
#include "render/drawing_library.hpp"
#include "render/text.hpp"

namespace gaussdrift::render {
namespace {

/// Where the middle of an upright or level line has to be so that the line fills whole pixels.
double on_grid(double x, double line_width) {
  const bool odd = static_cast<long>(std::max(1., std::round(line_width))) % 2 == 1;
  return odd ? std::floor(x) + 0.5 : std::round(x);
}

std::vector<Point> crisp(std::vector<Point> segment, double line_width) {
  if (segment[0].x == segment[1].x) segment[0].x = segment[1].x = on_grid(segment[0].x, line_width);
  if (segment[0].y == segment[1].y) segment[0].y = segment[1].y = on_grid(segment[0].y, line_width);
  return segment;
}

/// The two edges of a thick line: the points moved by `half` at right angles, mitred at bends. Lines of OpenGL have
/// gaps there.
std::pair<std::vector<Point>, std::vector<Point>> edges(const std::vector<Point>& line, double half) {
  std::vector<Point> way;
  for (const Point& p : line)
    if (way.empty() || std::hypot(p.x - way.back().x, p.y - way.back().y) > 1e-3) way.push_back(p);
  std::vector<Point> left, right;
  if (way.size() < 2) return {left, right};
  const std::size_t last = way.size() - 1;
  const bool closed = last > 2 && std::hypot(way[0].x - way[last].x, way[0].y - way[last].y) < 1e-2;
  const auto normal = [&](std::size_t i) {  // of the piece from point i to the next
    const double dx = way[i + 1].x - way[i].x, dy = way[i + 1].y - way[i].y, length = std::hypot(dx, dy);
    return Point{-dy / length, dx / length};
  };
  for (std::size_t i = 0; i <= last; ++i) {
    const Point before = normal(i > 0    ? i - 1
                                : closed ? last - 1
                                         : 0),
                after = normal(i < last ? i
                               : closed ? 0
                                        : last - 1);
    const double cosine = before.x * after.x + before.y * after.y;
    const double stretch = half / std::max(1 + cosine, 0.25);  // spikes are cut
    const Point out{stretch * (before.x + after.x), stretch * (before.y + after.y)};
    left.push_back({way[i].x + out.x, way[i].y + out.y});
    right.push_back({way[i].x - out.x, way[i].y - out.y});
  }
  return {left, right};
}

}  // namespace

Scene& Canvas::scene() {
  if (!scene_) {
    lock_ = std::unique_lock(drawing_mutex());
    scene_ = drawing().scene(width_, height_);
  }
  return *scene_;
}

void Canvas::show_scene() {
  try {
    const bool transparent = !image_.opacity.empty();
    image_ = scene().image();
    if (!transparent) image_.opacity.clear();
  } catch (const std::runtime_error& error) {
    throw Error(ExitCode::internal, fmt::format("VTK could not draw the picture: {}", error.what()));
  }
}

void Canvas::lines(const std::vector<Polyline>& list, double line_width) {
  for (const Polyline& line : list) {
    const std::vector<Point> way = line.points.size() == 2 ? crisp(line.points, line_width) : line.points;
    auto [left, right] = edges(way, line_width / 2);
    if (left.size() > 1) strips_.put(image_, {std::move(left), std::move(right), line.colour});
  }
}

void Canvas::frame(const Rectangle& box, const Colour& colour, double line_width) {
  const double low_x = on_grid(box.x, line_width), high_x = on_grid(box.right(), line_width);
  const double low_y = on_grid(box.y, line_width), high_y = on_grid(box.top(), line_width);
  lines({{{{low_x, low_y}, {high_x, low_y}, {high_x, high_y}, {low_x, high_y}, {low_x, low_y}}, colour}},
        std::max(1., std::round(line_width)));
}

void Canvas::polygon(const std::vector<Point>& corners, const Colour& colour) {
  if (corners.empty()) return;
  strips_.put(image_, {std::vector<Point>(corners.size(), corners.front()), corners, colour});
}

void Canvas::area(const Rectangle& box, const Colour& colour) {
  const int left = static_cast<int>(std::lround(box.x)), bottom = static_cast<int>(std::lround(box.y));
  const int columns = std::max(1, static_cast<int>(std::lround(box.width))),
            rows = std::max(1, static_cast<int>(std::lround(box.height)));
  image(left, bottom, columns, rows,
        std::vector<Colour>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), colour));
}

void Canvas::image(int left, int bottom, int columns, int rows, const std::vector<Colour>& colours) {
  put_colours(image_, left, bottom, columns, rows, colours);
}

void Canvas::text(Point at, const std::string& text, const TextStyle& style) {
  const auto mask = text_mask(text, style);
  put_mask(image_, static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)), *mask, style.colour);
}

double Canvas::text_width(const std::string& text, int size) { return width_of_text(text, size); }

}  // namespace gaussdrift::render
