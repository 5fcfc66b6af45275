// Charts: curves and points over linear or logarithmic axes. A line's name stands at its end, in its colour, and no
// label covers a point, a line or another label.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "render/sheet.hpp"

namespace gaussdrift::render {

struct ChartAxis {
  std::string name;  // with its unit
  bool logarithmic = false;
  std::array<double, 2> range{};  // shown; equal ends: what the points need
};

struct ChartPoint {
  double x = 0, y = 0;
  std::string label{};  // beside the point; left out where there is no room near it
  std::string told{};   // what who points at it reads; empty: its series, label and numbers
};

/// Points in the order in which a line joins them. A point that is not finite, or not positive on a logarithmic axis,
/// interrupts the line and is not drawn.
struct ChartSeries {
  enum class Look { line, marks, both, dashed };
  std::string name;  // at the end of the line, or beside a single point; where there is no room, below the axes
  std::vector<ChartPoint> points{};
  Look look = Look::both;
  bool quiet = false;   // grey and thin, behind the others: a guide
  bool filled = false;  // its marks
  int colour = -1;      // of the series' colours and shapes; below 0: the next one
};

struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartSeries> series;
  std::string conclusion{};  // below the axes, broken into lines
  std::string footer{};      // small, below that
  int width = 1280, height = 960;
  bool grows = false;  // by the height of names that stand below the axes
  double type = 1;     // how many times as large as usual letters, marks and margins are
};

/// Nothing of it depends on the machine.
Sheet laid_out(const Chart& chart);

/// The endings of the files of a chart: ".png" where pictures can be drawn, ".svg", ".pdf".
std::vector<std::string_view> chart_endings();

/// Writes the chart in all of these formats, each beside its name, and renames it. `file` has no ending. Throws
/// FileError.
void write_chart(const Chart& chart, const std::filesystem::path& file);

}  // namespace gaussdrift::render
