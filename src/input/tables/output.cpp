// [output]: when to write, and what.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "input/tables/tables.hpp"
#include "render/styles.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::input {

using Kind = Value::Kind;

namespace {

void spread_frames(Reader& in, const Number& count, double end, std::vector<double>& times) {
  const int frames = static_cast<int>(count.number);
  if (end == 0) {
    if (count.written && frames > 1)
      in.diagnostics.error(count.written->place,
                           fmt::format("output.frames = {}, but time.end = 0 leaves one time", frames),
                           "give frames = 1");
    times = {0.0};
    return;
  }
  for (int k = 0; k < frames; ++k) times.push_back(k == frames - 1 ? end : end * (double(k) / (frames - 1)));
  if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
    in.diagnostics.error(count.written ? count.written->place : in.source.end(),
                         fmt::format("{} times between 0 and {} cannot be told apart", frames, end),
                         "lower output.frames");
}

void read_times(Reader& in, const Entry& entry, std::vector<double>& times) {
  const Key& key = find_key("output", "times");
  const auto list = in.numbers(entry, key);
  if (!list || !in.facts.end) return;
  if (list->empty())
    in.diagnostics.error(entry.value.place, "output.times is empty; give at least one time",
                         "output.frames = 5 spreads 5 times evenly");
  const double end = *in.facts.end;
  for (std::size_t k = 0; k < list->size(); ++k) {
    double time = (*list)[k];
    if (std::abs(time - end) <= same_time * end) time = end;
    const Value& written = entry.value.items[k];
    const std::string found = found_number(time, written);
    if (time < 0)
      in.diagnostics.error(written.place,
                           fmt::format("entry {} of output.times is {}; the run begins at 0", k + 1, found));
    else if (time > end)
      in.diagnostics.error(written.place,
                           fmt::format("entry {} of output.times is {}, after time.end = {}", k + 1, found, end));
    else if (!times.empty() && time <= times.back())
      in.diagnostics.error(
          written.place,
          fmt::format("entry {} of output.times is {}, not after the entry before it, {}", k + 1, found, times.back()),
          "output.times must ascend");
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

}  // namespace

void read_output(Reader& in, OutputSpec& output, const TimeSpec& time) {
  const Entry *times = in.find("output", "times"), *frames = in.find("output", "frames");
  if (times && frames &&
      times->place.override_index != frames->place.override_index)  // the later one replaces the other
    (times->place.override_index > frames->place.override_index ? frames : times) = nullptr;
  if (times && frames)
    in.exactly_one("output", {"times", "frames"});
  else if (times)
    read_times(in, *times, output.times);
  else if (const auto count = in.number("output", "frames"); count && in.facts.end)
    spread_frames(in, *count, time.end, output.times);

  for (const std::size_t k : in.choices("output", "vtk")) output.files.push_back(write::output_files()[k].about);
  for (const std::size_t k : in.choices("output", "images")) output.images.push_back(render::styles()[k].about);
  output.report = in.choice("output", "report") == "html";
  if (in.facts.dimension) check_images(in, output.images);
}

}  // namespace gaussdrift::input
