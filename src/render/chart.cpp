#include "render/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gaussdrift/error.hpp"
#include "render/axes.hpp"
#include "render/on_canvas.hpp"

namespace gaussdrift::render {
namespace {

/// Distinct for the colour-blind, too (Okabe and Ito), in the order of the series.
constexpr std::array<Colour, 7> palette{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {86, 180, 233}, {230, 159, 0}, {60, 60, 60}}};

struct Drawn {
  const ChartSeries* series;
  Colour colour;
  std::size_t shape;  // of the marks
};

/// Values as positions on the axis: themselves or their logarithms.
double on_axis(const ChartAxis& axis, double value) {
  if (axis.logarithmic) return value > 0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
  return value;
}

Axis logarithmic_axis(const std::string& name, double min, double max, int intervals) {
  Axis axis(name, min, max, intervals);
  axis.ticks = {};
  const int every = std::max(1, static_cast<int>(std::ceil((max - min) / intervals)));
  for (int k = static_cast<int>(std::ceil(min - 1e-9)); k <= max + 1e-9; ++k)
    if (k % every == 0) axis.ticks.list.push_back({double(k), power_of_ten(k)});
  if (axis.ticks.list.size() >= 3) return axis;
  axis.ticks.list.clear();  // less than two decades: 1, 2, 5 as well
  for (int k = static_cast<int>(std::floor(min)); k <= max; ++k)
    for (const int factor : {1, 2, 5}) {
      const double at = k + std::log10(factor);
      if (at >= min - 1e-9 && at <= max + 1e-9) axis.ticks.list.push_back({at, number(factor * std::pow(10., k), 5)});
    }
  return axis;
}

Axis make_axis(const ChartAxis& wanted, const std::vector<ChartSeries>& series, double ChartPoint::*coordinate,
               const ChartAxis& other, double ChartPoint::*other_coordinate, int intervals) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ChartSeries& s : series)
    for (const ChartPoint& p : s.points) {
      const double at = on_axis(wanted, p.*coordinate);
      if (!std::isfinite(at) || !std::isfinite(on_axis(other, p.*other_coordinate))) continue;
      low = std::min(low, at), high = std::max(high, at);
    }
  if (low > high) low = 0, high = 1;
  const bool given = wanted.range[0] < wanted.range[1];
  if (given) low = on_axis(wanted, wanted.range[0]), high = on_axis(wanted, wanted.range[1]);
  if (!(high > low)) low -= 0.5, high += 0.5;
  const double margin = given ? 0 : 0.05 * (high - low);
  if (wanted.logarithmic) return logarithmic_axis(wanted.name, low - margin, high + margin, intervals);
  // A quantity that begins at 0 or near it is shown from there.
  if (!given && low >= 0 && low <= 0.25 * high) return Axis(wanted.name, 0, high + margin, intervals);
  return Axis(wanted.name, low - margin, high + margin, intervals);
}

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.top() && b.y < a.top();
}

/// A text beside a point, where nothing else stands; nothing if there is no such place.
std::optional<Rectangle> free_place(const Point& at, double width, double height, double gap, const Rectangle& panel,
                                    const std::vector<Rectangle>& taken) {
  const std::array<Point, 6> corners{{{at.x + gap, at.y - height / 2},
                                      {at.x - width / 2, at.y + gap},
                                      {at.x - width / 2, at.y - gap - height},
                                      {at.x - gap - width, at.y - height / 2},
                                      {at.x + gap, at.y + gap / 2},
                                      {at.x + gap, at.y - gap / 2 - height}}};
  for (const Point& corner : corners) {
    const Rectangle place{corner.x, corner.y, width, height};
    if (place.x < panel.x || place.right() > panel.right() || place.y < panel.y || place.top() > panel.top()) continue;
    if (std::none_of(taken.begin(), taken.end(), [&](const Rectangle& other) { return overlap(place, other); }))
      return place;
  }
  return std::nullopt;
}

/// A closed mark of one of five shapes.
Polyline mark(const Point& at, double radius, std::size_t shape, const Colour& colour) {
  constexpr std::array<std::pair<int, double>, 5> corners{{{16, 0}, {4, 0.125}, {4, 0}, {3, 0.25}, {3, 0.75}}};
  const auto [count, turned] = corners[shape % corners.size()];
  Polyline line{{}, colour};
  for (int k = 0; k <= count; ++k) {
    const double angle = 2 * M_PI * (double(k) / count + turned);
    line.points.push_back({at.x + radius * std::cos(angle), at.y + radius * std::sin(angle)});
  }
  return line;
}

std::vector<Polyline> dashes(const std::vector<Point>& way, double length, const Colour& colour) {
  std::vector<Polyline> pieces;
  double walked = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Point from = way[i - 1], to = way[i];
    const double stretch = std::hypot(to.x - from.x, to.y - from.y);
    for (double s = 0; s < stretch;) {
      const double phase = std::fmod(walked + s, 2 * length);
      const bool ink_here = phase < length;
      const double end = std::min(stretch, s + (ink_here ? length - phase : 2 * length - phase) + 1e-6);
      const auto on = [&](double at) {
        return Point{from.x + (to.x - from.x) * at / stretch, from.y + (to.y - from.y) * at / stretch};
      };
      if (ink_here) pieces.push_back({{on(s), on(end)}, colour});
      s = end;
    }
    walked += stretch;
  }
  return pieces;
}

/// The text in lines of at most `width` pixels, broken at blanks.
std::vector<std::string> broken(const std::string& text, double width, int size) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find(' ', i), text.size());
    const std::string word = text.substr(i, end - i);
    if (!line.empty() && Canvas::text_width(line + " " + word, size) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line += (line.empty() ? "" : " ") + word;
    }
    i = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

class ChartPainter {
 public:
  ChartPainter(Canvas& canvas, const Chart& chart) : canvas_(canvas), chart_(chart), scale_(canvas) {
    std::size_t colour = 0;
    for (const ChartSeries& s : chart.series) {
      series_.push_back({&s, s.quiet ? grey : palette[colour % palette.size()], colour});
      colour += !s.quiet;
    }
    std::stable_sort(series_.begin(), series_.end(),
                     [](const Drawn& a, const Drawn& b) { return a.series->quiet > b.series->quiet; });
  }

  void paint() {
    const double below = draw_texts();
    panel_ = {scale_(150), below + scale_(92), canvas_.width() - scale_(150 + 48), 0};
    panel_.height = canvas_.height() - panel_.y - scale_(96);
    const Axis x = make_axis(chart_.x, chart_.series, &ChartPoint::x, chart_.y, &ChartPoint::y, 8);
    const Axis y = make_axis(chart_.y, chart_.series, &ChartPoint::y, chart_.x, &ChartPoint::x, 8);
    draw_grid(x, y);
    std::vector<Polyline> marks;
    std::vector<std::pair<Point, const ChartPoint*>> labelled;
    for (const Drawn& drawn : series_) draw_line(drawn, x, y, marks, labelled);
    canvas_.lines(marks, scale_(2.6));
    draw_axes(canvas_, panel_, x, y);
    draw_legend();
    draw_labels(labelled);
  }

 private:
  /// Title, conclusion and footer; the height that the last two take.
  double draw_texts() {
    const double left = scale_(48), width = canvas_.width() - 2 * left;
    int size = scale_.font(27);
    while (size > scale_.font(16) && Canvas::text_width(chart_.title, size) > width) --size;
    canvas_.text({left, canvas_.height() - scale_(34)}, chart_.title,
                 {.size = size, .across = Across::left, .along = Along::top});
    double y = scale_(18);
    const auto block = [&](const std::string& text, int font, const Colour& colour) {
      auto lines = broken(text, width, font);
      for (auto line = lines.rbegin(); line != lines.rend(); ++line, y += 1.35 * font)
        canvas_.text({left, y}, *line,
                     {.size = font, .across = Across::left, .along = Along::bottom, .colour = colour});
      if (!lines.empty()) y += scale_(8);
    };
    block(chart_.footer, scale_.font(15), {120, 120, 120});
    block(chart_.conclusion, scale_.font(20), ink);
    return y;
  }

  void draw_grid(const Axis& x, const Axis& y) {
    std::vector<Polyline> grid;
    for (const Tick& t : x.ticks.list) {
      const double at = panel_.x + x.position(t.at) * panel_.width;
      grid.push_back({{{at, panel_.y}, {at, panel_.top()}}, pale_grey});
    }
    for (const Tick& t : y.ticks.list) {
      const double at = panel_.y + y.position(t.at) * panel_.height;
      grid.push_back({{{panel_.x, at}, {panel_.right(), at}}, pale_grey});
    }
    canvas_.lines(grid, 1);
  }

  void draw_line(const Drawn& drawn, const Axis& x, const Axis& y, std::vector<Polyline>& marks,
                 std::vector<std::pair<Point, const ChartPoint*>>& labelled) {
    using Look = ChartSeries::Look;
    const Look look = drawn.series->look;
    std::vector<std::vector<Point>> pieces(1);
    for (const ChartPoint& p : drawn.series->points) {
      const double u = x.position(on_axis(chart_.x, p.x)), v = y.position(on_axis(chart_.y, p.y));
      const bool inside = u >= -1e-9 && u <= 1 + 1e-9 && v >= -1e-9 && v <= 1 + 1e-9;  // false for NaN
      if (!inside) {
        pieces.emplace_back();
        continue;
      }
      const Point at{panel_.x + u * panel_.width, panel_.y + v * panel_.height};
      pieces.back().push_back(at);
      if (look == Look::marks || look == Look::both) {
        marks.push_back(mark(at, scale_(7), drawn.shape, drawn.colour));
        taken_.push_back({at.x - scale_(8), at.y - scale_(8), scale_(16), scale_(16)});
      }
      if (!p.label.empty()) labelled.emplace_back(at, &p);
    }
    std::vector<Polyline> lines;
    for (const auto& piece : pieces) {
      if (piece.size() < 2 || look == Look::marks) continue;
      for (std::size_t i = 1; i < piece.size(); ++i)
        for (int k = 0; k < 8; ++k)
          crossed_.push_back({piece[i - 1].x + (piece[i].x - piece[i - 1].x) * (k + 0.5) / 8,
                              piece[i - 1].y + (piece[i].y - piece[i - 1].y) * (k + 0.5) / 8, 1, 1});
      if (look == Look::dashed) {
        const auto dashed = dashes(piece, scale_(9), drawn.colour);
        lines.insert(lines.end(), dashed.begin(), dashed.end());
      } else {
        lines.push_back({piece, drawn.colour});
      }
    }
    canvas_.lines(lines, scale_(drawn.series->quiet ? 1.4 : 2.4));
  }

  /// In the corner of the panel with the fewest marks and pieces of lines under it.
  void draw_legend() {
    std::vector<const Drawn*> named;
    double widest = 0;
    const int size = scale_.font(18);
    for (const Drawn& drawn : series_)
      if (!drawn.series->name.empty()) {
        named.push_back(&drawn);
        widest = std::max(widest, Canvas::text_width(drawn.series->name, size));
      }
    if (named.empty()) return;
    const double row = scale_(29), width = widest + scale_(74), height = row * double(named.size()) + scale_(12);
    Rectangle best{};
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    const double gap = scale_(10);
    for (const Rectangle& corner : {Rectangle{panel_.right() - width - gap, panel_.top() - height - gap, width, height},
                                    Rectangle{panel_.x + gap, panel_.top() - height - gap, width, height},
                                    Rectangle{panel_.right() - width - gap, panel_.y + gap, width, height},
                                    Rectangle{panel_.x + gap, panel_.y + gap, width, height}}) {
      const auto under = static_cast<std::size_t>(
          std::count_if(taken_.begin(), taken_.end(), [&](const Rectangle& mark) { return overlap(mark, corner); }));
      if (under < fewest) fewest = under, best = corner;
    }
    canvas_.area(best, white);
    canvas_.frame(best, pale_grey, 1);
    double y = best.top() - scale_(6) - row / 2;
    for (const Drawn* drawn : named) {
      using Look = ChartSeries::Look;
      const Look look = drawn->series->look;
      const Point from{best.x + scale_(12), y}, to{best.x + scale_(52), y};
      if (look == Look::dashed)
        canvas_.lines(dashes({from, to}, scale_(9), drawn->colour), scale_(2.4));
      else if (look != Look::marks)
        canvas_.lines({{{from, to}, drawn->colour}}, scale_(drawn->series->quiet ? 1.4 : 2.4));
      if (look == Look::marks || look == Look::both)
        canvas_.lines({mark({(from.x + to.x) / 2, y}, scale_(7), drawn->shape, drawn->colour)}, scale_(2.6));
      canvas_.text({best.x + scale_(62), y}, drawn->series->name, {.size = size, .across = Across::left});
      y -= row;
    }
    taken_.push_back(best);
  }

  void draw_labels(const std::vector<std::pair<Point, const ChartPoint*>>& labelled) {
    const int size = scale_.font(15);
    for (const auto& [at, point] : labelled) {
      const auto place = free_place(at, Canvas::text_width(point->label, size), 1.2 * size, scale_(12), panel_, taken_);
      if (!place) continue;
      canvas_.text({place->x, place->y}, point->label,
                   {.size = size, .across = Across::left, .along = Along::bottom, .colour = {80, 80, 80}});
      taken_.push_back(*place);
    }
  }

  Canvas& canvas_;
  const Chart& chart_;
  Scale scale_;
  std::vector<Drawn> series_;
  Rectangle panel_;
  std::vector<Rectangle> taken_;    // by marks, legend and labels
  std::vector<Rectangle> crossed_;  // by lines
};

}  // namespace

void draw_chart(const Chart& chart, const std::filesystem::path& png) {
  on_canvas(chart.width, chart.height, png, [&](Canvas& canvas) { ChartPainter(canvas, chart).paint(); });
}

}  // namespace gaussdrift::render
