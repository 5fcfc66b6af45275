#include "render/label_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gaussdrift::render {

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.top() && b.y < a.top();
}

// By Liang and Barsky: the part of the piece that lies between two sides, then between the other two.
bool meets(const Rectangle& box, const Point& from, const Point& to) {
  double first = 0, last = 1;
  const auto cut = [&](double begin, double step, double low, double high) {
    if (step == 0) return begin > low && begin < high;
    const double a = (low - begin) / step, b = (high - begin) / step;
    first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
    return first < last;
  };
  return cut(from.x, to.x - from.x, box.x, box.right()) && cut(from.y, to.y - from.y, box.y, box.top());
}

bool LabelPlaces::is_free(const Rectangle& box) const {
  if (box.x < within_.x || box.right() > within_.right() || box.y < within_.y || box.top() > within_.top())
    return false;
  return std::none_of(boxes_.begin(), boxes_.end(), [&](const Rectangle& other) { return overlap(box, other); }) &&
         std::none_of(lines_.begin(), lines_.end(),
                      [&](const auto& line) { return meets(box, line.first, line.second); });
}

bool LabelPlaces::is_free(const Point& from, const Point& to) const {
  return std::none_of(boxes_.begin(), boxes_.end(), [&](const Rectangle& box) { return meets(box, from, to); });
}

std::optional<LabelPlaces::Found> LabelPlaces::place(const Point& at, const Wanted& wanted) {
  // Degrees from the right, upwards: the likely ones first.
  constexpr std::array to_the_right{0, 25, -25, 50, -50, 90, -90, 130, -130, 180};
  constexpr std::array around{0, 90, -90, 180, 30, -30, 150, -150, 60, -60, 120, -120};
  const auto beside = [&](double degrees, double distance) {
    const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
    const double along = std::clamp(1.6 * c, -1., 1.), up = std::clamp(1.6 * s, -1., 1.);
    const Point middle{at.x + distance * c + along * wanted.width / 2, at.y + distance * s + up * wanted.height / 2};
    return Rectangle{middle.x - wanted.width / 2, middle.y - wanted.height / 2, wanted.width, wanted.height};
  };
  const auto found_at = [&](double degrees, double distance) -> std::optional<Found> {
    Found found{beside(degrees, distance), {}};
    if (!is_free(found.box)) return std::nullopt;
    if (distance > 2.5 * wanted.gap) {  // the eye needs a line
      const Point to{std::clamp(at.x, found.box.x, found.box.right()), std::clamp(at.y, found.box.y, found.box.top())};
      const double part = wanted.gap / std::hypot(to.x - at.x, to.y - at.y);
      const Point from{at.x + part * (to.x - at.x), at.y + part * (to.y - at.y)};
      if (!is_free(from, to)) return std::nullopt;
      found.leader.emplace(from, to);
      take(from, to);
    }
    take(found.box);
    return found;
  };
  for (double distance = wanted.gap; distance <= wanted.furthest; distance *= 1.3) {
    if (wanted.rightwards) {
      for (const int degrees : to_the_right)
        if (auto found = found_at(degrees, distance)) return found;
    } else {
      for (const int degrees : around)
        if (auto found = found_at(degrees, distance)) return found;
    }
  }
  return std::nullopt;
}

}  // namespace gaussdrift::render
