#include "render/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gaussdrift::render {

Scale::Scale(const Canvas& canvas) : Scale(canvas.type() * std::min(canvas.width() / 1280., canvas.height() / 960.)) {}

int Scale::font(int size) const { return std::max(6, static_cast<int>(std::lround(unit_ * size))); }

Axis short_axis(const std::string& name, double min, double max, int intervals) {
  Axis axis(name, min, max, intervals);
  for (int finer = intervals + 1; axis.ticks.list.size() < 2 && finer <= intervals + 8; ++finer)
    axis = Axis(name, min, max, finer);
  return axis;
}

Axis value_axis(const std::string& quantity, const ColourRange& range, int intervals) {
  Axis axis(quantity, range.min, range.max, intervals);
  if (!range.log) return axis;
  axis.log = true;
  axis.ticks = {};
  axis.ticks.list = logarithmic_ticks(std::log10(range.min), std::log10(range.max), intervals);
  for (Tick& tick : axis.ticks.list) tick.at = std::pow(10., tick.at);
  return axis;
}

std::size_t numbered_ticks(const std::vector<Rectangle>& numbers, double gap) {
  const auto touch = [&](const Rectangle& a, const Rectangle& b) {
    return a.x < b.right() + gap && b.x < a.right() + gap && a.y < b.top() + gap && b.y < a.top() + gap;
  };
  const auto crowded = [&](std::size_t every) {
    for (std::size_t i = 0; i + every < numbers.size(); i += every)
      if (touch(numbers[i], numbers[i + every])) return true;
    return false;
  };
  std::size_t every = 1;
  while (crowded(every)) ++every;
  return every;
}

void draw_heading(Canvas& canvas, const PictureOptions& options, const ValueFacts& facts) {
  const Scale scale(canvas);
  const double left = scale(48), right = canvas.width() - scale(48), top = canvas.height() - scale(34);

  std::string time = options.time ? fmt::format("t = {}", number(*options.time, 5)) : "";
  if (options.time && !options.date.empty()) time += fmt::format("   {}", options.date);
  const int time_size = scale.font(24);
  canvas.text({right, top}, time, {.size = time_size, .across = Across::right, .along = Along::top});

  // A long title gets smaller, then shorter.
  const double room = right - left - Canvas::text_width(time, time_size) - scale(40);
  std::string title = options.title;
  int size = scale.font(27);
  while (size > scale.font(18) && Canvas::text_width(title, size) > room) --size;
  if (Canvas::text_width(title, size) > room) {
    while (!title.empty() && Canvas::text_width(title + "...", size) > room) {
      while (!title.empty() && (static_cast<unsigned char>(title.back()) & 0xC0) == 0x80) title.pop_back();
      if (!title.empty()) title.pop_back();
    }
    title += "...";
  }
  canvas.text({left, top}, title, {.size = size, .across = Across::left, .along = Along::top});

  const Colour quiet{105, 105, 105};
  std::string extremes = fmt::format("min {}   max {}", number(facts.minimum, 5), number(facts.maximum, 5));
  canvas.text({right, top - scale(36)}, extremes,
              {.size = scale.font(17), .across = Across::right, .along = Along::top, .colour = quiet});
  if (facts.not_finite > 0)
    canvas.text({left, top - scale(38)}, fmt::format("{} values are not finite", facts.not_finite),
                {.size = scale.font(17), .across = Across::left, .along = Along::top, .colour = not_a_number});
}

void draw_axes(Canvas& canvas, const Rectangle& panel, const Axis& across, const Axis& upwards) {
  const Scale scale(canvas);
  const double tick = scale(7), gap = scale(6);
  const int size = scale.font(18), title_size = scale.font(21);
  const auto &below = across.ticks.list, &beside = upwards.ticks.list;
  const auto x_of = [&](const Tick& t) { return panel.x + across.position(t.at) * panel.width; };
  const auto y_of = [&](const Tick& t) { return panel.y + upwards.position(t.at) * panel.height; };
  std::vector<Rectangle> numbers_below, numbers_beside;
  for (const Tick& t : below) {
    const double width = Canvas::text_width(t.label, size);
    numbers_below.push_back({x_of(t) - width / 2, 0, width, 1. * size});
  }
  for (const Tick& t : beside) numbers_beside.push_back({0, y_of(t) - size / 2., 1, 1. * size});
  const std::size_t every_below = numbered_ticks(numbers_below, scale(2)),
                    every_beside = numbered_ticks(numbers_beside, scale(2));
  std::vector<Polyline> marks;
  for (std::size_t i = 0; i < below.size(); ++i) {
    const double x = x_of(below[i]);
    marks.push_back({{{x, panel.y}, {x, panel.y - tick}}, ink});
    if (i % every_below == 0)
      canvas.text({x, panel.y - tick - gap}, below[i].label, {.size = size, .along = Along::top});
  }
  double widest = 0;
  for (std::size_t i = 0; i < beside.size(); ++i) {
    const double y = y_of(beside[i]);
    marks.push_back({{{panel.x, y}, {panel.x - tick, y}}, ink});
    if (i % every_beside != 0) continue;
    canvas.text({panel.x - tick - gap, y}, beside[i].label, {.size = size, .across = Across::right});
    widest = std::max(widest, Canvas::text_width(beside[i].label, size));
  }
  canvas.lines(marks, 1.3);
  canvas.frame(panel, ink, 1.3);
  canvas.text({panel.x + panel.width / 2, panel.y - tick - gap - scale(27)}, across.title(),
              {.size = title_size, .along = Along::top});
  canvas.text({panel.x - tick - gap - widest - scale(16), panel.y + panel.height / 2}, upwards.title(),
              {.size = title_size, .across = Across::right, .along = Along::centre, .upwards = true});
}

void draw_colour_bar(Canvas& canvas, const Rectangle& bar, bool upwards, const Axis& axis,
                     const std::vector<double>& marks, Colour (*map)(double)) {
  const Scale scale(canvas);
  const int columns = static_cast<int>(std::lround(bar.width)), rows = static_cast<int>(std::lround(bar.height));
  const int length = upwards ? rows : columns;
  std::vector<Colour> colours;
  colours.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) colours.push_back(map(((upwards ? j : i) + 0.5) / length));
  canvas.image(static_cast<int>(std::lround(bar.x)), static_cast<int>(std::lround(bar.y)), columns, rows, colours);

  const double tick = scale(6), gap = scale(6);
  const int size = scale.font(18), title_size = scale.font(20);
  std::vector<Polyline> lines;
  for (const double at : marks) {
    const double x = bar.x + axis.position(at) * bar.width, y = bar.y + axis.position(at) * bar.height;
    lines.push_back(upwards ? Polyline{{{bar.x, y}, {bar.right(), y}}, white}
                            : Polyline{{{x, bar.y}, {x, bar.top()}}, white});
  }
  for (const Tick& t : axis.ticks.list) {
    const double x = bar.x + axis.position(t.at) * bar.width, y = bar.y + axis.position(t.at) * bar.height;
    if (upwards) {
      lines.push_back({{{bar.right(), y}, {bar.right() + tick, y}}, ink});
      canvas.text({bar.right() + tick + gap, y}, t.label, {.size = size, .across = Across::left});
    } else {
      lines.push_back({{{x, bar.y}, {x, bar.y - tick}}, ink});
      canvas.text({x, bar.y - tick - gap}, t.label, {.size = size, .along = Along::top});
    }
  }
  canvas.lines(lines, 1.2);
  canvas.frame(bar, ink, 1.2);
  if (upwards) {
    // Above the bar, and not over the edge of the picture.
    const std::string title = axis.title();
    const double x = std::min(bar.x, canvas.width() - Canvas::text_width(title, title_size) - scale(16));
    canvas.text({x, bar.top() + scale(16)}, title,
                {.size = title_size, .across = Across::left, .along = Along::bottom});
  } else {
    canvas.text({bar.x + bar.width / 2, bar.top() + scale(10)}, axis.title(),
                {.size = title_size, .along = Along::bottom});
  }
}

}  // namespace gaussdrift::render
