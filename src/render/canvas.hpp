// A white picture in pixels, the origin at the lower left: lines, areas, images and text, with a scene in three
// dimensions behind them if wanted. Later things cover earlier ones. Only the scene needs OpenGL.
#pragma once

#include <memory>
#include <mutex>
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
  /// `type`: how many times as large as usual letters, lines and margins are.
  Canvas(int width, int height, bool transparent = false, double type = 1)
      : width_(width), height_(height), type_(type), image_(blank_image(width, height, transparent)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  double type() const { return type_; }
  /// For what is drawn in three dimensions.
  Scene& scene();
  /// Puts it on the picture, with all that is in it. Throws Error(ExitCode::internal).
  void show_scene();

  void lines(const std::vector<Polyline>& list, double line_width);
  void line(Point from, Point to, const Colour& colour, double line_width) {
    lines({{{from, to}, colour}}, line_width);
  }
  void frame(const Rectangle& box, const Colour& colour, double line_width);
  /// A convex one, its corners in order.
  void polygon(const std::vector<Point>& corners, const Colour& colour);
  void area(const Rectangle& box, const Colour& colour);
  /// columns x rows colours from the lower left, x fastest; one pixel each.
  void image(int left, int bottom, int columns, int rows, const std::vector<Colour>& colours);
  void text(Point at, const std::string& text, const TextStyle& style);
  /// Width of a text in pixels.
  static double text_width(const std::string& text, int size);

  /// The picture.
  const Image& picture() const { return image_; }

 private:
  int width_, height_;
  double type_;
  Image image_;
  StripPainter strips_;
  std::unique_lock<std::recursive_mutex> lock_;  // of the drawing library, as long as there is a scene
  std::unique_ptr<Scene> scene_;
};

}  // namespace gaussdrift::render
