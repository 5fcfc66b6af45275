#include "render/picture_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "render/solid.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {

namespace fs = std::filesystem;

namespace {

/// Colour range over all frames so far: that of the first one, until the values have left it.
class RunningRange {
 public:
  using Rounding = std::pair<double, double> (*)(double, double);
  explicit RunningRange(Rounding round) : round_(round) {}

  void include(double low, double high) {
    if (!begun_) {
      lowest_ = low, highest_ = high;
      std::tie(min, max) = round_(low, high);
      begun_ = true;
    }
    lowest_ = std::min(lowest_, low), highest_ = std::max(highest_, high);
  }
  /// Widens the range if values have left it by more than a hundredth.
  bool widen() {
    const double margin = 0.01 * (max - min);
    if (!begun_ || (lowest_ >= min - margin && highest_ <= max + margin)) return false;
    std::tie(min, max) = round_(lowest_, highest_);
    return true;
  }

  double min = 0, max = 1;

 private:
  Rounding round_;
  bool begun_ = false;
  double lowest_ = 0, highest_ = 0;
};

class PictureSeries : public Observer {
 public:
  PictureSeries(const fs::path& folder, const std::vector<PictureStyle>& styles, std::string title)
      : folder_(folder / "images") {
    for (const PictureStyle& about : styles) {
      const Style& style = find_style(about.name);
      styles_.push_back({style, RunningRange(style.range)});
    }
    options_.title = std::move(title);
  }
  std::string name() const override { return "pictures"; }

  void frame(const Frame& frame) override {
    show(kept_, frame, *frame.density, {frame.numbers.minimum, frame.numbers.maximum}, false);
    if (!frame.exact ||
        std::none_of(styles_.begin(), styles_.end(), [](const Drawn& drawn) { return drawn.style.about.shows_error; }))
      return;
    const DensityGrid error = error_of(frame);
    const ValueFacts facts = facts_of(error.rho);
    show(kept_errors_, frame, error, {facts.minimum, facts.maximum}, true);
  }

  void finish() override {
    for (Drawn& drawn : styles_) {
      if (!drawn.range.widen()) continue;
      for (const Kept& kept : drawn.style.about.shows_error ? kept_errors_ : kept_)
        draw_one(drawn, kept.index, kept.time, {kept.lattice, {kept.rho.begin(), kept.rho.end()}});
    }
  }

 private:
  struct Drawn {
    Style style;
    RunningRange range;
  };

  // Single precision is plenty for colours and halves what a long run keeps; in space thinned, for the same reason.
  struct Kept {
    int index;
    double time;
    Lattice lattice;
    std::vector<float> rho;
  };

  static void keep(std::vector<Kept>& list, const Frame& frame, const DensityGrid& density) {
    constexpr std::size_t most_points = 128;
    const DensityGrid thin = density.lattice.dimension == 3 ? thinned(density, most_points) : density;
    list.push_back({frame.index, frame.time, thin.lattice, {thin.rho.begin(), thin.rho.end()}});
  }

  static DensityGrid error_of(const Frame& frame) {
    DensityGrid error = *frame.density;
    for (std::size_t i = 0; i < error.rho.size(); ++i) error.rho[i] -= (*frame.exact)[i];
    return error;
  }

  /// By the styles that show the density, or those that show its error.
  void show(std::vector<Kept>& list, const Frame& frame, const DensityGrid& density, std::pair<double, double> extremes,
            bool errors) {
    keep(list, frame, density);
    for (Drawn& drawn : styles_) {
      if (drawn.style.about.shows_error != errors) continue;
      drawn.range.include(extremes.first, extremes.second);
      draw_one(drawn, frame.index, frame.time, density);
    }
  }

  void draw_one(const Drawn& drawn, int index, double time, const DensityGrid& density) {
    options_.time = time;
    options_.quantity = drawn.style.quantity;
    options_.range_min = drawn.range.min, options_.range_max = drawn.range.max;
    draw(drawn.style, density, options_, folder_ / fmt::format("{}_{:04}.png", drawn.style.about.name, index));
  }

  fs::path folder_;
  std::vector<Drawn> styles_;
  PictureOptions options_;
  std::vector<Kept> kept_, kept_errors_;
};

}  // namespace

std::unique_ptr<Observer> picture_series(const fs::path& folder, const std::vector<PictureStyle>& styles,
                                         std::string title) {
  return std::make_unique<PictureSeries>(folder, styles, std::move(title));
}

}  // namespace gaussdrift::render
