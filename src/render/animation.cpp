#include "render/animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <tuple>
#include <utility>

#include "base/parallel.hpp"
#include "base/seam.hpp"
#include "gaussdrift/error.hpp"
#include "render/height_field.hpp"
#include "render/picture.hpp"

namespace gaussdrift::render {

namespace fs = std::filesystem;

namespace {

/// Pictures of one style, by the number of the frame.
class Pictures {
 public:
  Pictures(const Animation& animation, const Style& style, std::string array)
      : animation_(animation), style_(style), array_(std::move(array)), size_(animation.size) {
    if (size_[0] == 0) size_ = animation.kind->size;
    for (int& side : size_) side += side % 2;
    const PicturesSpec& looks = animation.looks;
    if (looks.range) range_ = {(*looks.range)[0], (*looks.range)[1]};
    if (!looks.range && !looks.per_frame) range_ = range_of_all();
  }

  const std::array<int, 2>& size() const { return size_; }

  Image of(std::size_t number) const {
    base::seam();
    const FilmFrame frame = shown(nearest(number));
    PictureOptions options{.title = animation_.title,
                           .quantity = !animation_.quantity.empty() ? animation_.quantity
                                       : array_.empty()             ? std::string(style_.quantity)
                                                                    : array_,
                           .time = frame.time,
                           .date = animation_.date ? animation_.date(frame.time) : "",
                           .whole = true,
                           .range_min = range_.first,
                           .range_max = range_.second,
                           .width = size_[0],
                           .height = size_[1],
                           .looks = animation_.looks};
    options.looks.transparent = false;
    return picture_of(style_, frame.density, options);
  }

 private:
  FilmFrame shown(std::size_t stored) const {
    FilmFrame frame = animation_.frame(stored);
    show_field(frame.density, array_);
    return frame;
  }

  /// Of the frames that there are, for one of the film.
  std::size_t nearest(std::size_t number) const {
    const std::vector<double>& times = animation_.times;
    const double part =
        animation_.frames > 1 ? static_cast<double>(number) / static_cast<double>(animation_.frames - 1) : 1;
    const double wanted = times.front() + part * (times.back() - times.front());
    const auto apart = [&](double time) { return std::abs(time - wanted); };
    return static_cast<std::size_t>(
        std::min_element(times.begin(), times.end(), [&](double a, double b) { return apart(a) < apart(b); }) -
        times.begin());
  }

  std::pair<double, double> range_of_all() const {
    std::vector<ValueFacts> facts(animation_.times.size());
    base::parallel_for({facts.size(), 1e-3 * static_cast<double>(facts.size())}, animation_.threads,
                       [&](std::size_t i) { facts[i] = facts_of(shown(i).density.rho); });
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const ValueFacts& one : facts) low = std::min(low, one.minimum), high = std::max(high, one.maximum);
    return range_of(style_, animation_.looks, low, high);
  }

  const Animation& animation_;
  const Style& style_;
  std::string array_;
  std::array<int, 2> size_;
  std::pair<double, double> range_{0, 0};  // none: each picture has its own
};

/// Some frames ahead, drawn together by all threads.
class Ahead {
 public:
  Ahead(const Pictures& pictures, std::size_t frames, int threads)
      : pictures_(pictures), frames_(frames), threads_(base::resolve_threads(threads)) {}

  Image get(std::size_t number) {
    if (number >= first_ + images_.size() || number < first_) {
      first_ = number;
      images_.resize(std::min<std::size_t>(frames_ - number, static_cast<std::size_t>(threads_)));
      base::parallel_for({images_.size(), 1e-2 * static_cast<double>(images_.size())}, threads_,
                         [&](std::size_t i) { images_[i] = pictures_.of(first_ + i); });
    }
    return std::move(images_[number - first_]);
  }

 private:
  const Pictures& pictures_;
  std::size_t frames_;
  int threads_;
  std::size_t first_ = 0;
  std::vector<Image> images_;
};

/// Times of the frames in a folder, one after another from the first. Frames that go back in time are left of an earlier run.
std::vector<double> times_of_frames(const fs::path& folder) {
  std::vector<double> times;
  for (std::size_t i = 0; fs::exists(film_frame_file(folder, i)); ++i) {
    const double time = read_film_frame(folder, i).time;
    if (i > 1 && (time - times.back()) * (times[1] - times[0]) <= 0) break;
    times.push_back(time);
  }
  return times;
}

}  // namespace

void make_film(const Animation& animation, const Style& style, const std::string& array, const fs::path& file) {
  if (animation.times.empty()) throw FileError(fmt::format("cannot make {}: there are no frames", file.string()));
  const Pictures pictures(animation, style, array);
  Ahead ahead(pictures, animation.frames, animation.threads);
  const Reel reel{.width = pictures.size()[0],
                  .height = pictures.size()[1],
                  .frames = animation.frames,
                  .seconds = animation.seconds,
                  .frame = [&](std::size_t i) { return ahead.get(i); },
                  .sample = [&](std::size_t i) { return pictures.of(i); }};
  write_film(*animation.kind, reel, file);
}

std::string film_name(const Style& style, const std::string& array, const FilmKind& kind) {
  return fmt::format("{}{}{}.{}", array, array.empty() ? "" : "_", style.about.name, kind.about.name);
}

std::vector<const Style*> film_styles(const Case& spec) {
  std::vector<const Style*> styles;
  for (const PictureStyle& about : spec.output.images)
    if (!about.shows_error) styles.push_back(&find_style(about.name));
  if (styles.empty()) styles.push_back(&default_style(spec.domain.dimension));
  return styles;
}

std::vector<std::string> film_arrays(const Case& spec) {
  if (!spec.output.pictures.field.empty()) return {spec.output.pictures.field};
  std::vector<std::string> arrays{""};
  for (const TracerSpec& tracer : spec.tracers) arrays.push_back(tracer.name);
  return arrays;
}

bool has_film_frames(const fs::path& folder) { return fs::exists(film_frame_file(folder, 0)); }

std::vector<std::string> make_films_of_run(const fs::path& folder, const Case& spec, int threads) {
  std::vector<std::string> names;
  if (!spec.output.animation) return names;
  const AnimationSpec& wanted = *spec.output.animation;
  const Animation animation{.times = times_of_frames(folder),
                            .frame = [&](std::size_t i) { return read_film_frame(folder, i); },
                            .frames = static_cast<std::size_t>(wanted.frames),
                            .kind = &find_film_kind(wanted.kind),
                            .seconds = wanted.seconds,
                            .size = wanted.size,
                            .looks = spec.output.pictures,
                            .title = spec.title.empty() ? spec.name : spec.title,
                            .date = spec.time.date,
                            .threads = threads};
  for (const std::string& array : film_arrays(spec))
    for (const Style* style : film_styles(spec)) {
      names.push_back("images/" + film_name(*style, array, *animation.kind));
      make_film(animation, *style, array, folder / names.back());
    }
  remove_film_frames(folder);
  return names;
}

}  // namespace gaussdrift::render
