// The norms of the error over time, on a logarithmic axis.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/sections.hpp"

namespace gaussdrift::report {

namespace {

struct Curve {
  const char *name, *colour;
};
constexpr std::array<Curve, 3> curves{{{"Linf", "#d55e00"}, {"L2", "#0072b2"}, {"L1", "#009e73"}}};

/// The panel in the picture, and what it shows: times and powers of ten.
struct Panel {
  static constexpr double left = 70, top = 14, width = 560, height = 230;
  double first = INFINITY, last = -INFINITY, low = INFINITY, high = -INFINITY;

  double x(double t) const { return left + width * (t - first) / (last - first); }
  double y(double value) const { return top + height * (high - std::log10(value)) / (high - low); }
};

/// A norm that can be drawn.
bool is_shown(const json& frame, const Curve& curve) {
  return frame.contains(curve.name) && frame.at(curve.name).is_number() && frame.at(curve.name).get<double>() > 0;
}

Panel panel_of(const json& frames) {
  Panel panel;
  for (const json& frame : frames) {
    if (!frame.contains("Linf")) continue;
    panel.first = std::min(panel.first, frame.at("t").get<double>());
    panel.last = std::max(panel.last, frame.at("t").get<double>());
    for (const Curve& curve : curves)
      if (is_shown(frame, curve)) {
        panel.low = std::min(panel.low, std::log10(frame.at(curve.name).get<double>()));
        panel.high = std::max(panel.high, std::log10(frame.at(curve.name).get<double>()));
      }
  }
  return panel;
}

std::string heights(const Panel& panel) {
  const double left = Panel::left, right = Panel::left + Panel::width, low = panel.low, high = panel.high;
  std::string svg;
  // Between few powers of ten 2 and 5 times them are shown, too.
  for (double k = std::floor(low); high - low < 1.6 && k <= high; ++k)
    for (const double factor : {2., 5.})
      if (const double at = k + std::log10(factor); at >= low && at <= high)
        svg += fmt::format(
            "<line x1={0} x2={1} y1={2:.1f} y2={2:.1f} stroke=\"#eee\"/><text x={3} y={4:.1f} "
            "text-anchor=end>{5:.0f}e{6:.0f}</text>",
            left, right, panel.y(std::pow(10, at)), left - 8, panel.y(std::pow(10, at)) + 4, factor, k);
  for (double k = std::ceil(low); k <= high; ++k)
    svg += fmt::format(
        "<line x1={0} x2={1} y1={2:.1f} y2={2:.1f} stroke=\"#ddd\"/><text x={3} y={4:.1f} "
        "text-anchor=end>1e{5:.0f}</text>",
        left, right, panel.y(std::pow(10, k)), left - 8, panel.y(std::pow(10, k)) + 4, k);
  return svg;
}

/// Round times, four to eight of them.
std::string times(const Panel& panel) {
  const double span = panel.last - panel.first, bottom = Panel::top + Panel::height;
  const double power = std::pow(10, std::floor(std::log10(span / 4)));
  const double step = span / power >= 40   ? 10 * power
                      : span / power >= 20 ? 5 * power
                      : span / power >= 8  ? 2 * power
                                           : power;
  std::string svg;
  const double begin = std::ceil(panel.first / step - 1e-9);
  for (int i = 0; i < 20; ++i) {  // where a step is below the rounding of the times, adding to k would change nothing
    const double k = begin + i;
    if (!(k * step <= panel.last + 1e-9 * step)) break;
    svg += fmt::format(
        "<line x1={0:.1f} x2={0:.1f} y1={1} y2={2} stroke=\"#888\"/><text x={0:.1f} y={3} "
        "text-anchor=middle>{4:.6g}</text>",
        panel.x(k * step), bottom, bottom + 5, bottom + 20, k == 0 ? 0 : k * step);
  }
  return svg + fmt::format("<text x={} y={} text-anchor=middle>t</text>", Panel::left + Panel::width / 2, bottom + 40) +
         fmt::format("<text transform=\"translate(14 {}) rotate(-90)\" text-anchor=middle>relative error</text>",
                     Panel::top + Panel::height / 2);
}

/// With its name at the height `key`.
std::string curve_over_time(const json& frames, const Panel& panel, const Curve& curve, double key) {
  std::string points, svg;
  for (const json& frame : frames)
    if (is_shown(frame, curve)) {
      const double a = panel.x(frame.at("t").get<double>()), b = panel.y(frame.at(curve.name).get<double>());
      points += fmt::format("{:.1f},{:.1f} ", a, b);
      if (frames.size() <= 60) svg += fmt::format("<circle cx={:.1f} cy={:.1f} r=3 fill=\"{}\"/>", a, b, curve.colour);
    }
  return svg +
         fmt::format(
             "<polyline points=\"{}\" fill=none stroke=\"{}\" stroke-width=2 /><text x={} y={} fill=\"{}\">{}</text>",
             points, curve.colour, Panel::left + Panel::width + 12, key, curve.colour, curve.name);
}

}  // namespace

std::string error_curves(const json& frames) {
  Panel panel = panel_of(frames);
  if (!(panel.last > panel.first) || !(panel.high >= panel.low)) return "";
  panel.low = std::floor(panel.low * 2 - 0.1) / 2, panel.high = std::ceil(panel.high * 2 + 0.1) / 2;
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 720 300\" role=img aria-label=\"errors over time\"><rect x={} y={} width={} height={} "
      "fill=none stroke=\"#888\"/>",
      Panel::left, Panel::top, Panel::width, Panel::height);
  svg += heights(panel) + times(panel);
  double key = Panel::top + 18;
  for (const Curve& curve : curves) {
    svg += curve_over_time(frames, panel, curve, key);
    key += 26;
  }
  return svg + "</svg>";
}

}  // namespace gaussdrift::report
