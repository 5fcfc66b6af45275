// gaussdrift render: the densities of a run, drawn again.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/number.hpp"
#include "cli/drawable.hpp"
#include "cli/laid_out.hpp"
#include "cli/looks.hpp"
#include "cli/output_name.hpp"
#include "cli/outputs_of.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "render/animation.hpp"
#include "render/picture.hpp"
#include "render/styles.hpp"
#include "write/folder_lock.hpp"
#include "write/result_folder.hpp"
#include "write/run_folder.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct RenderOptions {
  fs::path folder;
  std::string style;               // empty: the default of the dimension and field
  std::string field = "rho";       // an array of the density files
  std::vector<std::string> times;  // numbers or dates; empty: all
  fs::path out;                    // empty: images/ of the folder
  LookOptions looks;
  std::string animation;  // a kind; "true" for the first; empty: pictures
  double seconds = 0;     // that it takes; 0: chosen
  int threads = 0;
  bool json = false;
};

std::vector<std::string> names_of_films() {
  std::vector<std::string> names;
  for (const render::FilmKind& kind : render::film_kinds()) names.emplace_back(kind.about.name);
  return names;
}

void declare(OptionList& options, RenderOptions& given) {
  options.add("folder", given.folder, "DIR", "folder of a run, a .vti or .pvti, or a case (its density at the start)")
      .required();
  options.add("--style", given.style, "NAME", fmt::format("{}", fmt::join(render::style_names(), ", ")))
      .offers(render::style_names);
  options
      .add("--field", given.field, "NAME",
           fmt::format("{}; of vectors the length. rho by default", fmt::join(arrays_of_outputs(), ", ")))
      .offers(arrays_of_outputs);
  options.add("--times", given.times, "T,...", "only these output times, or their dates").separated_by(',');
  declare_looks(options, given.looks);
  options
      .add("--animation", given.animation, "KIND",
           fmt::format(
               "one animation in place of pictures: {}; {} by default. Of the frames that a run has kept because it "
               "could not make its own, else of its outputs",
               fmt::join(names_of_films(), ", "), names_of_films().front()))
      .value_optional();
  options
      .add("--seconds", given.seconds, "S", "how long the animation is; half a second an output by default, at most 10")
      .within(0.1, 3600.0);
  options.add("--out", given.out, "DIR", "folder for the pictures; images/ of the run by default");
  options.threads(given.threads);
  options.json(given.json);
}

/// The one at a time that was typed, maybe with few digits: the nearest within a thousandth.
std::size_t output_at(double wanted, const Drawable& drawable, const fs::path& folder) {
  std::optional<std::size_t> nearest;
  std::vector<double> times;
  for (std::size_t i = 0; i < drawable.times.size(); ++i) {
    if (!drawable.times[i]) continue;
    const double time = *drawable.times[i], apart = std::abs(wanted - time);
    times.push_back(time);
    if (apart <= 1e-3 * std::max(1e-9, std::abs(time)) &&
        (!nearest || apart < std::abs(wanted - *drawable.times[*nearest])))
      nearest = i;
  }
  if (!nearest)
    throw CommandLineError(fmt::format("--times {:g}: no output of {} is within a thousandth of it; there are {:.6g}",
                                       wanted, folder.string(), fmt::join(times, ", ")));
  return *nearest;
}

/// The one at a time, or of that date; "2020-01-03" is midnight.
std::size_t output_named(const std::string& wanted, const Drawable& drawable, const fs::path& folder) {
  if (const auto time = base::read_number<double>(wanted)) return output_at(*time, drawable, folder);
  std::vector<std::string> dates;
  for (std::size_t i = 0; drawable.date && i < drawable.times.size(); ++i) {
    dates.push_back(drawable.times[i] ? drawable.date(*drawable.times[i]) : "");
    if (dates.back() == wanted || dates.back() == wanted + " 00:00") return i;
  }
  throw CommandLineError(dates.empty() ? fmt::format("--times {} is no number, and the outputs of {} have no dates",
                                                     wanted, folder.string())
                                       : fmt::format("--times {}: no output of {} has this date; there are {}", wanted,
                                                     folder.string(), fmt::join(dates, ", ")));
}

const render::Style& style_called(const std::string& name) {
  check_name("--style", name, render::style_names());
  return render::find_style(name);
}

/// Other fields than densities have no mass that a surface would show: they are drawn as maps.
const render::Style& usual_style(int dimension, const std::string& field) {
  const bool error = field == "error", density = field == "rho" || field == "rho_exact";
  return density || error ? render::default_style(dimension, error) : render::panel_style(dimension, false);
}

/// Where pictures go: images/ of the run, the folder of --out, or the working folder for a single density. They replace
/// pictures that stand on its list, and no other file.
class Place {
 public:
  /// `drawn`: the folder of the run, which is locked, or a density. Throws FileError.
  Place(const fs::path& drawn, const fs::path& out, const std::vector<std::string>& names) {
    if (!out.empty()) {
      own_.emplace(out, "drawing", write::ResultFolder::Earlier::join);
      own_->claim(names);
      folder_ = out;
    } else if (fs::is_directory(drawn)) {
      std::vector<std::string> in_the_run;
      for (const std::string& name : names) in_the_run.push_back("images/" + name);
      write::add_to_own_files(drawn, in_the_run);
      folder_ = drawn / "images";
    } else {
      for (const std::string& name : names)
        if (std::error_code ignored; fs::exists(fs::symlink_status(name, ignored)))
          throw FileError(fmt::format(
              "{} is there already and would be replaced; move it away, or choose a folder with --out", name));
      folder_ = ".";
    }
  }
  const fs::path& folder() const { return folder_; }
  void complete() {
    if (own_) own_->complete();
  }

 private:
  fs::path folder_;
  std::optional<write::ResultFolder> own_;
};

bool is_case(const fs::path& place) { return place.extension() == ".toml"; }

/// All that a picture is made of: outputs in some order, a style, and its looks.
struct Plan {
  Drawable drawable;
  std::vector<std::size_t> wanted;
  const render::Style* style = nullptr;
  std::string field, array;  // empty: the density
  std::vector<std::string> vectors;
  PicturesSpec looks;

  DensityGrid density(std::size_t i) const { return drawable.density(i, field, vectors); }
};

Plan plan_of(const RenderOptions& options, bool locked) {
  Plan plan;
  plan.field = options.field;
  if (options.field != "rho") plan.array = options.field;
  const bool of_frames = !options.animation.empty() && options.times.empty() && fs::is_directory(options.folder) &&
                         render::has_film_frames(options.folder);
  plan.drawable = is_case(options.folder) ? start_to_draw(options.folder)
                  : of_frames             ? frames_to_draw(options.folder)
                                          : outputs_to_draw(options.folder, locked);
  plan.looks = looks_of(options.looks);
  std::set<std::size_t> wanted;
  for (const std::string& time : options.times) wanted.insert(output_named(time, plan.drawable, options.folder));
  for (std::size_t i = 0; options.times.empty() && i < plan.drawable.times.size(); ++i) wanted.insert(i);
  plan.wanted.assign(wanted.begin(), wanted.end());
  if (!options.style.empty()) plan.style = &style_called(options.style);
  return plan;
}

/// The style, if none was asked for, and what it needs; and the range of all pictures, which is why all are read.
std::pair<double, double> settle(Plan& plan) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  int dimension = 2;
  for (const std::size_t i : plan.wanted) {
    const DensityGrid density = plan.density(i);
    dimension = density.lattice.dimension;
    for (const double value : density.rho)
      if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  }
  if (low > high) low = high = 0;
  if (!plan.style) plan.style = &usual_style(dimension, plan.field);
  const render::Style& style = *plan.style;
  if (!style.about.shows(dimension))
    throw CommandLineError(
        fmt::format("--style {} does not show densities of {} dimensions", style.about.name, dimension));
  if (!plan.looks.zoom.empty() && plan.looks.zoom.size() != 2 * static_cast<std::size_t>(dimension))
    throw CommandLineError(fmt::format("--zoom has {} numbers; in {} dimensions it needs {}", plan.looks.zoom.size(),
                                       dimension, 2 * dimension));
  if (!plan.looks.velocity.empty()) {
    if (!style.takes_velocity || dimension == 3)
      throw CommandLineError(
          fmt::format("--velocity is drawn over maps in 2D: --style heatmap, not {}", style.about.name));
    plan.vectors = {"velocity"};
  } else if (!style.about.needs_field.empty()) {
    plan.vectors = {std::string(style.about.needs_field)};
  }
  // Values of both signs, that are no density, have a colour for 0 in the middle.
  const bool both_signs = low < -0.1 * high && high > -0.1 * low;
  if (!plan.array.empty() && plan.array != "rho_exact" && plan.looks.colour_map.empty() && both_signs &&
      !plan.looks.log)
    plan.looks.colour_map = "blue-white-red";
  if (plan.looks.range) return {(*plan.looks.range)[0], (*plan.looks.range)[1]};
  if (plan.looks.per_frame) return {0, 0};
  return render::range_of(style, plan.looks, low, high);
}

std::vector<std::string> draw_pictures(const Plan& plan, std::pair<double, double> range, Place& place,
                                       const std::vector<std::string>& names, bool tell) {
  std::vector<std::string> written;
  auto name = names.begin();
  for (const std::size_t i : plan.wanted) {
    const fs::path png = place.folder() / *name++;
    const std::optional<double>& time = plan.drawable.times[i];
    draw(*plan.style, plan.density(i),
         {.title = plan.drawable.title,
          .quantity = !plan.array.empty()             ? plan.array
                      : plan.style->about.shows_error ? plan.style->quantity
                                                      : plan.drawable.label,
          .time = time,
          .date = time && plan.drawable.date ? plan.drawable.date(*time) : "",
          .range_min = range.first,
          .range_max = range.second,
          .width = plan.looks.size[0],
          .height = plan.looks.size[1],
          .looks = plan.looks},
         png);
    written.push_back(png.string());
    if (tell) say("wrote  {}\n", png.string());
  }
  return written;
}

const render::FilmKind& film_kind(const std::string& asked) {
  if (asked == "true") return render::film_kinds().front();
  check_name("--animation", asked, names_of_films());
  const render::FilmKind& kind = render::find_film_kind(asked);
  if (const std::string why = kind.missing(); !why.empty())
    throw CommandLineError(fmt::format("--animation {}: {}; {} needs no other program", asked, why,
                                       render::film_kinds().front().about.name));
  return kind;
}

std::vector<std::string> draw_film(const RenderOptions& options, const Plan& plan, const render::FilmKind& kind,
                                   std::pair<double, double> range, const fs::path& file) {
  constexpr double of_output = 0.5, most = 10;
  render::Animation animation{.frames = plan.wanted.size(),
                              .kind = &kind,
                              .seconds = options.seconds > 0
                                             ? options.seconds
                                             : std::min(most, of_output * static_cast<double>(plan.wanted.size())),
                              .looks = plan.looks,
                              .title = plan.drawable.title,
                              .quantity = plan.array,
                              .date = plan.drawable.date,
                              .threads = options.threads};
  if (!plan.looks.per_frame) animation.looks.range = {range.first, range.second};
  if (!options.looks.size.empty()) animation.size = plan.looks.size;
  for (const std::size_t i : plan.wanted) {
    if (!plan.drawable.times[i]) throw CommandLineError("--animation: a density has no time; name the folder of a run");
    animation.times.push_back(*plan.drawable.times[i]);
  }
  animation.frame = [&](std::size_t i) { return render::FilmFrame{animation.times[i], plan.density(plan.wanted[i])}; };
  make_film(animation, *plan.style, "", file);
  if (!options.json) say("wrote  {}\n", file.string());
  return {file.string()};
}

ExitCode render(const RenderOptions& options) {
  check_folder_name(options.out, "pictures are written into a folder, as surface_0000.png and so on");
  check_array(options.field);
  const bool into_the_run = options.out.empty() && fs::is_directory(options.folder);
  std::optional<write::FolderLock> lock;
  if (into_the_run) lock.emplace(options.folder);
  const render::FilmKind* kind = options.animation.empty() ? nullptr : &film_kind(options.animation);
  if (kind && is_case(options.folder))
    throw CommandLineError("--animation: a case has no outputs; give it output.animation = true and run it");
  if (!kind && options.seconds > 0) throw CommandLineError("--seconds goes with --animation");
  Plan plan = plan_of(options, lock.has_value());
  render::check_available();
  const auto range = settle(plan);
  std::vector<std::string> names;
  if (kind)
    names.push_back(film_name(*plan.style, plan.array, *kind));
  else
    for (const std::size_t i : plan.wanted)
      names.push_back(fmt::format("{}{}{}_{:04}.png", plan.array, plan.array.empty() ? "" : "_", plan.style->about.name,
                                  plan.drawable.numbers[i]));
  Place place(options.folder, options.out, names);
  const std::vector<std::string> written = kind ? draw_film(options, plan, *kind, range, place.folder() / names.front())
                                                : draw_pictures(plan, range, place, names, !options.json);
  place.complete();
  if (options.json) say("{}\n", laid_out(nlohmann::ordered_json{{"written", written}}));
  return ExitCode::ok;
}

}  // namespace

Verb render_verb() {
  return make_verb<RenderOptions>("render", "draw the densities of a run again, without running it", declare, render);
}

}  // namespace gaussdrift::cli
