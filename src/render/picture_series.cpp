#include "render/picture_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "base/seam.hpp"
#include "base/state_bytes.hpp"
#include "gaussdrift/error.hpp"
#include "render/beside.hpp"
#include "render/height_field.hpp"
#include "render/kept_densities.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {

namespace fs = std::filesystem;

namespace {

/// Colours of a style over all frames so far: the range of the first one holds until values have left it. As it stands
/// here it is part of the state of a run.
struct RunningRange {
  std::uint64_t first = 0;  // frame
  double min = 0, max = 1;  // rounded, of the first frame
  double lowest = 0, highest = 0;
};

struct Drawn {
  Style style;
  std::optional<RunningRange> range;  // none before the first frame

  void include(std::uint64_t frame, const PicturesSpec& looks, double low, double high) {
    if (!range) {
      const auto [min, max] = range_of(style, looks, low, high);
      range = RunningRange{frame, min, max, low, high};
    }
    range->lowest = std::min(range->lowest, low), range->highest = std::max(range->highest, high);
  }

  /// If values have left the range by more than a hundredth; by the logarithm small ones may.
  std::optional<std::pair<double, double>> wider(const PicturesSpec& looks) const {
    if (!range || looks.range || looks.per_frame) return std::nullopt;
    const double margin = 0.01 * (range->max - range->min);
    const bool low = !looks.log && range->lowest < range->min - margin;
    if (!low && range->highest <= range->max + margin) return std::nullopt;
    return range_of(style, looks, range->lowest, range->highest);
  }
};

class PictureSeries : public Observer {
 public:
  PictureSeries(const fs::path& folder, const std::vector<PictureStyle>& styles, std::string title,
                SeriesOptions options)
      : folder_(folder / "images"),
        warn_(std::move(options.warn)),
        date_(std::move(options.date)),
        tracer_(std::move(options.tracer)),
        label_(std::move(options.label)),
        looks_(std::move(options.looks)),
        beside_wanted_(options.beside),
        // Of a named density, and of fields, none are written for pictures alone.
        kept_(folder, options.most_bytes, options.run_writes_densities || !array().empty(), array()) {
    for (const PictureStyle& about : styles)
      if (array().empty() || !about.shows_error) styles_.push_back({find_style(about.name), {}});
    options_.title = std::move(title);
    kept_.lattice.sphere = options.sphere;
    options_.looks = looks_;
    options_.width = looks_.size[0], options_.height = looks_.size[1];
  }
  std::string name() const override { return tracer_.empty() ? "pictures" : "pictures of " + tracer_; }
  bool needs_particles(double /*time*/) const override { return false; }

  void frame(const Frame& frame) override {
    times_.resize(static_cast<std::size_t>(frame.index));
    times_.push_back(frame.time);
    if (!array().empty()) return show_array(frame);
    show(frame, *frame.density, {frame.numbers.minimum, frame.numbers.maximum}, false);
    if (!frame.exact ||
        std::none_of(styles_.begin(), styles_.end(), [](const Drawn& drawn) { return drawn.style.about.shows_error; }))
      return;
    const DensityGrid error = error_of(frame);
    const ValueFacts facts = facts_of(error.rho);
    show(frame, error, {facts.minimum, facts.maximum}, true);
  }

  std::string state() const override {
    beside_.wait();  // a run that goes on from here does not draw it again
    base::StateBytes bytes;
    Lattice lattice = kept_.lattice;
    Ranges ranges;
    for (const Drawn& drawn : styles_)
      if (drawn.range) ranges.emplace_back(drawn.style.about.name, *drawn.range);
    pass_state(bytes, lattice, ranges);
    return bytes.written();
  }

  void restore(const std::vector<std::pair<double, FrameNumbers>>& frames, const std::string& state) override {
    times_.clear();
    for (const auto& [time, numbers] : frames) times_.push_back(time);
    if (state.empty()) return;  // there were no pictures
    base::StateBytes bytes(state);
    Ranges ranges;
    pass_state(bytes, kept_.lattice, ranges);
    for (const auto& [style, range] : ranges)
      for (Drawn& drawn : styles_)
        if (drawn.style.about.name == style) drawn.range = range;
  }

  void finish() override {
    beside_.wait();
    draw_again(false);
    draw_again(true);
    kept_.remove_files(times_.size());
  }

 private:
  using Ranges = std::vector<std::pair<std::string, RunningRange>>;

  static void pass_state(base::StateBytes& bytes, Lattice& lattice, Ranges& ranges) {
    bytes(lattice.dimension, lattice.points, lattice.origin, lattice.spacing, ranges);
    bytes.end();
    if (lattice.dimension < 1 || lattice.dimension > max_dimension)
      throw std::out_of_range("its grid has no such dimension");
    double points = 1;
    for (const std::size_t along : lattice.points) points *= static_cast<double>(along);
    constexpr double most_points = 1e12;
    if (bytes.reading() && !(points >= 0 && points <= most_points && std::isfinite(lattice.spacing)))
      throw std::out_of_range("its grid is wrong");
  }

  DensityGrid error_of(const Frame& frame) const {
    DensityGrid error{.lattice = frame.density->lattice, .rho = frame.density->rho};
    if (!looks_.velocity.empty()) error.fields = frame.density->fields;
    for (std::size_t i = 0; i < error.rho.size(); ++i) error.rho[i] -= (*frame.exact)[i];
    return error;
  }

  /// What is drawn in place of the density: a named one or a field; empty: nothing.
  const std::string& array() const { return tracer_.empty() ? looks_.field : tracer_; }

  void show_array(const Frame& frame) {
    DensityGrid density = *frame.density;
    show_field(density, array());
    const ValueFacts facts = facts_of(density.rho);
    show(frame, density, {facts.minimum, facts.maximum}, false);
  }

  /// By the styles that show the density, or those that show its error.
  void show(const Frame& frame, const DensityGrid& density, std::pair<double, double> extremes, bool error) {
    const auto index = static_cast<std::size_t>(frame.index);
    kept_.keep(error, index, frame.time, density);
    std::vector<std::function<void(const DensityGrid&)>> pictures;
    for (Drawn& drawn : styles_) {
      if (drawn.style.about.shows_error != error) continue;
      drawn.include(index, looks_, extremes.first, extremes.second);
      pictures.push_back(picture(drawn.style, {drawn.range->min, drawn.range->max}, index));
    }
    if (pictures.empty()) return;
    if (!beside_wanted_) {
      for (const auto& draw_it : pictures) draw_it(density);
      return;
    }
    beside_.begin([copy = density, pictures = std::move(pictures)] {
      for (const auto& draw_it : pictures) draw_it(copy);
    });
  }

  using Wide = std::vector<std::pair<const Drawn*, std::pair<double, double>>>;

  /// What these styles show beside the density, each field once.
  std::vector<FieldOnGrid> fields_needed(const Wide& wide, std::size_t index) {
    std::vector<FieldOnGrid> fields;
    for (const auto& [drawn, range] : wide) {
      const bool over = drawn->style.takes_velocity && !looks_.velocity.empty();
      const std::string_view needed = over ? "velocity" : drawn->style.about.needs_field;
      const bool there = needed.empty() || std::any_of(fields.begin(), fields.end(),
                                                       [&](const FieldOnGrid& field) { return field.name == needed; });
      if (!there) fields.push_back(kept_.field(needed, index, times_[index]));
    }
    return fields;
  }

  /// Pictures of all outputs with the wider range, where there is one. Each density is fetched once for all styles.
  void draw_again(bool error) {
    Wide wide;
    for (const Drawn& drawn : styles_)
      if (const auto range = drawn.wider(looks_); range && drawn.style.about.shows_error == error)
        wide.emplace_back(&drawn, *range);
    std::size_t first = times_.size(), missing = 0;
    for (const auto& [drawn, range] : wide) first = std::min<std::size_t>(first, drawn->range->first);
    std::string why;
    for (std::size_t index = first; index < times_.size(); ++index) {
      DensityGrid density;
      try {
        density = kept_.get(error, index, times_[index]);
        density.fields = fields_needed(wide, index);
      } catch (const FileError& failure) {
        if (++missing == 1) why = failure.what();
        continue;
      }
      for (const auto& [drawn, range] : wide)
        if (index >= drawn->range->first) picture(drawn->style, range, index)(density);
    }
    if (missing > 0 && warn_)
      warn_(
          fmt::format("pictures of the {} at {} earlier output{} keep a narrower range of colours than the others: {}",
                      error ? "error" : "density", missing, missing == 1 ? "" : "s", why));
  }

  /// One that is to be drawn. It knows all that it needs, so that another thread may draw it.
  std::function<void(const DensityGrid&)> picture(const Style& style, std::pair<double, double> range,
                                                  std::size_t index) {
    PictureOptions options = options_;
    options.time = times_[index];
    if (date_) options.date = date_(times_[index]);
    options.quantity = !array().empty()                            ? array()
                       : label_.empty() || style.about.shows_error ? std::string(style.quantity)
                                                                   : label_;
    std::tie(options.range_min, options.range_max) = looks_.range ? std::pair((*looks_.range)[0], (*looks_.range)[1])
                                                     : looks_.per_frame ? std::pair(0., 0.)
                                                                        : range;
    const fs::path file =
        folder_ / fmt::format("{}{}{}_{:04}.png", array(), array().empty() ? "" : "_", style.about.name, index);
    return [style, options = std::move(options), file](const DensityGrid& density) {
      base::seam();
      draw(style, density, options, file);
    };
  }

  fs::path folder_;
  std::function<void(const std::string&)> warn_;
  std::function<std::string(double t)> date_;
  std::string tracer_;  // empty: the density
  std::string label_;   // of the density; empty: as the style calls it
  PicturesSpec looks_;
  bool beside_wanted_;
  std::vector<Drawn> styles_;
  PictureOptions options_;
  std::vector<double> times_;  // of all outputs so far, those of earlier processes too
  KeptDensities kept_;
  mutable Beside beside_;  // what is drawn at the moment
};

}  // namespace

std::unique_ptr<Observer> picture_series(const fs::path& folder, const std::vector<PictureStyle>& styles,
                                         std::string title, SeriesOptions options) {
  return std::make_unique<PictureSeries>(folder, styles, std::move(title), std::move(options));
}

}  // namespace gaussdrift::render
