// A white picture in pixels, the origin at the lower left: lines, areas, images and text, with a scene in three
// dimensions behind them if wanted. Later things cover earlier ones.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/colour.hpp"

class vtkRenderer;

namespace gaussdrift::render {

struct Point {
  double x = 0, y = 0;
};

struct Rectangle {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double top() const { return y + height; }
};

struct Polyline {
  std::vector<Point> points;
  Colour colour = ink;
};

/// Where a text sits relative to its point.
enum class Across { left, centre, right };  // the point is at the left end, centre, right end of the text
enum class Along { bottom, centre, top };

struct TextStyle {
  int size = 19;
  Across across = Across::centre;
  Along along = Along::centre;
  bool upwards = false;  // written from below to above
  Colour colour = ink;
};

class Canvas {
 public:
  Canvas(int width, int height);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  /// For what is drawn in three dimensions.
  vtkRenderer* scene() { return renderer_; }

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
  void add(void* actor);

  int width_, height_;
  int layer_ = 0;
  vtkRenderer* renderer_;
};

}  // namespace gaussdrift::render
