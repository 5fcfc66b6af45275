// Where things are in a chart: its labels cover nothing, whatever the data.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "pictures.hpp"
#include "render/chart.hpp"
#include "render/label_places.hpp"
#include "render/letters.hpp"

namespace gaussdrift::render {
namespace {

using Look = ChartSeries::Look;

struct Size {
  int width, height;
  double type;
};
constexpr Size sizes[] = {{1280, 960, 1}, {940, 620, 1.1}, {370, 430, 2.5}, {640, 200, 2}};

/// Curves and points of many kinds: falling lines as in a study, clouds, all points in one place, huge and tiny numbers.
Chart any_chart(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967295.); };
  const Size size = sizes[seed % std::size(sizes)];
  Chart chart{.title = "What the chart shows, in a title that may have to be broken into several lines",
              .x = {.name = "seconds of all that was done for it", .logarithmic = seed % 3 != 0},
              .y = {.name = "error, relative to the largest density", .logarithmic = seed % 5 != 0},
              .series = {},
              .conclusion = "A conclusion of some words.",
              .footer = "a footer",
              .width = size.width,
              .height = size.height};
  chart.type = size.type;
  chart.grows = size.width < 400;
  const auto count = static_cast<int>(uniform(1, seed % 7 == 0 ? 30 : 9));
  const double decades = uniform(0.01, 12);
  for (int s = 0; s < count; ++s) {
    ChartSeries series{.name = "name" + std::to_string(s) + (s % 4 == 3 ? " and more words for it" : "")};
    series.look = static_cast<Look>(random() % 4);
    series.quiet = s == 0 && seed % 2 == 0;
    series.filled = random() % 4 == 0;
    const auto points = static_cast<int>(uniform(1, seed % 11 == 0 ? 200 : 12));
    for (int i = 0; i < points; ++i) {
      const double x = uniform(0, 1), u = seed % 4 == 0 ? x : double(i) / points;
      const double at = seed % 13 == 0 ? 0.5 : u, value = seed % 13 == 0 ? 0.5 : 1 - 0.8 * u + uniform(-0.1, 0.1);
      series.points.push_back(
          {std::pow(10., decades * at - 3), std::pow(10., decades * value - 9), i % 2 ? "" : std::to_string(i * 25)});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

bool is_data(const Sheet::Stroke& stroke) {
  const bool is_leader = stroke.ink == Ink::guide && stroke.width == 1;
  return !is_leader && stroke.ink != Ink::grid && stroke.ink != Ink::text;
}

/// What is wrong with the places of the words; empty: nothing.
std::string fault(const Sheet& sheet) {
  for (std::size_t i = 0; i < sheet.words.size(); ++i) {
    const Rectangle box = box_of(sheet.words[i]);
    const std::string& text = sheet.words[i].text;
    if (box.x < -1 || box.y < -1 || box.right() > sheet.width + 1 || box.top() > sheet.height + 1)
      return text + " leaves the picture";
    for (std::size_t k = 0; k < i; ++k)
      if (overlap(box, box_of(sheet.words[k]))) return text + " is over " + sheet.words[k].text;
    for (const Sheet::Sign& sign : sheet.signs)
      if (overlap(box, box_of(sign))) return text + " is over a mark";
    for (const Sheet::Stroke& stroke : sheet.strokes)
      for (std::size_t k = 1; is_data(stroke) && k < stroke.points.size(); ++k)
        if (meets(box, stroke.points[k - 1], stroke.points[k])) return text + " is over a line";
  }
  return "";
}

TEST(LabelsOfAChart, CoverNothingWhateverTheDataAre) {
  std::size_t labels = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const Sheet sheet = laid_out(any_chart(seed));
    ASSERT_EQ(fault(sheet), "") << "chart " << seed;
    labels += sheet.words.size();
  }
  EXPECT_GT(labels, 400u * 20) << "what is not there covers nothing, either";
}

TEST(LabelsOfAChart, NameEveryLine) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    if (seed % std::size(sizes) == 3) continue;  // too flat for a list of names
    const Chart chart = any_chart(seed);
    const Sheet sheet = laid_out(chart);
    for (const ChartSeries& series : chart.series) {
      const std::string first = series.name.substr(0, series.name.find(' '));
      EXPECT_TRUE(
          std::any_of(sheet.words.begin(), sheet.words.end(),
                      [&](const Sheet::Words& words) { return words.text.substr(0, words.text.find(' ')) == first; }))
          << "chart " << seed << ": " << series.name;
    }
  }
}

TEST(LabelsOfAChart, StandAtTheEndsOfLinesThatAreApart) {
  Chart chart{.title = "Lines",
              .x = {.name = "x"},
              .y = {.name = "y"},
              .series = {{.name = "one", .points = {{0, 0}, {1, 1}}, .look = Look::line},
                         {.name = "two", .points = {{0, 0}, {1, 2}}, .look = Look::line}}};
  const Sheet sheet = laid_out(chart);
  for (const ChartSeries& series : chart.series) {
    const auto words = std::find_if(sheet.words.begin(), sheet.words.end(),
                                    [&](const Sheet::Words& each) { return each.text == series.name; });
    ASSERT_NE(words, sheet.words.end());
    const auto line = std::find_if(sheet.strokes.begin(), sheet.strokes.end(), [&](const Sheet::Stroke& stroke) {
      return is_data(stroke) && stroke.ink == words->ink;
    });
    ASSERT_NE(line, sheet.strokes.end()) << "in its colour";
    const Point end = line->points.back();
    const Rectangle box = box_of(*words);
    EXPECT_NEAR(box.x, end.x, 20);
    EXPECT_NEAR(box.y + box.height / 2, end.y, 1);
  }
}

TEST(Boxes, MeetPiecesOfLinesThatEnterThem) {
  const Rectangle box{1, 1, 2, 1};
  EXPECT_TRUE(meets(box, {0, 0}, {4, 3})) << "through it";
  EXPECT_TRUE(meets(box, {1.5, 1.5}, {1.6, 1.6})) << "within";
  EXPECT_TRUE(meets(box, {0, 1.5}, {5, 1.5}));
  EXPECT_FALSE(meets(box, {0, 0}, {0.5, 5}));
  EXPECT_FALSE(meets(box, {0, 1}, {5, 1})) << "along its edge";
  EXPECT_FALSE(meets(box, {0, 2.2}, {0.9, 4}));
  EXPECT_FALSE(meets(box, {4, 1.5}, {5, 1.5})) << "ends before it";
}

using DrawnLetters = Drawn;

TEST_F(DrawnLetters, TakeNoMoreRoomThanIsKeptForThem) {
  for (const char* text : {"seconds of seeding, transport and density", "10⁻¹²", "gauss8, overlap 2", "σ = 0.5",
                           "WWWWiiii{}%", "recommended: --accuracy 0.1: 2.4·10⁻² in 0.0012 s"})
    for (const int size : {12, 18, 27}) {
      const double drawn = Canvas::text_width(text, size), kept = letters_width(text, size);
      EXPECT_LE(drawn, 1.02 * kept + 2) << text;
      EXPECT_GE(drawn, 0.85 * kept - 2) << text;
    }
}

TEST(Letters, AreMadeWellFormed) {
  EXPECT_EQ(well_formed("a\xff"
                        "b\x01"
                        "c\nd\u00e9"),
            "a?b c\nd\u00e9");
  EXPECT_EQ(well_formed("\xed\xa0\x80"), "?") << "half of a surrogate pair is no letter";
  EXPECT_EQ(broken("one two three", letters_width("one two", 10), 10), (std::vector<std::string>{"one two", "three"}));
}

}  // namespace
}  // namespace gaussdrift::render
