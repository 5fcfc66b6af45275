#include "render/picture_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "render/solid.hpp"

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
  PictureSeries(const fs::path& folder, std::vector<Style> styles, std::string title)
      : folder_(folder / "images"), styles_(std::move(styles)) {
    options_.title = std::move(title);
  }
  std::string name() const override { return "pictures"; }

  void frame(const Frame& frame) override {
    density_range_.include(frame.numbers.minimum, frame.numbers.maximum);
    keep(kept_, frame, *frame.density);
    draw_all(frame.index, frame.time, *frame.density, false);
    if (!frame.exact || std::find(styles_.begin(), styles_.end(), Style::error) == styles_.end()) return;
    const DensityGrid error = error_of(frame);
    const ValueFacts facts = facts_of(error.rho);
    error_range_.include(facts.minimum, facts.maximum);
    keep(kept_errors_, frame, error);
    draw_all(frame.index, frame.time, error, true);
  }

  void finish() override {
    for (const bool errors : {false, true}) {
      if (!(errors ? error_range_ : density_range_).widen()) continue;
      for (const Kept& kept : errors ? kept_errors_ : kept_)
        draw_all(kept.index, kept.time, {kept.lattice, {kept.rho.begin(), kept.rho.end()}}, errors);
    }
  }

 private:
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

  void draw_all(int index, double time, const DensityGrid& density, bool errors) {
    const RunningRange& range = errors ? error_range_ : density_range_;
    options_.time = time;
    options_.quantity = errors ? "error" : "density";
    options_.range_min = range.min, options_.range_max = range.max;
    for (const Style style : styles_)
      if ((style == Style::error) == errors)
        draw(style, density, options_, folder_ / fmt::format("{}_{:04}.png", to_string(style), index));
  }

  fs::path folder_;
  std::vector<Style> styles_;
  PictureOptions options_;
  std::vector<Kept> kept_, kept_errors_;
  RunningRange density_range_{rounded_range}, error_range_{symmetric_range};
};

}  // namespace

std::unique_ptr<Observer> picture_series(const fs::path& folder, std::vector<Style> styles, std::string title) {
  return std::make_unique<PictureSeries>(folder, std::move(styles), std::move(title));
}

}  // namespace gaussdrift::render
