#include "render/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gaussdrift::render {

View::View(Canvas& canvas, const Place& box, const Rectangle& room, const std::array<double, 2>& angles)
    : canvas_(canvas) {
  const double azimuth = angles[0] * std::numbers::pi / 180, elevation = angles[1] * std::numbers::pi / 180;
  sees_end_ = {std::cos(azimuth) > 0, std::sin(azimuth) > 0};
  const Place centre{box[0] / 2, box[1] / 2, box[2] / 2};
  double distance = 4;
  for (int round = 0; round < 8; ++round) {
    canvas.scene().look(
        {centre[0] + distance * std::cos(elevation) * std::cos(azimuth),
         centre[1] + distance * std::cos(elevation) * std::sin(azimuth), centre[2] + distance * std::sin(elevation)},
        centre);
    const Rectangle seen = extent(box);
    distance *= std::max(seen.width / room.width, seen.height / room.height);
  }
  const Rectangle seen = extent(box);
  canvas.scene().shift({2 * (seen.x + seen.width / 2 - room.x - room.width / 2) / canvas.width(),
                        2 * (seen.y + seen.height / 2 - room.y - room.height / 2) / canvas.height()});
}

Point View::pixel(const Place& place) const { return canvas_.scene().pixel(place); }

double View::depth(const Place& place) const { return canvas_.scene().depth(place); }

Rectangle View::extent(const Place& box) const {
  Point low{1e30, 1e30}, high{-1e30, -1e30};
  for (int corner = 0; corner < 8; ++corner) {
    const Point p = pixel({corner & 1 ? box[0] : 0, corner & 2 ? box[1] : 0, corner & 4 ? box[2] : 0});
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return {low.x, low.y, high.x - low.x, high.y - low.y};
}

void add_walls(Scene& scene, const View& view, const Place& box, const Axis& x, const Axis& y, const Axis& z,
               bool floor) {
  const auto [w, d, height] = box;
  // Behind, as seen; and in front.
  const double back_x = view.sees_end(0) ? 0 : w, front_x = w - back_x;
  const double back_y = view.sees_end(1) ? 0 : d, front_y = d - back_y;
  std::vector<std::vector<Place>> grid, walls{{{back_x, front_y, 0},
                                               {back_x, front_y, height},
                                               {back_x, back_y, height},
                                               {front_x, back_y, height},
                                               {front_x, back_y, 0},
                                               {back_x, back_y, 0},
                                               {back_x, front_y, 0},
                                               {front_x, front_y, 0},
                                               {front_x, back_y, 0}},
                                              {{back_x, back_y, 0}, {back_x, back_y, height}}};
  for (const Tick& t : x.ticks.list) {
    const double at = x.position(t.at) * w;
    grid.push_back({{at, back_y, 0}, {at, back_y, height}});
    if (floor) grid.push_back({{at, 0, 0}, {at, d, 0}});
  }
  for (const Tick& t : y.ticks.list) {
    const double at = y.position(t.at) * d;
    grid.push_back({{back_x, at, 0}, {back_x, at, height}});
    if (floor) grid.push_back({{0, at, 0}, {w, at, 0}});
  }
  for (const Tick& t : z.ticks.list) {
    const double level = z.position(t.at) * height;
    grid.push_back({{back_x, front_y, level}, {back_x, back_y, level}, {front_x, back_y, level}});
  }
  scene.lines(grid, pale_grey, 1);
  scene.lines(walls, grey, 1);
}

void draw_edge(Canvas& canvas, const View& view, const Axis& axis, const Place& from, const Place& to,
               const Place& out) {
  const Scale scale(canvas);
  const auto along = [&](double s) {
    return Place{from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1]), from[2] + s * (to[2] - from[2])};
  };
  const auto outwards = [&](const Place& p) {  // unit vector in the picture
    const Point here = view.pixel(p),
                there = view.pixel({p[0] + 0.01 * out[0], p[1] + 0.01 * out[1], p[2] + 0.01 * out[2]});
    const double length = std::hypot(there.x - here.x, there.y - here.y);
    return Point{(there.x - here.x) / length, (there.y - here.y) / length};
  };
  // Numbers are centred on a point beyond the tick, as far out as half of them reaches.
  const int size = scale.font(18), title_size = scale.font(21);
  const auto centre = [&](const Point& at, const Point& direction, double gap, double text_width, double text_height) {
    const double reach = gap + std::fabs(direction.x) * text_width / 2 + std::fabs(direction.y) * text_height / 2;
    return Point{at.x + reach * direction.x, at.y + reach * direction.y};
  };
  std::vector<Polyline> marks;
  std::vector<Point> texts;
  std::vector<Rectangle> numbers;
  double widest = 0;
  for (const Tick& t : axis.ticks.list) {
    const Place place = along(axis.position(t.at));
    const Point at = view.pixel(place), direction = outwards(place);
    const double tick = scale(8), width = Canvas::text_width(t.label, size);
    marks.push_back({{at, {at.x + tick * direction.x, at.y + tick * direction.y}}, ink});
    const Point text = centre(at, direction, scale(15), width, size);
    texts.push_back(text);
    numbers.push_back({text.x - width / 2, text.y - size / 2., width, 1. * size});
    widest = std::max(widest, width);
  }
  const std::size_t every = numbered_ticks(numbers, scale(2));
  for (std::size_t i = 0; i < texts.size(); i += every) canvas.text(texts[i], axis.ticks.list[i].label, {.size = size});
  canvas.lines(marks, 1.3);
  canvas.line(view.pixel(from), view.pixel(to), ink, 1.3);
  const Place middle = along(0.5);
  const Point at = view.pixel(middle), direction = outwards(middle);
  const bool upwards = std::fabs(to[2] - from[2]) > 0;
  const double width = upwards ? title_size : Canvas::text_width(axis.title(), title_size);
  const double beyond = scale(15 + 16) + std::fabs(direction.x) * widest + std::fabs(direction.y) * size;
  canvas.text(centre(at, direction, beyond, width, title_size), axis.title(), {.size = title_size, .upwards = upwards});
}

Rectangle bar_beside_scene(const Canvas& canvas) {
  const Scale scale(canvas);
  const double heading_and_title = scale(96 + 60),
               height = std::min(scale(460), canvas.height() - 2 * heading_and_title);
  return {canvas.width() - scale(134), (canvas.height() - height) / 2, scale(26), height};
}

void draw_edges(Canvas& canvas, const View& view, const Place& box, const Axis& x, const Axis& y, const Axis& z) {
  const auto [w, d, height] = box;
  const double near_x = view.sees_end(0) ? w : 0, near_y = view.sees_end(1) ? d : 0;
  const double out_x = view.sees_end(0) ? 1 : -1, out_y = view.sees_end(1) ? 1 : -1;
  draw_edge(canvas, view, x, {0, near_y, 0}, {w, near_y, 0}, {0, out_y, 0});
  draw_edge(canvas, view, y, {near_x, 0, 0}, {near_x, d, 0}, {out_x, 0, 0});
  // Of the two edges that are seen beside what is in the box, the left one.
  const Place one{w - near_x, near_y, 0}, other{near_x, d - near_y, 0};
  const bool first = view.pixel(one).x < view.pixel(other).x;
  const auto [at_x, at_y, ground] = first ? one : other;
  draw_edge(canvas, view, z, {at_x, at_y, ground}, {at_x, at_y, height},
            first ? Place{-out_x, 0, 0} : Place{0, -out_y, 0});
}

}  // namespace gaussdrift::render
