#include "accuracy/picture_seconds.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "accuracy/processor_clock.hpp"
#include "render/styles.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double first = 0.11;  // start of the drawing library; the styles tell what each picture takes
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
  for (const PictureStyle& style : spec.output.images) {
    const render::Cost& cost = render::find_style(style.name).cost;
    const double a_point = spec.domain.dimension == 3 ? cost.a_point_in_space : cost.a_point;
    const double drawings = (style.shows_error ? again.error : again.density) ? 2 : 1;
    each += drawings * (cost.seconds + a_point * static_cast<double>(std::min(points, cost.most_points)));
  }
  return slowness_of_this_machine() * (first + each * static_cast<double>(spec.output.times.size()));
}

}  // namespace gaussdrift::accuracy
