// What all pictures have around the density: heading, axes, colour bar. Sizes are those of a picture of 1280 x 960
// pixels and grow with it.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "render/canvas.hpp"
#include "render/height_field.hpp"
#include "render/picture.hpp"
#include "render/ticks.hpp"

namespace gaussdrift::render {

/// Sizes relative to a picture of 1280 x 960.
class Scale {
 public:
  explicit Scale(const Canvas& canvas);
  explicit Scale(double unit) : unit_(unit) {}
  double operator()(double length) const { return unit_ * length; }
  int font(int size) const;

 private:
  double unit_;
};

/// A stretch of true values with its name; `name` goes through Ticks::title.
struct Axis {
  std::string name;
  double min = 0, max = 1;
  Ticks ticks;
  bool log = false;  // by the logarithm; 0 < min

  Axis(std::string what, double from, double to, int intervals)
      : name(std::move(what)), min(from), max(to), ticks(make_ticks(from, to, intervals)) {}
  double position(double at) const { return log ? std::log(at / min) / std::log(max / min) : (at - min) / (max - min); }
  std::string title() const { return ticks.title(name); }
};

/// An axis with at least two ticks if the numbers allow it: short sides get finer ones.
Axis short_axis(const std::string& name, double min, double max, int intervals);

/// The axis of values, with powers of ten where the range is by the logarithm.
Axis value_axis(const std::string& quantity, const ColourRange& range, int intervals);

/// k, if every k-th tick of an axis gets its number and no two numbers come nearer than `gap`. `numbers` has the places
/// of all numbers. Ticks keep their marks.
std::size_t numbered_ticks(const std::vector<Rectangle>& numbers, double gap);

/// Title, time, and the extremes of the density, which colours alone do not tell.
void draw_heading(Canvas& canvas, const PictureOptions& options, const ValueFacts& facts);

/// Axes with numbers along the lower and left side of a plane panel.
void draw_axes(Canvas& canvas, const Rectangle& panel, const Axis& across, const Axis& upwards);

/// `marks`: positions at which lines are drawn across the bar. `map`: the colours.
void draw_colour_bar(Canvas& canvas, const Rectangle& bar, bool upwards, const Axis& axis,
                     const std::vector<double>& marks, Colour (*map)(double) = viridis);

}  // namespace gaussdrift::render
