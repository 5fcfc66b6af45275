// Where labels stand in a chart: beside what they name, and over nothing.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "render/canvas.hpp"

namespace gaussdrift::render {

bool overlap(const Rectangle& a, const Rectangle& b);
/// Whether a piece of a line enters a rectangle.
bool meets(const Rectangle& box, const Point& from, const Point& to);

class LabelPlaces {
 public:
  struct Wanted {
    double width = 0, height = 0;
    double gap = 0;           // between the point and the label
    double furthest = 0;      // the label may be so far away
    bool rightwards = false;  // first to the right of it, as at the end of a line
  };
  struct Found {
    Rectangle box;
    std::optional<std::pair<Point, Point>> leader;  // from the point to a label that is further away
  };

  /// Labels stay within `within`.
  explicit LabelPlaces(const Rectangle& within) : within_(within) {}

  void take(const Rectangle& box) { boxes_.push_back(box); }
  void take(const Point& from, const Point& to) { lines_.emplace_back(from, to); }

  /// The nearest place for the label of a point that is free of everything taken, and takes it.
  std::optional<Found> place(const Point& at, const Wanted& wanted);

 private:
  bool is_free(const Rectangle& box) const;
  bool is_free(const Point& from, const Point& to) const;  // of labels and marks

  Rectangle within_;
  std::vector<Rectangle> boxes_;
  std::vector<std::pair<Point, Point>> lines_;
};

}  // namespace gaussdrift::render
