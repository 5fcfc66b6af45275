// Charts are drawn and then read back: which colour is where.
#include "render/chart.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pictures.hpp"
#include "render/read_png.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::render {
namespace {

using DrawnChart = Drawn;

Chart power_law() {
  ChartSeries series{.name = "error"};
  for (int k = 0; k <= 4; ++k) series.points.push_back({std::pow(10., k), std::pow(10., -2. * k)});
  return {.title = "Order two",
          .x = {.name = "seconds", .logarithmic = true},
          .y = {.name = "error", .logarithmic = true},
          .series = {series}};
}

TEST(AChart, IsWrittenInFormatsThatNeedNoPicturesToo) {
  const ScratchFolder folder;
  write_chart(power_law(), folder / "order.2");
  EXPECT_EQ(folder.count(), draws_pictures ? 3u : 2u);
  for (const char* name : {"order.2.svg", "order.2.pdf"}) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
}

Image drawn(const Chart& chart) {
  const ScratchFolder folder;
  write_chart(chart, folder / "c");
  return read_png(folder / "c.png");
}

constexpr Colour first{0, 114, 178};

/// Rows, from below, of the pixels of the first series' colour in a column.
std::vector<int> rows_of(const Image& image, int x) {
  std::vector<int> rows;
  for (int y = 0; y < image.height; ++y)
    if (image.at(x, y) == first) rows.push_back(y);
  return rows;
}

TEST_F(DrawnChart, ShowsAPowerLawAsAStraightLine) {
  Chart chart = power_law();
  chart.series[0].look = ChartSeries::Look::line;
  chart.series[0].name.clear();
  const Image image = drawn(chart);
  std::vector<double> heights;
  for (const int x : {400, 600, 800, 1000}) {
    const auto rows = rows_of(image, x);
    ASSERT_FALSE(rows.empty()) << x;
    heights.push_back(0.5 * (rows.front() + rows.back()));
  }
  for (std::size_t k = 2; k < heights.size(); ++k)
    EXPECT_NEAR(heights[k] - heights[k - 1], heights[1] - heights[0], 1) << "falls by the same, to a pixel";
  EXPECT_LT(heights[1], heights[0]);
}

TEST_F(DrawnChart, LeavesOutWhatHasNoPlaceOnItsAxes) {
  Chart chart = power_law();
  const Image whole = drawn(chart);
  auto& points = chart.series[0].points;
  points.push_back({0, 1});  // no logarithm
  points.push_back({1, std::numeric_limits<double>::quiet_NaN()});
  points.push_back({-1, 1});
  EXPECT_EQ(drawn(chart).pixels, whole.pixels);
}

TEST_F(DrawnChart, OfNothingHasAxesAndNoCurve) {
  Chart chart = power_law();
  chart.series[0].points.clear();
  chart.series[0].name.clear();
  const Image image = drawn(chart);
  EXPECT_EQ(std::count(image.pixels.begin(), image.pixels.end(), first), 0);
  EXPECT_GT(std::count(image.pixels.begin(), image.pixels.end(), ink), 1000);
}

TEST_F(DrawnChart, OfOnePointIsDrawn) {
  Chart chart = power_law();
  chart.series[0].points.resize(1);
  chart.series[0].name.clear();
  const Image image = drawn(chart);
  EXPECT_GT(std::count(image.pixels.begin(), image.pixels.end(), first), 20);
}

TEST_F(DrawnChart, BreaksALongConclusionIntoLinesThatStayInside) {
  Chart chart = power_law();
  for (int k = 0; k < 60; ++k) chart.conclusion += "a word and ";
  const Image image = drawn(chart);
  for (int y = 0; y < image.height; ++y) {
    EXPECT_EQ(image.at(image.width - 3, y), white);
    EXPECT_EQ(image.at(2, y), white);
  }
}

}  // namespace
}  // namespace gaussdrift::render
