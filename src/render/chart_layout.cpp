// Where everything in a chart is.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "render/axes.hpp"
#include "render/chart.hpp"
#include "render/label_places.hpp"
#include "render/letters.hpp"

namespace gaussdrift::render {
namespace {

using Look = ChartSeries::Look;

/// Values as positions on the axis: themselves or their logarithms.
double on_axis(const ChartAxis& axis, double value) {
  if (axis.logarithmic) return value > 0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
  return value;
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
  const double rounding = 1e-12 * std::max(std::fabs(low), std::fabs(high));
  if (!(high - low > rounding)) {
    const double half = 0.5 * std::max(1., std::fabs(low));
    low -= wanted.logarithmic ? 0.5 : half, high += wanted.logarithmic ? 0.5 : half;
  }
  const double margin = given ? 0 : 0.05 * (high - low);
  if (wanted.logarithmic) {
    Axis axis(wanted.name, low - margin, high + margin, intervals);
    axis.ticks = {};
    axis.ticks.list = logarithmic_ticks(axis.min, axis.max, intervals);
    return axis;
  }
  // A quantity that begins at 0 or near it is shown from there.
  if (!given && low >= 0 && low <= 0.25 * high) return Axis(wanted.name, 0, high + margin, intervals);
  return Axis(wanted.name, low - margin, high + margin, intervals);
}

/// A series on the sheet: pieces of its line, and its points in their order.
struct Drawn {
  const ChartSeries* series = nullptr;
  Ink ink = Ink::guide;
  std::size_t shape = 0;  // of the marks
  std::vector<std::vector<Point>> pieces;
  std::vector<std::pair<Point, const ChartPoint*>> points;

  bool has_marks() const { return series->look == Look::marks || series->look == Look::both; }
  bool has_line() const { return series->look != Look::marks; }
};

class Layout {
 public:
  /// The names of these series stand below the axes.
  Layout(const Chart& chart, const std::set<const ChartSeries*>& below)
      : chart_(chart), below_(below), scale_(chart.type * std::min(chart.width / 1280., chart.height / 960.)) {
    sheet_.width = chart.width, sheet_.height = chart.height;
    sheet_.title = chart.title;
    sheet_.told = fmt::format("{} over {}. {}", chart.y.name, chart.x.name, chart.conclusion);
    std::size_t next = 0;
    for (const ChartSeries& s : chart.series) {
      const std::size_t colour = s.colour < 0 ? next : static_cast<std::size_t>(s.colour);
      series_.push_back({&s, s.quiet ? Ink::guide : ink_of_series(colour), colour, {}, {}});
      next += !s.quiet && s.colour < 0;
    }
    std::stable_sort(series_.begin(), series_.end(),
                     [](const Drawn& a, const Drawn& b) { return a.series->quiet > b.series->quiet; });
  }

  /// Empty, or the series whose names found no place.
  std::set<const ChartSeries*> arrange() {
    const int columns = static_cast<int>(std::clamp(chart_.width / scale_(150), 2., 8.));
    const Axis x = make_axis(chart_.x, chart_.series, &ChartPoint::x, chart_.y, &ChartPoint::y, columns);
    const Axis y = make_axis(chart_.y, chart_.series, &ChartPoint::y, chart_.x, &ChartPoint::x, 8);
    const double foot = put_foot(), low = put_names(foot);
    if (chart_.grows) sheet_.height += static_cast<int>(std::ceil(low - foot));
    const double top = put_title();
    place_panel(x, y, low, top);
    put_axis_below(x);
    put_axis_beside(y);
    for (Drawn& drawn : series_) follow(drawn, x, y);
    return put_labels();
  }

  Sheet sheet() && { return std::move(sheet_); }

 private:
  using Words = Sheet::Words;

  void put_points(std::vector<Point> points, Ink ink, double width, double dash = 0) {
    sheet_.strokes.push_back({.points = std::move(points), .ink = ink, .width = width, .dash = dash});
  }

  /// Lines from `top` downwards; returns where they end.
  double put_block(const std::vector<std::string>& lines, double left, double top, int size, Ink ink) {
    for (const std::string& line : lines) {
      sheet_.words.push_back({.at = {left, top}, .text = line, .size = size, .ink = ink, .along = Along::top});
      top -= line_height * size;
    }
    return top;
  }

  /// Returns the height below it.
  double put_title() {
    if (chart_.title.empty()) return sheet_.height - scale_(8);
    const double left = edge_, width = sheet_.width - 2 * left;
    int size = scale_.font(27);
    std::vector<std::string> lines = broken(chart_.title, width, size);
    if (lines.size() > 2) size = scale_.font(20), lines = broken(chart_.title, width, size);
    constexpr std::size_t most = 4;
    if (lines.size() > most) lines.resize(most);
    return put_block(lines, left, sheet_.height - scale_(28), size, Ink::text) - scale_(22);
  }

  /// Conclusion and footer. Returns the height above them.
  double put_foot() {
    const double left = edge_, width = sheet_.width - 2 * left;
    double y = scale_(16);
    const auto block = [&](const std::string& text, int size, Ink ink) {
      std::vector<std::string> lines = broken(text, width, size);
      const auto most = static_cast<std::size_t>(std::max(1., 0.2 * sheet_.height / (line_height * size)));
      if (lines.size() > most) lines.resize(most), lines.back() += " …";
      const double height = line_height * size * static_cast<double>(lines.size());
      put_block(lines, left, y + height, size, ink);
      if (!lines.empty()) y += height + scale_(8);
    };
    block(chart_.footer, scale_.font(15), Ink::quiet);
    block(chart_.conclusion, scale_.font(19), Ink::text);
    return y;
  }

  /// Names that stand at no line, in columns, each with a sample. Returns the height above them.
  double put_names(double y) {
    std::vector<const Drawn*> named;
    const int size = scale_.font(17);
    double widest = 0;
    for (const Drawn& drawn : series_)
      if (below_.contains(drawn.series)) {
        named.push_back(&drawn);
        widest = std::max(widest, letters_width(drawn.series->name, size));
      }
    if (named.empty()) return y;
    const double sample = scale_(58), across = sheet_.width - 2 * edge_, line = line_height * size;
    const double column = std::min(widest + sample + scale_(30), across);
    const auto columns = static_cast<std::size_t>(std::max(1., std::floor(across / column)));
    const auto most = columns * static_cast<std::size_t>(std::max(1., 0.3 * sheet_.height / (1.2 * line)));
    double top = y;  // from the last row upwards
    if (named.size() > most && !chart_.grows) {
      top = y + line;
      put_block({fmt::format("and {} more", named.size() - most)}, edge_ + sample, top, size, Ink::quiet);
      named.resize(most);
    }
    const std::size_t rows = (named.size() + columns - 1) / columns;
    for (std::size_t row = rows; row-- > 0;) {
      std::size_t lines = 1;
      for (std::size_t i = row; i < named.size(); i += rows)
        lines = std::max(lines, broken(named[i]->series->name, column - sample, size).size());
      top += line * (static_cast<double>(lines) + 0.2);
      for (std::size_t i = row; i < named.size(); i += rows)
        put_name(*named[i], {edge_ + column * static_cast<double>(i / rows), top}, column - sample, size);
    }
    return top + scale_(8);
  }

  /// With a sample, from the upper left corner.
  void put_name(const Drawn& drawn, const Point& corner, double width, int size) {
    const double sample = scale_(58), y = corner.y - 0.5 * line_height * size;
    if (drawn.has_line())
      put_points({{corner.x, y}, {corner.x + sample - scale_(14), y}}, drawn.ink, width_of(drawn), dash_of(drawn));
    if (drawn.has_marks()) put_mark({corner.x + (sample - scale_(14)) / 2, y}, drawn, "");
    put_block(broken(drawn.series->name, width, size), corner.x + sample, corner.y, size, drawn.ink);
  }

  /// The area between the axes, with the widths of their numbers and names around it.
  void place_panel(const Axis& x, const Axis& y, double low, double top) {
    const int size = scale_.font(18), title = scale_.font(20);
    double widest = 0, last = 0;
    for (const Tick& tick : y.ticks.list) widest = std::max(widest, letters_width(tick.label, size));
    for (const Tick& tick : x.ticks.list) last = std::max(last, letters_width(tick.label, size) / 2);
    title_lines_ = broken(x.title(), sheet_.width - scale_(150), title);
    // The name of the upright axis is above it, where it is read without turning the head.
    const double left = edge_ + widest + scale_(13);
    const double names = line_height * title * static_cast<double>(title_lines_.size());
    heading_ = broken(y.title(), sheet_.width - 2 * edge_, title);
    const double bottom = low + names + line_height * size + scale_(30);
    const double height = top - line_height * title * static_cast<double>(heading_.size()) - scale_(14) - bottom;
    panel_ = {left, bottom, sheet_.width - left - std::max(last, scale_(30)) - scale_(12),
              std::max(height, scale_(80))};
    // Where lines end at the right, their names stand right of the panel.
    double room = 0;
    for (const Drawn& drawn : series_) {
      if (drawn.series->name.empty() || below_.contains(drawn.series)) continue;
      for (const ChartPoint& p : drawn.series->points)
        if (x.position(on_axis(chart_.x, p.x)) > 0.8 && std::isfinite(on_axis(chart_.y, p.y)))
          room = std::max(room, letters_width(drawn.series->name, scale_.font(17)) + scale_(10));
    }
    panel_.width -= std::clamp(room - scale_(30), 0., 0.25 * sheet_.width);
  }

  void put_axis_below(const Axis& x) {
    const int size = scale_.font(18), title = scale_.font(20);
    std::vector<Rectangle> numbers;
    const auto place = [&](const Tick& t) { return panel_.x + x.position(t.at) * panel_.width; };
    for (const Tick& t : x.ticks.list) {
      const double width = letters_width(t.label, size);
      numbers.push_back({place(t) - width / 2, 0, width, 1. * size});
    }
    const std::size_t every = numbered_ticks(numbers, scale_(8));
    for (std::size_t i = 0; i < x.ticks.list.size(); ++i) {
      const double at = place(x.ticks.list[i]);
      put_points({{at, panel_.y}, {at, panel_.top()}}, Ink::grid, 1);
      put_points({{at, panel_.y}, {at, panel_.y - scale_(7)}}, Ink::text, 1.3);
      if (i % every == 0)
        sheet_.words.push_back({.at = {at, panel_.y - scale_(12)},
                                .text = x.ticks.list[i].label,
                                .size = size,
                                .across = Across::centre,
                                .along = Along::top});
    }
    double below = panel_.y - scale_(16) - line_height * size;
    for (const std::string& line : title_lines_) {
      sheet_.words.push_back({.at = {panel_.x + panel_.width / 2, below},
                              .text = line,
                              .size = title,
                              .across = Across::centre,
                              .along = Along::top});
      const Rectangle box = box_of(sheet_.words.back());
      sheet_.words.back().at.x -=
          std::max(0., box.right() - (sheet_.width - scale_(8))) + std::min(0., box.x - scale_(8));
      below -= line_height * title;
    }
  }

  void put_axis_beside(const Axis& y) {
    const int size = scale_.font(18), title = scale_.font(20);
    std::vector<Rectangle> numbers;
    const auto place = [&](const Tick& t) { return panel_.y + y.position(t.at) * panel_.height; };
    for (const Tick& t : y.ticks.list) numbers.push_back({0, place(t) - line_height * size / 2, 1, line_height * size});
    const std::size_t every = numbered_ticks(numbers, 0);
    for (std::size_t i = 0; i < y.ticks.list.size(); ++i) {
      const double at = place(y.ticks.list[i]);
      put_points({{panel_.x, at}, {panel_.right(), at}}, Ink::grid, 1);
      put_points({{panel_.x, at}, {panel_.x - scale_(7), at}}, Ink::text, 1.3);
      if (i % every == 0)
        sheet_.words.push_back({.at = {panel_.x - scale_(13), at},
                                .text = y.ticks.list[i].label,
                                .size = size,
                                .across = Across::right,
                                .along = Along::centre});
    }
    put_points({{panel_.x, panel_.top()}, {panel_.x, panel_.y}, {panel_.right(), panel_.y}}, Ink::text, 1.3);
    put_block(heading_, edge_, panel_.top() + scale_(14) + line_height * title * static_cast<double>(heading_.size()),
              title, Ink::text);
  }

  double width_of(const Drawn& drawn) const { return scale_(drawn.series->quiet ? 1.6 : 2.4); }
  double dash_of(const Drawn& drawn) const { return drawn.series->look == Look::dashed ? scale_(9) : 0; }

  void put_mark(const Point& at, const Drawn& drawn, const std::string& told) {
    sheet_.signs.push_back({.at = at,
                            .radius = scale_(drawn.series->filled ? 9.5 : 7),
                            .shape = drawn.shape,
                            .ink = drawn.ink,
                            .filled = drawn.series->filled,
                            .told = told});
  }

  std::string told_of(const Drawn& drawn, const ChartPoint& p) const {
    if (!p.told.empty()) return p.told;
    std::string name = drawn.series->name;
    if (!p.label.empty()) name += (name.empty() ? "" : ", ") + p.label;
    return fmt::format("{}{}{}: {}\n{}: {}", name, name.empty() ? "" : "\n", chart_.y.name, told_number(p.y, 3),
                       chart_.x.name, told_number(p.x, 3));
  }

  /// Draws line and marks.
  void follow(Drawn& drawn, const Axis& x, const Axis& y) {
    drawn.pieces.resize(1);
    for (const ChartPoint& p : drawn.series->points) {
      const double u = x.position(on_axis(chart_.x, p.x)), v = y.position(on_axis(chart_.y, p.y));
      const bool inside = u >= -1e-9 && u <= 1 + 1e-9 && v >= -1e-9 && v <= 1 + 1e-9;  // false for NaN
      if (!inside) {
        drawn.pieces.emplace_back();
        continue;
      }
      const Point at{panel_.x + u * panel_.width, panel_.y + v * panel_.height};
      drawn.pieces.back().push_back(at);
      drawn.points.emplace_back(at, &p);
      if (drawn.has_marks()) put_mark(at, drawn, told_of(drawn, p));
    }
    for (const auto& piece : drawn.pieces)
      if (piece.size() > 1 && drawn.has_line()) put_points(piece, drawn.ink, width_of(drawn), dash_of(drawn));
  }

  /// Everything that is drawn already is taken.
  LabelPlaces places() const {
    LabelPlaces places(
        {panel_.x + scale_(4), panel_.y + scale_(4), sheet_.width - panel_.x - scale_(8), panel_.height + scale_(6)});
    for (const Drawn& drawn : series_)
      for (const auto& piece : drawn.pieces)
        for (std::size_t i = 1; drawn.has_line() && i < piece.size(); ++i) places.take(piece[i - 1], piece[i]);
    for (const Sheet::Sign& sign : sheet_.signs) {
      const Rectangle box = box_of(sign);
      const double edge = scale_(1.5);
      places.take({box.x - edge, box.y - edge, box.width + 2 * edge, box.height + 2 * edge});
    }
    return places;
  }

  /// In one line, or in several where that has no room.
  bool put_label(LabelPlaces& places, const Point& at, const std::string& text, int size, Ink ink, double furthest,
                 bool is_name) {
    const double edge = scale_(2), line = line_height * size;
    std::vector<std::string> lines{text};
    for (double width = letters_width(text, size);;) {
      const auto found = places.place(at, {.width = width + 2 * edge,
                                           .height = line * static_cast<double>(lines.size()),
                                           .gap = scale_(11),
                                           .furthest = furthest,
                                           .rightwards = is_name});
      if (found) {
        if (found->leader) put_points({found->leader->first, found->leader->second}, Ink::guide, 1);
        put_block(lines, found->box.x + edge, found->box.top(), size, ink);
        return true;
      }
      const std::vector<std::string> narrower = broken(text, 0.6 * width, size);
      if (!is_name || narrower.size() == lines.size() || narrower.size() > 3) return false;
      lines = narrower, width = 0;
      for (const std::string& part : lines) width = std::max(width, letters_width(part, size));
    }
  }

  std::set<const ChartSeries*> put_labels() {
    LabelPlaces free = places();
    std::set<const ChartSeries*> homeless;
    const double far = 0.5 * std::max(panel_.width, panel_.height), near = scale_(16);
    const auto name = [&](const Drawn& drawn) {
      const auto put = [&](std::size_t i, double furthest) {
        return put_label(free, drawn.points[i].first, drawn.series->name, scale_.font(17), drawn.ink, furthest, true);
      };
      const std::size_t last = drawn.points.size() - 1;
      if (last == 0) return put(0, far);
      const bool is_guide = drawn.series->quiet;  // leaves the ends to others
      return (is_guide && put(last / 2, scale_(60))) || put(last, scale_(60)) || put(0, scale_(60)) ||
             put(last / 2, scale_(60));
    };
    for (const bool single : {true, false})  // a line has several places for its name
      for (const Drawn& drawn : series_) {
        if (drawn.series->name.empty() || drawn.points.empty() || below_.contains(drawn.series)) continue;
        if ((drawn.points.size() == 1) == single && !name(drawn)) homeless.insert(drawn.series);
      }
    constexpr std::size_t most = 150;  // more of them nobody reads
    std::size_t tried = 0;
    for (const Drawn& drawn : series_)
      for (const auto& [at, p] : drawn.points)
        if (!p->label.empty() && tried++ < most)
          put_label(free, at, p->label, scale_.font(15), Ink::quiet, near, false);
    return homeless;
  }

  const Chart& chart_;
  const std::set<const ChartSeries*>& below_;
  Scale scale_;
  Sheet sheet_;
  std::vector<Drawn> series_;
  std::vector<std::string> title_lines_, heading_;  // of the axes
  Rectangle panel_;
  double edge_ = std::min(scale_(38), 0.03 * chart_.width);  // from the left and the right
};

}  // namespace

Sheet laid_out(const Chart& chart) {
  std::set<const ChartSeries*> below;
  for (;;) {
    Layout layout(chart, below);
    const auto homeless = layout.arrange();
    if (homeless.empty()) return std::move(layout).sheet();
    below.insert(homeless.begin(), homeless.end());
  }
}

}  // namespace gaussdrift::render
