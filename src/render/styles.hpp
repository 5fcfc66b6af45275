// The catalogue of picture styles. A style is one object: its name and meaning, the densities it shows, the range and
// colours of its values, and its painter. To add one: its file, its line in styles.cpp, its line in CMakeLists.txt.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/catalogue.hpp"
#include "gaussdrift/case.hpp"
#include "render/colour.hpp"
#include "render/picture.hpp"

namespace gaussdrift::render {

class Canvas;

/// Paints a whole picture, heading and colour bar included, and owns what the canvas looks into until it is finished.
using Painting = std::function<void(Canvas&)>;

/// What a picture takes, for predictions: user and system seconds of runs with six outputs and one style, less those of
/// the same runs without pictures, on grids of 60^2 to 1000^2 and 40^3 to 160^3 points; one core of an Intel Xeon with
/// AVX-512, VTK 9.1 with OSMesa. A map of 1280 x 960 pixels costs about the same whatever it shows, and a scene what its
/// triangles cost. The model is right within 0.03 s for each picture that was measured.
struct Cost {
  double seconds = 0.03;
  double a_point = 0, a_point_in_space = 0;                           // seconds for each point of the grid
  std::size_t most_points = std::numeric_limits<std::size_t>::max();  // that are drawn
  double bytes = 1.2e5;
  // Memory: libraries that stay once they have drawn, and bytes a pixel of a scene, which is drawn at twice the size.
  double memory = 1e8, memory_of_pixel = 0;
};

struct Style {
  PictureStyle about;
  std::string quantity = "density";  // what the colours show
  Colour (*colours)(double) = viridis;
  std::pair<double, double> (*range)(double, double) = rounded_range;  // round ends for smallest and largest value
  Cost cost{};
  bool in_panels = false;       // legible as a small picture among others: the summary of a run is drawn in it
  bool white_at_zero = false;   // of values of both signs, unless the case names a map: blue, white and red
  bool takes_velocity = false;  // looks.velocity is drawn over it, in 2D
  /// The density must live until the painting is done. Throws Error(ExitCode::internal) for a density that the style
  /// does not show, or that has no value at some point.
  Painting (*painting)(const DensityGrid&, const ColourRange&, const PictureOptions&) = nullptr;
};

/// In the order of docs/cases.md.
const std::vector<Style>& styles();

std::vector<std::string> style_names();

/// Throws std::out_of_range if no style is called so.
const Style& find_style(std::string_view name);

/// A way to show a velocity over maps.
struct VelocityStyle {
  struct About {
    std::string_view name, meaning;
  } about;
};
const std::vector<VelocityStyle>& velocity_styles();

/// The first of the catalogue that shows densities, or errors, of this dimension and is drawn where a case does not say
/// which.
const Style& default_style(int dimension, bool errors = false);

/// The same among those for small pictures.
const Style& panel_style(int dimension, bool errors = false);

}  // namespace gaussdrift::render

template <>
std::vector<gaussdrift::render::Style>& gaussdrift::base::catalogue<gaussdrift::render::Style>();
