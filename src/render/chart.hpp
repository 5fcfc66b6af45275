// Charts: curves and points over linear or logarithmic axes, drawn like all other pictures.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace gaussdrift::render {

struct ChartAxis {
  std::string name;  // with its unit
  bool logarithmic = false;
  std::array<double, 2> range{};  // shown; equal ends: what the points need
};

struct ChartPoint {
  double x = 0, y = 0;
  std::string label{};  // beside the point; left out where it would cover another
};

/// Points in the order in which a line joins them. A point that is not finite, or not positive on a logarithmic axis,
/// interrupts the line and is not drawn.
struct ChartSeries {
  enum class Look { line, marks, both, dashed };
  std::string name;  // in the legend; empty: not there
  std::vector<ChartPoint> points{};
  Look look = Look::both;
  bool quiet = false;  // grey and thin, behind the others: a guide
};

struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartSeries> series;
  std::string conclusion{};  // below the axes, broken into lines
  std::string footer{};      // small, below that
  int width = 1280, height = 960;
};

/// Writes a PNG beside its name and renames it. Throws FileError; CommandLineError where pictures cannot be
/// drawn (picture.hpp, check_available()).
void draw_chart(const Chart& chart, const std::filesystem::path& png);

}  // namespace gaussdrift::render
