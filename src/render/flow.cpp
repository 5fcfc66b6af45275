#include "render/flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/nan.hpp"
#include "base/sphere.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::render {

namespace {

double speed_of(const Point& u) { return std::hypot(u.x, u.y); }

/// Both sides of the head of an arrow that ends at `tip` in the direction (c, s).
std::vector<Point> head(const Point& tip, double c, double s, double length) {
  constexpr double across = 0.5;  // half the width, for a length of 1
  return {{tip.x - length * (c + across * s), tip.y - length * (s - across * c)},
          tip,
          {tip.x - length * (c - across * s), tip.y - length * (s + across * c)}};
}

}  // namespace

FlowPlane::FlowPlane(const DensityGrid& density, std::string_view name)
    : nx_(density.lattice.points[0]), ny_(density.lattice.points[1]) {
  const auto field = std::find_if(density.fields.begin(), density.fields.end(),
                                  [&](const FieldOnGrid& one) { return one.name == name; });
  if (field == density.fields.end() || field->components != 2 || field->values.size() != 2 * nx_ * ny_)
    throw Error(ExitCode::internal, fmt::format("the {} is not there to be drawn", name));
  values_ = field->values;
  // On a map of degrees a way to the east is the longer, the nearer it is to a pole.
  for (std::size_t j = 0; density.lattice.sphere > 0 && j < nx_ * ny_; ++j)
    values_[2 * j] /= std::cos(radians(density.lattice.coordinate(1, j / nx_)));
  for (std::size_t j = 0; j < values_.size(); j += 2)
    if (const double speed = std::hypot(values_[j], values_[j + 1]); speed > largest_ && std::isfinite(speed))
      largest_ = speed;
}

Point FlowPlane::at(const Point& place) const {
  using base::nan;
  if (!(place.x >= 0 && place.x <= width() && place.y >= 0 && place.y <= height())) return {nan, nan};
  const auto i = std::min(static_cast<std::size_t>(place.x), nx_ - 2);
  const auto j = std::min(static_cast<std::size_t>(place.y), ny_ - 2);
  const double a = place.x - static_cast<double>(i), b = place.y - static_cast<double>(j);
  const auto component = [&](std::size_t k) {
    const double* low = &values_[2 * (j * nx_ + i) + k];
    const double* high = low + 2 * nx_;
    return (1 - b) * ((1 - a) * low[0] + a * low[2]) + b * ((1 - a) * high[0] + a * high[2]);
  };
  return {component(0), component(1)};
}

std::vector<std::vector<Point>> arrows(const FlowPlane& flow, int along) {
  std::vector<std::vector<Point>> list;
  const double cell = std::max(flow.width(), flow.height()) / along, longest = flow.largest_speed();
  if (!(longest > 0) || flow.width() == 0 || flow.height() == 0) return list;
  const int columns = std::max(1, static_cast<int>(flow.width() / cell + 0.5)),
            rows = std::max(1, static_cast<int>(flow.height() / cell + 0.5));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Point middle{(i + 0.5) * flow.width() / columns, (j + 0.5) * flow.height() / rows};
      const Point u = flow.at(middle);
      const double speed = speed_of(u), length = 0.9 * cell * speed / longest;
      if (!(speed > 0) || !std::isfinite(speed) || length < 0.03 * cell) continue;
      const double c = u.x / speed, s = u.y / speed;
      const Point tail{middle.x - length / 2 * c, middle.y - length / 2 * s},
          tip{middle.x + length / 2 * c, middle.y + length / 2 * s};
      std::vector<Point> arrow{tail, tip};
      for (const Point& p : head(tip, c, s, std::min(0.3 * cell, 0.5 * length))) arrow.push_back(p);
      list.push_back(std::move(arrow));
    }
  return list;
}

namespace {

/// Lines are seeded and ended by the distance from those that are there [JL97].
class Streamlines {
 public:
  Streamlines(const FlowPlane& flow, double apart)
      : flow_(flow),
        apart_(apart),
        columns_(static_cast<std::size_t>(flow.width() / apart) + 2),
        rows_(static_cast<std::size_t>(flow.height() / apart) + 2),
        cells_(columns_ * rows_) {}

  std::vector<std::vector<Point>> all() {
    std::vector<std::vector<Point>> list;
    for (double y = apart_ / 2; y < flow_.height(); y += apart_)
      for (double x = apart_ / 2; x < flow_.width(); x += apart_) {
        if (!is_free({x, y}, apart_)) continue;
        std::vector<Point> line = through({x, y});
        if (static_cast<double>(line.size()) * step < 3 * apart_) continue;
        for (const Point& p : line) cells_[cell_of(p)].push_back(p);
        std::vector<Point> arrow = arrow_of(line);
        list.push_back(std::move(line));
        list.push_back(std::move(arrow));
      }
    return list;
  }

 private:
  static constexpr double step = 0.5;  // between points of a line, in spacings of the lattice

  std::size_t cell_of(const Point& p) const {
    return static_cast<std::size_t>(p.x / apart_) + columns_ * static_cast<std::size_t>(p.y / apart_);
  }

  bool is_free(const Point& p, double distance) const {
    const auto column = static_cast<std::int64_t>(p.x / apart_), row = static_cast<std::int64_t>(p.y / apart_);
    for (std::int64_t j = std::max<std::int64_t>(0, row - 1); j <= row + 1; ++j)
      for (std::int64_t i = std::max<std::int64_t>(0, column - 1); i <= column + 1; ++i) {
        if (i >= static_cast<std::int64_t>(columns_) || j >= static_cast<std::int64_t>(rows_)) continue;
        for (const Point& other : cells_[static_cast<std::size_t>(i) + columns_ * static_cast<std::size_t>(j)])
          if (std::hypot(other.x - p.x, other.y - p.y) < distance) return false;
      }
    return true;
  }

  /// The unit vector along the flow; NaN where it stands still or is not known.
  Point direction(const Point& p) const {
    const Point u = flow_.at(p);
    const double speed = speed_of(u);
    const double scale = speed > 1e-6 * flow_.largest_speed() ? 1 / speed : NAN;
    return {scale * u.x, scale * u.y};
  }

  std::vector<Point> one_way(const Point& from, double sense) const {
    std::vector<Point> line;
    Point p = from;
    const auto most = static_cast<std::size_t>(4 * (flow_.width() + flow_.height()) / step);
    while (line.size() < most) {
      const Point a = direction(p), half{p.x + sense * step / 2 * a.x, p.y + sense * step / 2 * a.y};
      const Point b = direction(half), next{p.x + sense * step * b.x, p.y + sense * step * b.y};
      const Point there = flow_.at(next);
      if (!std::isfinite(there.x) || !std::isfinite(there.y) || !is_free(next, apart_ / 2)) break;
      p = next;
      line.push_back(p);
      // Round once: a closed line ends where it began.
      if (line.size() * step > 2 * apart_ && std::hypot(p.x - from.x, p.y - from.y) < 0.75 * step) break;
    }
    return line;
  }

  std::vector<Point> through(const Point& seed) const {
    const Point u = flow_.at(seed);
    if (!(speed_of(u) > 0)) return {};
    std::vector<Point> line = one_way(seed, -1);
    const bool closed = !line.empty() && std::hypot(line.back().x - seed.x, line.back().y - seed.y) < 0.75 * step;
    std::reverse(line.begin(), line.end());
    line.push_back(seed);
    if (closed) return line;
    for (const Point& p : one_way(seed, 1)) line.push_back(p);
    return line;
  }

  std::vector<Point> arrow_of(const std::vector<Point>& line) const {
    const Point& middle = line[line.size() / 2];
    const Point along = direction(middle);
    return head(middle, along.x, along.y, apart_ / 2);
  }

  const FlowPlane& flow_;
  double apart_;
  std::size_t columns_, rows_;
  std::vector<std::vector<Point>> cells_;  // points of lines, by place
};

}  // namespace

std::vector<std::vector<Point>> streamlines(const FlowPlane& flow, double apart) {
  if (!(flow.largest_speed() > 0) || flow.width() == 0 || flow.height() == 0) return {};
  return Streamlines(flow, apart).all();
}

}  // namespace gaussdrift::render
