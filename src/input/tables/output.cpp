// [output]: when to write, and what.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/catalogue.hpp"
#include "base/has_one.hpp"
#include "input/tables/tables.hpp"
#include "render/styles.hpp"
#include "sim/grid_fields.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::input {

namespace {

std::string joined(const std::vector<std::string_view>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

template <class Thing>
std::vector<std::string_view> default_names(const std::vector<Thing>& all) {
  std::vector<std::string_view> names;
  for (const Thing& one : all)
    if (one.about.by_default) names.push_back(one.about.name);
  return names;
}

/// "`surface`, `contour` and `heatmap`".
std::string in_words(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{}`{}`", i == 0 ? "" : i + 1 < names.size() ? ", " : " and ", names[i]);
  return text;
}

std::string meaning_of_images() {
  std::vector<std::string_view> flat, solid, both, errors;
  for (const render::Style& style : render::styles()) {
    const PictureStyle& about = style.about;
    auto& list = about.shows_error ? errors : !about.shows(3) ? flat : !about.shows(2) ? solid : both;
    list.push_back(about.name);
  }
  const std::string in_both = both.empty() ? "" : in_words(both) + "; ";
  return fmt::format(
      "pictures that are drawn. In 2D {}; in 3D {}; in both {}{}, which needs a reference. The default is `{}` in 2D "
      "and `{}` in 3D",
      in_words(flat), in_words(solid), in_both, in_words(errors), render::default_style(2).about.name,
      render::default_style(3).about.name);
}

}  // namespace

Section output_section() {
  Section section{
      Table{.name = "output",
            .required = false,
            .meaning = "what is written, and when. The times are given by `times` or by `frames`"},
      {{.name = "times",
        .type = Type::numbers,
        .unit = "time",
        .meaning = "times at which output is written, in the order in which the run meets them, between `time.start` "
                   "and `time.end`. Dates are possible as there"},
       {.name = "frames",
        .type = Type::whole,
        .fallback = "5",
        .range = {1, 1e6},
        .meaning =
            "number of outputs, evenly spaced from `time.start` to `time.end`; 1 means the end alone. It replaces "
            "`times`"},
       {.name = "vtk",
        .type = Type::choices,
        .fallback = kept(joined(default_names(write::output_files()))),
        .choices = base::names_of(write::output_files()),
        .meaning = "files that are written for ParaView"},
       {.name = "images",
        .type = Type::choices,
        .fallback = kept(joined(default_names(render::styles()))),
        .choices = base::names_of(render::styles()),
        .meaning = meaning_of_images()},
       {.name = "fields",
        .type = Type::choices,
        .fallback = kept("rho"),
        .choices = base::names_of(grid_fields()),
        .meaning = "what the density files show on the grid beside the density. Fields of the particles are shown by "
                   "the files of the particles, and those that are one number by the density files too: at each "
                   "point that of the particle that began nearest. "
                   "Derivatives of the density are summed together with it, each to `evaluate.tolerance` relative "
                   "to its own largest value"},
       {.name = "report",
        .type = Type::choice,
        .fallback = "html",
        .choices = {"html", "still", "none"},
        .meaning =
            "the page about the run. `html` writes report.html and its numbers, report.json. The page plays the "
            "outputs, from numbers that it keeps itself, report.frames. With pictures there is summary.png, too. "
            "`still` leaves out what plays"},
       {.name = "page_megabytes",
        .type = Type::number,
        .fallback = "5",
        .range = {1, 1000},
        .unit = "MB",
        .meaning =
            "most of report.html. Where the outputs would take more, the page plays every second, fourth, ... of "
            "them, and then on a coarser grid"},
       {.name = "piece_particles",
        .type = Type::whole,
        .fallback = "4194304",
        .range = {100, 134217728},
        .meaning =
            "most particles of a file. More are written in pieces, none of which has more particles, in the order "
            "of their ids. Several ranks bring no more together on one of them, so that more particles get no error "
            "budget there"},
       {.name = "checkpoint",
        .type = Type::duration,
        .range = {0, infinity},
        .unit = "s",
        .meaning = "time between two checkpoints, such as 60 or \"10 min\"; 0: none. `gaussdrift resume` goes on from "
                   "the last one. Without this key a run that takes more than five minutes writes one about every "
                   "minute, and spends at most a fiftieth of its time on them"}}};
  for (Key& key : animation_keys()) section.keys.push_back(std::move(key));
  return section;
}

using Kind = Value::Kind;

namespace {

void spread_frames(Reader& in, const Number& count, const TimeSpec& clock, std::vector<double>& times) {
  const int frames = static_cast<int>(count.number);
  const double end = clock.end;
  if (end == 0) {
    if (count.written && frames > 1)
      in.diagnostics.error(count.written->place,
                           fmt::format("output.frames = {}, but time.end = {} leaves one time", frames, clock.at(end)),
                           "give frames = 1");
    times = {0.0};
    return;
  }
  for (int k = 0; k < frames; ++k)
    times.push_back(k == frames - 1 ? end : clock.elapsed(clock.at(end * (double(k) / (frames - 1)))));
  if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
    in.diagnostics.error(
        count.written ? count.written->place : in.source.end(),
        fmt::format("{} times between {} and {} cannot be told apart", frames, clock.start, clock.at(end)),
        "lower output.frames");
}

/// Elapsed times from those that the clock shows.
void read_times(Reader& in, const Entry& entry, const TimeSpec& clock, std::vector<double>& times) {
  const Key& key = find_key("output", "times");
  const auto list = in.numbers(entry, key);
  if (!list || !in.facts.end) return;
  if (list->empty())
    in.diagnostics.error(entry.value.place, "output.times is empty; give at least one time",
                         "output.frames = 5 spreads 5 times evenly");
  const double end = *in.facts.end;
  const char* const beyond = clock.backwards ? "before" : "after";
  for (std::size_t k = 0; k < list->size(); ++k) {
    double time = clock.elapsed((*list)[k]);
    const double rounding = same_time * std::max({end, std::abs(clock.start), std::abs(clock.at(end))});
    if (std::abs(time - end) <= rounding) time = end;
    if (clock.start != 0 && std::abs(time) <= rounding) time = 0;
    const Value& written = entry.value.items[k];
    const std::string found = found_number((*list)[k], written);
    if (time < 0)
      in.diagnostics.error(written.place, fmt::format("entry {} of output.times is {}; the run begins at {}", k + 1,
                                                      found, clock.start));
    else if (time > end)
      in.diagnostics.error(written.place, fmt::format("entry {} of output.times is {}, {} time.end = {}", k + 1, found,
                                                      beyond, clock.at(end)));
    else if (!times.empty() && time <= times.back())
      in.diagnostics.error(
          written.place,
          fmt::format("entry {} of output.times is {}, not {} the entry before it, {}", k + 1, found, beyond,
                      clock.at(times.back())),
          clock.backwards ? "the run goes backwards: output.times must descend" : "output.times must ascend");
    times.push_back(time);
  }
}

/// Complains about styles of the other dimension; of the defaults only those of this one are kept.
void check_images(Reader& in, std::vector<PictureStyle>& images) {
  if (const Entry* entry = in.find("output", "images")) {
    std::vector<std::string_view> possible;
    for (const render::Style& style : render::styles())
      if (style.about.shows(in.facts.dimension)) possible.push_back(style.about.name);
    for (const Value& item : entry->value.items) {
      if (item.kind != Kind::text) continue;  // complained about
      const render::Style* style = base::find_or_null(render::styles(), item.text);
      if (style && !style->about.shows(in.facts.dimension))
        in.diagnostics.error(item.place,
                             fmt::format("\"{}\" shows scenes in {}D; the domain has {} dimensions", item.text,
                                         5 - in.facts.dimension, in.facts.dimension),
                             fmt::format("pictures in {}D: {}", in.facts.dimension, quoted_list(possible)));
    }
  }
  std::erase_if(images, [&](const PictureStyle& style) { return !style.shows(in.facts.dimension); });
}

/// Pictures of fields beside the density are drawn from what density files have.
void check_fields_of_images(Reader& in, const OutputSpec& output) {
  const Entry* images = in.find("output", "images");
  if (!images) return;
  for (const PictureStyle& style : output.images) {
    const std::string_view needed = style.needs_field;
    if (needed.empty()) continue;
    const bool has_it = std::any_of(output.fields.begin(), output.fields.end(),
                                    [&](const GridField& field) { return field.name == needed; });
    if (!has_it)
      in.diagnostics.error(images->value.place,
                           fmt::format("\"{}\" shows the {}, which output.fields does not name", style.name, needed),
                           fmt::format("fields = [\"{}\"]", needed));
    else if (!base::has_one(output.files, &OutputFile::shows_density))
      in.diagnostics.error(
          images->value.place,
          fmt::format("\"{}\" shows the {}, which density files keep, and none are written", style.name, needed),
          "have \"density\" in output.vtk");
    else
      continue;
    return;  // one is enough to be told
  }
}

/// Fields that no file shows.
void check_files_of_fields(Reader& in, const OutputSpec& output) {
  const Entry* fields = in.find("output", "fields");
  if (!fields) return;
  const bool densities = base::has_one(output.files, &OutputFile::shows_density),
             particles = base::has_one(output.files, &OutputFile::needs_velocity);
  for (const GridField& field : output.fields) {
    if (densities && field.is_on_grid) continue;
    if (particles && field.is_of_particles) continue;
    in.diagnostics.warning(
        fields->value.place,
        field.is_of_particles
            ? fmt::format("\"{}\" is shown by the files of the particles, and none are written", field.name)
            : "output.fields are shown by density files, and none are written",
        fmt::format("have \"{}\" in output.vtk", field.is_of_particles ? "particles" : "density"));
    return;  // one is enough to be told
  }
}

}  // namespace

void read_output(Reader& in, OutputSpec& output, const TimeSpec& time) {
  const Entry *times = in.find("output", "times"), *frames = in.find("output", "frames");
  if (times && frames &&
      times->place.override_index != frames->place.override_index)  // the later one replaces the other
    (times->place.override_index > frames->place.override_index ? frames : times) = nullptr;
  if (times && frames)
    in.exactly_one("output", {"times", "frames"});
  else if (times)
    read_times(in, *times, time, output.times);
  else if (const auto count = in.number("output", "frames"); count && in.facts.end)
    spread_frames(in, *count, time, output.times);

  for (const std::size_t k : in.choices("output", "vtk")) output.files.push_back(write::output_files()[k].about);
  for (const std::size_t k : in.choices("output", "images")) output.images.push_back(render::styles()[k].about);
  for (const std::size_t k : in.choices("output", "fields")) output.fields.push_back(grid_fields()[k].about);
  const std::string report = in.choice("output", "report");
  output.report = report != "none";
  output.page.plays = report == "html";
  if (const auto most = in.number("output", "page_megabytes")) output.page.megabytes = most->number;
  output.checkpoint = in.duration("output", "checkpoint");
  if (const auto most = in.number("output", "piece_particles")) output.piece_particles = most->number;
  if (in.facts.dimension) check_images(in, output.images);
  check_fields_of_images(in, output);
  check_files_of_fields(in, output);
  read_animation(in, output);
}

void write_output(Writer& out, const OutputSpec& output, const TimeSpec& time) {
  const auto names = [](const auto& things) {
    std::vector<std::string> list;
    for (const auto& thing : things) list.emplace_back(thing.name);
    return written(list);
  };
  out.table("output");
  std::vector<double> times = output.times;
  for (double& one : times) one = time.at(one);
  out.entry("times", written(times));
  out.entry("vtk", names(output.files));
  out.entry("images", names(output.images));
  if (output.fields.size() != 1 || output.fields.front().name != grid_fields().front().about.name)
    out.entry("fields", names(output.fields));
  out.entry("report", written(std::string(!output.report ? "none" : output.page.plays ? "html" : "still")));
  if (output.page.megabytes != PageSpec{}.megabytes) out.entry("page_megabytes", written(output.page.megabytes));
  write_animation(out, output);
  if (output.checkpoint) out.entry("checkpoint", written(*output.checkpoint));
  if (output.piece_particles != OutputSpec{}.piece_particles)
    out.entry("piece_particles", fmt::format("{:.0f}", output.piece_particles));
}

}  // namespace gaussdrift::input
