#include "accuracy/picture_seconds.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "accuracy/processor_clock.hpp"

namespace gaussdrift::accuracy {

namespace {

// Measured: user and system seconds of runs with six outputs and one style, less those of the same runs without
// pictures, on grids of 60^2 to 1000^2 and 40^3 to 160^3 points; one core of an Intel Xeon with AVX-512, VTK 9.1 with
// OSMesa. A picture of 1280 x 960 pixels costs about the same whatever it shows. Only a surface has a triangle for
// every point, up to 300^2 of them. The model is right within 0.03 s for each picture that was measured.
constexpr double first = 0.11;
struct PerPicture {
  double seconds, per_point;
};
PerPicture cost_of(OutputSpec::Image style, bool space) {
  switch (style) {
    case OutputSpec::Image::surface:
      return {0.13, 1.6e-6};
    case OutputSpec::Image::contour:
      return {0.117, 2.5e-8};
    case OutputSpec::Image::heatmap:
      return {0.133, 0.7e-8};
    case OutputSpec::Image::slices:
      return {0.13, 0.7e-8};
    case OutputSpec::Image::projection:
      return {0.13, 1.6e-8};
    case OutputSpec::Image::isosurface:
      return {0.17, 3e-8};
    case OutputSpec::Image::error:
      return {0.13, space ? 1.4e-8 : 0.8e-8};
  }
  return {0.13, 0};
}
constexpr std::size_t most_of_a_surface = 300 * 300;  // points, as render draws them

/// A frame of 640 x 480 pixels whose colours are interpolated, as the drawing library does most of the time. Returns
/// something that depends on all of them.
std::uint32_t small_drawing(std::vector<std::uint8_t>& frame) {
  constexpr int width = 640, height = 480;
  frame.resize(std::size_t{4} * width * height);
  std::uint32_t sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float along = static_cast<float>(x) / width, across = static_cast<float>(y) / height;
      const std::array<float, 4> colour{along * across, along * (1 - across), (1 - along) * across, 1};
      for (std::size_t c = 0; c < 4; ++c) {
        const auto value = static_cast<std::uint8_t>(255 * colour[c]);
        frame[4 * static_cast<std::size_t>(y * width + x) + c] = value;
        sum += value;
      }
    }
  return sum;
}
constexpr double small_drawing_seconds = 0.66e-3;  // on the machine of the constants above, fastest of ten

}  // namespace

double slowness_of_this_machine() {
  std::vector<std::uint8_t> frame;
  double fastest = std::numeric_limits<double>::infinity();
  static volatile std::uint32_t kept;  // so that it is drawn
  for (int i = 0; i < 10; ++i) {
    const ProcessorClock watch;
    kept = small_drawing(frame);
    fastest = std::min(fastest, watch.seconds());
  }
  (void)kept;
  return fastest / small_drawing_seconds;
}

double seconds_of_pictures(const Case& spec, std::size_t points, Redrawn again) {
  if (spec.output.images.empty() || spec.output.times.empty()) return 0;
  double each = 0;
  for (const OutputSpec::Image style : spec.output.images) {
    const PerPicture cost = cost_of(style, spec.domain.dimension == 3);
    const std::size_t drawn = style == OutputSpec::Image::surface ? std::min(points, most_of_a_surface) : points;
    const double drawings = (style == OutputSpec::Image::error ? again.error : again.density) ? 2 : 1;
    each += drawings * (cost.seconds + cost.per_point * static_cast<double>(drawn));
  }
  return slowness_of_this_machine() * (first + each * static_cast<double>(spec.output.times.size()));
}

}  // namespace gaussdrift::accuracy
