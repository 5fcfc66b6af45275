// Pictures of a density on a plane or in space, drawn off screen by VTK through OSMesa: no display, no GPU.
// The interface knows no VTK; where OSMesa was absent at build time unavailable_reason() says so and draw() throws.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "gaussdrift/frame.hpp"
#include "gaussdrift/pictures.hpp"
#include "render/image.hpp"

namespace gaussdrift::render {

struct Style;  // render/styles.hpp

struct PictureOptions {
  std::string title{};  // of the case
  std::string quantity = "density";
  std::array<std::string, 2> axes{"x", "y"};  // names of those of a plane
  std::optional<double> time = 0;             // empty: the picture has none
  std::string date{};                         // of that time; empty: it has none
  bool from_below = false;                    // contour: the plane's lines as seen from below instead of from above
  bool whole = false;                         // contour: all of the domain in any case, as the frames of a film show it
  std::optional<std::array<std::size_t, 3>>
      planes{};          // slices: indices along the axes; by default of the largest value
  double range_min = 0;  // of the colours, height axis and contour levels; the same for all pictures of a run
  double range_max = 1;
  int width = 1280;
  int height = 960;
  PicturesSpec looks{};  // all but range, per_frame, size and field, which others see to
};

/// Empty if pictures can be drawn, else the reason and the remedy.
std::string unavailable_reason();

/// "VTK 9.1.0". Throws Error(ExitCode::internal) where pictures cannot be drawn.
std::string drawing_library();

/// For commands that are asked for pictures: throws CommandLineError with the reason if they cannot be drawn.
void check_available();

/// Draws a density into a PNG (written beside its name and renamed). Values outside the range get the colours of its
/// ends; heights stick out of the box by at most 4 % of the range. Values that are not finite are left out (red, or grey
/// in pictures of errors) and counted in the heading, which also tells the true extremes. Without a range (range_min <
/// range_max, both finite) the rounded one of the density itself is used.
/// Of `looks`: a zoom shows the points of the grid around that part; the velocity is drawn over maps if the density has it
/// among its fields.
/// At most 300 x 300 points of a surface are drawn, and 160 an axis of surfaces in space. Where contour lines fill a
/// small part of the domain, half, a quarter or an eighth of it around them is shown, and said.
/// Several threads may draw; of pictures in perspective one is drawn at a time. Throws FileError; CommandLineError as check_available();
/// Error(ExitCode::internal) when the style cannot show the density.
void draw(const Style& style, const DensityGrid& density, const PictureOptions& options,
          const std::filesystem::path& png);

/// The same in memory.
Image picture_of(const Style& style, const DensityGrid& density, const PictureOptions& options);

/// A range with round ends that contains [minimum, maximum], except for up to 1 % at either end: the small overshoots
/// of a smoothed step do not spoil [0, 1]. 0 is an end if the values begin within a quarter of their size of it. [0, 1]
/// for nothing but zeros or values that are not finite.
std::pair<double, double> rounded_range(double minimum, double maximum);

/// A range with ends 1, 2 or 5 times a power of ten, for a logarithm: to the smallest value if that is positive, but no
/// more than six powers of ten. [0.1, 1] where no value is positive.
std::pair<double, double> logarithmic_range(double minimum, double maximum);

/// Whether values fall well below 0 and do not only overshoot it, as blobs of high order do.
bool has_both_signs(double minimum, double maximum);

/// The range of a style for these extremes, and for its looks: logarithmic, or as far below 0 as above where the colours
/// have a middle.
std::pair<double, double> range_of(const Style& style, const PicturesSpec& looks, double minimum, double maximum);

/// A field takes the place of the density: its values, or the lengths of its vectors. Nothing for an empty name. Throws
/// Error(ExitCode::internal) where it is not there.
void show_field(DensityGrid& density, std::string_view name);

/// A range for differences: round, and as far below 0 as above.
std::pair<double, double> symmetric_range(double minimum, double maximum);

}  // namespace gaussdrift::render
