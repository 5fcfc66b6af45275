// The norms of the error over time, on a logarithmic axis.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/chart_page.hpp"
#include "render/ticks.hpp"
#include "report/sections.hpp"

namespace gaussdrift::report {

std::string error_curves(const json& frames) {
  struct Curve {
    const char* name;
    int colour;
  };
  constexpr std::array<Curve, 3> curves{{{"Linf", 1}, {"L2", 0}, {"L1", 2}}};
  render::Chart chart{.title = "Errors over time",
                      .x = {.name = "time t"},
                      .y = {.name = "relative error", .logarithmic = true},
                      .series = {}};
  double first = INFINITY, last = -INFINITY;
  constexpr std::size_t most_marks = 60;
  for (const Curve& curve : curves) {
    render::ChartSeries series{
        .name = curve.name,
        .points = {},
        .look = frames.size() <= most_marks ? render::ChartSeries::Look::both : render::ChartSeries::Look::line,
        .colour = curve.colour};
    for (const json& frame : frames) {
      const json value = get(frame, curve.name);
      if (!frame.contains("Linf") || !value.is_number()) continue;
      const double time = frame.at("t").get<double>(), error = value.get<double>();
      first = std::min(first, time), last = std::max(last, time);
      series.points.push_back(
          {time, error, "",
           fmt::format("t = {}: {} {}", render::number(time, 5), curve.name, render::told_number(error, 3))});
    }
    const bool seen = std::any_of(series.points.begin(), series.points.end(), [](const auto& p) { return p.y > 0; });
    if (seen) chart.series.push_back(std::move(series));
  }
  if (!(last > first) || chart.series.empty()) return "";
  constexpr int height = 400;
  return render::chart_figure(chart, height);
}

}  // namespace gaussdrift::report
