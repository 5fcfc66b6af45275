// A density as the pictures use it: thinned to what a picture can show, in a scene whose longer side is 1.
#pragma once

#include <cstddef>
#include <vector>

#include "gaussdrift/frame.hpp"
#include "render/colour.hpp"

namespace gaussdrift::render {

/// Numbers of a density that colours alone do not show.
struct ValueFacts {
  double minimum = 0, maximum = 0;  // of its finite values
  std::size_t not_finite = 0;       // values that are NaN or infinite
};
ValueFacts facts_of(const std::vector<double>& values);

/// Values on nx x ny points, x fastest, over [0, width] x [0, depth] with max(width, depth) = 1; nx, ny >= 2.
/// A value is its position in the range of the colours: 0 at the lower end, 1 at the upper; NaN where the density is
/// not finite.
struct HeightField : ValueFacts {
  std::size_t nx = 2, ny = 2;
  double width = 1, depth = 1;
  std::vector<float> value;

  // What the scene stands for: true coordinates x_min + X * length, y_min + Y * length.
  double x_min = 0, y_min = 0, length = 1;

  float at(std::size_t i, std::size_t j) const { return value[j * nx + i]; }
  double x(std::size_t i) const { return width * static_cast<double>(i) / static_cast<double>(nx - 1); }
  double y(std::size_t j) const { return depth * static_cast<double>(j) / static_cast<double>(ny - 1); }
};

/// Values on a plane lattice, x fastest: what a HeightField is made of.
struct Plane {
  std::size_t nx = 1, ny = 1;
  double x_min = 0, y_min = 0, spacing = 1;
  std::vector<double> value;
};

/// All points of the plane. Throws Error(ExitCode::internal) unless it has a value at every point.
HeightField make_height_field(const Plane& plane, const ColourRange& range);

/// The density on at most `most` points an axis, interpolated bilinearly where it has more.
/// Throws Error(ExitCode::internal) unless it has two dimensions and a value at every point.
HeightField make_height_field(const DensityGrid& density, const ColourRange& range, std::size_t most);

/// Position of a value in the range, not further outside than single precision can follow; NaN if it is not finite.
float drawn_position(const ColourRange& range, double value);

/// The field on nx x ny points of the same rectangle, interpolated bilinearly.
HeightField resample(const HeightField& field, std::size_t nx, std::size_t ny);

}  // namespace gaussdrift::render
