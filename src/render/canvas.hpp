// A white picture in pixels, the origin at the lower left: lines, areas, images and text, with a scene in three
// dimensions behind them if wanted. Later things cover earlier ones.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/colour.hpp"
#include "render/drawing.hpp"

namespace gaussdrift::render {

struct Rectangle {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double top() const { return y + height; }
};

struct Polyline {
  std::vector<Point> points;
  Colour colour = ink;
};

class Canvas {
 public:
  Canvas(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  /// For what is drawn in three dimensions.
  Sheet& scene() { return *sheet_; }

  void lines(const std::vector<Polyline>& list, double line_width);
  void line(Point from, Point to, const Colour& colour, double line_width) {
    lines({{{from, to}, colour}}, line_width);
  }
  void frame(const Rectangle& box, const Colour& colour, double line_width);
  void area(const Rectangle& box, const Colour& colour);
  /// columns x rows colours from the lower left, x fastest; one pixel each.
  void image(int left, int bottom, int columns, int rows, const std::vector<Colour>& colours);
  void text(Point at, const std::string& text, const TextStyle& style);
  /// Width of a text in pixels.
  static double text_width(const std::string& text, int size);

  /// The finished picture as a PNG file in memory.
  std::string png();

 private:
  int width_, height_;
  std::unique_ptr<Sheet> sheet_;
};

}  // namespace gaussdrift::render
