#include "render/picture_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace gaussdrift::render {

namespace fs = std::filesystem;

namespace {

std::string file_stem(Style style) {
  switch (style) {
    case Style::surface:
      return "surface";
    case Style::contour:
      return "contour";
    case Style::heatmap:
      return "heatmap";
  }
  return "picture";
}

class PictureSeries : public Observer {
 public:
  PictureSeries(const fs::path& folder, std::vector<Style> styles, std::string title)
      : folder_(folder / "images"), styles_(std::move(styles)) {
    options_.title = std::move(title);
  }
  std::string name() const override { return "pictures"; }

  void frame(const Frame& frame) override {
    const double low = frame.numbers.minimum, high = frame.numbers.maximum;
    if (kept_.empty()) {
      lowest_ = low, highest_ = high;
      std::tie(options_.range_min, options_.range_max) = rounded_range(low, high);
    }
    lowest_ = std::min(lowest_, low), highest_ = std::max(highest_, high);
    kept_.push_back(
        {frame.index, frame.time, frame.density->lattice, {frame.density->rho.begin(), frame.density->rho.end()}});
    draw_all(frame.index, frame.time, *frame.density);
  }

  void finish() override {
    const double margin = 0.01 * (options_.range_max - options_.range_min);
    if (lowest_ >= options_.range_min - margin && highest_ <= options_.range_max + margin) return;
    std::tie(options_.range_min, options_.range_max) = rounded_range(lowest_, highest_);
    for (const Kept& kept : kept_) draw_all(kept.index, kept.time, {kept.lattice, {kept.rho.begin(), kept.rho.end()}});
  }

 private:
  // Single precision is plenty for colours and halves what a long run keeps.
  struct Kept {
    int index;
    double time;
    Lattice lattice;
    std::vector<float> rho;
  };

  void draw_all(int index, double time, const DensityGrid& density) {
    options_.time = time;
    for (const Style style : styles_)
      draw(style, density, options_, folder_ / fmt::format("{}_{:04}.png", file_stem(style), index));
  }

  fs::path folder_;
  std::vector<Style> styles_;
  PictureOptions options_;
  std::vector<Kept> kept_;
  double lowest_ = 0, highest_ = 0;
};

}  // namespace

std::unique_ptr<Observer> picture_series(const fs::path& folder, std::vector<Style> styles, std::string title) {
  return std::make_unique<PictureSeries>(folder, std::move(styles), std::move(title));
}

}  // namespace gaussdrift::render
