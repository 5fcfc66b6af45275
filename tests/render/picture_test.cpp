// Pictures are drawn and then read back: what is where, in which colour.
#include "render/picture.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <set>
#include <thread>
#include <vector>

#include "base/nan.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "pictures.hpp"
#include "render/axes.hpp"
#include "render/contour_lines.hpp"
#include "render/drawn.hpp"
#include "render/read_png.hpp"
#include "render/styles.hpp"
#include "scratch_folder.hpp"
#include "write/disk.hpp"

namespace gaussdrift::render {
namespace {

using Picture = Drawn;
using Heatmap = Drawn;
using Surface = Drawn;
using ContourPicture = Drawn;

std::vector<Style> flat_styles() {
  std::vector<Style> flat;
  for (const Style& style : styles())
    if (style.about.shows(2) && !style.about.shows_error) flat.push_back(style);
  return flat;
}
using base::nan;

DensityGrid sampled(const Vector& min, const Vector& max, int per_axis,
                    const std::function<double(double, double)>& rho) {
  DensityGrid density{make_lattice(2, min, max, per_axis), {}};
  const Lattice& lattice = density.lattice;
  for (std::size_t j = 0; j < lattice.points[1]; ++j)
    for (std::size_t i = 0; i < lattice.points[0]; ++i)
      density.rho.push_back(rho(lattice.coordinate(0, i), lattice.coordinate(1, j)));
  // A rotation about the middle, for the styles that show a velocity.
  FieldOnGrid velocity{"velocity", 2, {}};
  const auto from_middle = [&](std::size_t k, std::size_t i) {
    return static_cast<double>(i) - 0.5 * static_cast<double>(lattice.points[k] - 1);
  };
  for (std::size_t j = 0; j < lattice.points[1]; ++j)
    for (std::size_t i = 0; i < lattice.points[0]; ++i)
      velocity.values.push_back(-from_middle(1, j)), velocity.values.push_back(from_middle(0, i));
  density.fields = {velocity};
  return density;
}

double wendland(double s) { return s < 1 ? std::pow(1 - s, 4) * (4 * s + 1) : 0; }

DensityGrid cone(double x, double y, double height = 1, double radius = 0.25) {
  return sampled({-1, -1, 0}, {1, 1, 0}, 101,
                 [=](double p, double q) { return height * wendland(std::hypot(p - x, q - y) / radius); });
}

TEST(WithoutPictures, APictureSaysWhyItCannotBeDrawn) {
  if (draws_pictures) GTEST_SKIP() << "built with pictures";
  EXPECT_NE(unavailable_reason().find("no pictures"), std::string::npos);
  EXPECT_THROW(check_available(), CommandLineError);
  const ScratchFolder folder;
  EXPECT_THROW(draw(find_style("surface"), cone(0, 0), {}, folder / "p.png"), CommandLineError);
  EXPECT_EQ(folder.count(), 0u);
}

int distance(const Colour& a, const Colour& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// The smallest rectangle with all pixels of a colour.
struct Found {
  int left, right, bottom, top;
};

/// Where the heatmap of this shape is in the picture: drawn without a single number, it is all red.
Found heatmap_panel(DensityGrid density) {
  std::fill(density.rho.begin(), density.rho.end(), nan);
  const Image image = drawn(find_style("heatmap"), density);
  // The heading tells the number of missing values in the same red, above the panel.
  Found found{image.width, -1, image.height, -1};
  for (int y = 0; y < image.height - 110; ++y)
    for (int x = 0; x < image.width; ++x)
      if (image.at(x, y) == not_a_number)
        found = {std::min(found.left, x), std::max(found.right, x), std::min(found.bottom, y), std::max(found.top, y)};
  return found;
}

TEST_F(Picture, IsAvailable) { EXPECT_EQ(unavailable_reason(), ""); }

TEST_F(Picture, HasTheSizeAskedForAndIsNotBlank) {
  for (const Style& style : flat_styles()) {
    const Image image = drawn(style, cone(0.5, 0), {.title = "Rotating cone", .time = 1.5});
    EXPECT_EQ(image.width, 1280);
    EXPECT_EQ(image.height, 960);
    EXPECT_GT(colours_of(image), 100u);
    EXPECT_EQ(image.at(2, 2), white);
    EXPECT_EQ(image.at(1277, 957), white);
    const Image small = drawn(style, cone(0.5, 0), {.width = 400, .height = 300});
    EXPECT_EQ(small.width, 400);
    EXPECT_EQ(small.height, 300);
    EXPECT_GT(colours_of(small), 50u);
  }
}

TEST_F(Picture, LeavesItsMarginsWhite) {
  const auto far =
      sampled({1e6, -3e6, 0}, {1e6 + 1, -3e6 + 0.6, 0}, 60, [](double x, double) { return 1e-7 * (x - 1e6); });
  for (const Style& style : flat_styles())
    for (const auto& [density, options] :
         {std::pair{cone(-0.5, 0.3), PictureOptions{.title = std::string(300, 'W'), .time = 123456.789}},
          {far, PictureOptions{.title = "Far", .time = 1e-12, .range_max = 1e-7}}}) {
      const Image image = drawn(style, density, options);
      const auto inner = [](int at, int size) { return at >= 8 && at < size - 8; };
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
          ASSERT_TRUE((inner(x, image.width) && inner(y, image.height)) || image.at(x, y) == white)
              << x << ", " << y << " style " << style.about.name;
    }
}

TEST_F(Picture, OfTheSameInputIsIdentical) {
  for (const Style& style : flat_styles()) {
    const Image first = drawn(style, cone(0.5, 0), {.title = "Rotating cone"});
    drawn(find_style("surface"), cone(-0.5, 0.5), {.title = "between", .width = 640, .height = 480});
    EXPECT_EQ(drawn(style, cone(0.5, 0), {.title = "Rotating cone"}).pixels, first.pixels);
  }
}

TEST_F(Picture, OfAnotherInputDiffers) {
  for (const Style& style : flat_styles()) {
    const Image first = drawn(style, cone(0.5, 0));
    EXPECT_NE(drawn(style, cone(0.3, 0)).pixels, first.pixels);
    EXPECT_NE(drawn(style, cone(0.5, 0, 0.7)).pixels, first.pixels);
    EXPECT_NE(drawn(style, cone(0.5, 0), {.title = "title"}).pixels, first.pixels);
    EXPECT_NE(drawn(style, cone(0.5, 0), {.time = 1}).pixels, first.pixels);
  }
}

TEST_F(Heatmap, IsBrightestWhereTheDensityIsLargest) {
  for (const auto& [x, y] : {std::pair{0.5, 0.}, {-0.5, 0.6}, {0., -0.7}}) {
    const auto density = cone(x, y);
    const Found panel = heatmap_panel(density);
    EXPECT_EQ(panel.right - panel.left, panel.top - panel.bottom) << "equal aspect";
    const Image image = drawn(find_style("heatmap"), density);
    double brightest = -1, sum_x = 0, sum_y = 0, count = 0;  // the middle of a top that is flat to 1/255
    for (int q = panel.bottom + 3; q < panel.top - 3; ++q)
      for (int p = panel.left + 3; p < panel.right - 3; ++p) {
        const double light = 0.2126 * image.at(p, q)[0] + 0.7152 * image.at(p, q)[1];
        if (light > brightest) brightest = light, sum_x = sum_y = count = 0;
        if (light == brightest) sum_x += p, sum_y += q, ++count;
      }
    EXPECT_NEAR(sum_x / count, panel.left + (x + 1) / 2 * (panel.right - panel.left), 1);  // a pixel
    EXPECT_NEAR(sum_y / count, panel.bottom + (y + 1) / 2 * (panel.top - panel.bottom), 1);
  }
}

TEST_F(Heatmap, GivesAValueTheSameColourInEveryFrame) {
  // Half of the domain has 0.5; the other half something else in each frame.
  const auto density = [](double other) {
    return sampled({-1, -1, 0}, {1, 1, 0}, 51, [=](double x, double) { return x < 0 ? 0.5 : other; });
  };
  const Found panel = heatmap_panel(density(0));
  const int x = panel.left + (panel.right - panel.left) / 4, y = (panel.bottom + panel.top) / 2;
  const int other_x = panel.left + 3 * (panel.right - panel.left) / 4;
  for (const double other : {0., 0.3, 1., 40.}) {
    const Image image = drawn(find_style("heatmap"), density(other));
    EXPECT_EQ(image.at(x, y), viridis(0.5));
    EXPECT_EQ(image.at(other_x, y), viridis(other)) << "beyond the range: the colour of its end";
  }
  EXPECT_EQ(drawn(find_style("heatmap"), density(1), {.range_max = 2}).at(x, y), viridis(0.25));
}

TEST_F(Heatmap, KeepsTheShapeOfTheDomain) {
  const auto zero = [](double, double) { return 0.; };
  const Found wide = heatmap_panel(sampled({0, 0, 0}, {2, 1, 0}, 101, zero));
  EXPECT_NEAR((wide.right - wide.left) / static_cast<double>(wide.top - wide.bottom), 2,
              0.01);  // sides in whole pixels
  const Found tall = heatmap_panel(sampled({0, 0, 0}, {1e-9, 3e-9, 0}, 91, zero));
  EXPECT_NEAR((tall.top - tall.bottom) / static_cast<double>(tall.right - tall.left), 3, 0.04);
}

TEST_F(Surface, RaisesTheTopWithTheDensity) {
  const auto top_of = [](double height) {
    const Image image = drawn(find_style("surface"), cone(0.5, 0, height), {.range_max = 1});
    // The highest pixel of the colours of the cone, left of the colour bar.
    for (int y = 800; y > 0; --y)
      for (int x = 300; x < 1000; ++x)
        if (const Colour& c = image.at(x, y); c[1] > c[0] + 25 && c[1] > 60) return y;
    return 0;
  };
  const int half = top_of(0.5), full = top_of(1);
  EXPECT_GT(full, half + 40);
  EXPECT_GT(half, 100);
}

TEST(Axis, NumbersOnlyTicksWhoseNumbersDoNotTouch) {
  const auto row = [](std::size_t count, double apart) {
    std::vector<Rectangle> numbers;
    for (std::size_t i = 0; i < count; ++i) numbers.push_back({apart * static_cast<double>(i), 0, 30, 18});
    return numbers;
  };
  EXPECT_EQ(numbered_ticks({}, 2), 1u);
  EXPECT_EQ(numbered_ticks(row(1, 0), 2), 1u);
  EXPECT_EQ(numbered_ticks(row(5, 40), 2), 1u);
  EXPECT_EQ(numbered_ticks(row(5, -40), 2), 1u) << "from the right to the left";
  EXPECT_EQ(numbered_ticks(row(5, 31), 2), 2u);
  EXPECT_EQ(numbered_ticks(row(5, 8.1), 2), 4u);
  EXPECT_EQ(numbered_ticks(row(5, 1), 2), 5u) << "the first alone";
  EXPECT_EQ(numbered_ticks({{0, 0, 30, 18}, {1, 21, 30, 18}}, 2), 1u) << "one above the other";
}

// At 100 : 1 there is room for one number at the short side.
TEST_F(Surface, OfANarrowDomainHasNumbersThatDoNotOverlap) {
  const auto zero = [](double, double) { return 0.; };
  const Image image = drawn(find_style("surface"), sampled({0, 0, 0}, {100, 1, 0}, 101, zero));
  int low = image.height, high = 0;  // of what is written beside the right corner, right of the box and of its ticks
  for (int x = 1094; x < 1120; ++x)
    for (int y = 100; y < 300; ++y)
      if (distance(image.at(x, y), white) > 100) low = std::min(low, y), high = std::max(high, y);
  EXPECT_GT(high - low, 8) << "a number";
  EXPECT_LE(high - low, 16) << "of one line";
}

TEST(Contour, LinesOfAConeAreCircles) {
  const auto density = sampled({-1, -1, 0}, {1, 1, 0}, 401,
                               [](double x, double y) { return std::max(0., 1 - std::hypot(x - 0.5, y) / 0.25); });
  const HeightField field = make_height_field(density, {0, 1}, 1000);
  const auto lines = contour_lines(field, {0.2, 0.5, 0.8});
  ASSERT_EQ(lines.size(), 3u);  // closed, each in one piece
  for (const auto& [level, points] : lines) {
    EXPECT_EQ(points.front().x, points.back().x);
    // Linear interpolation of a function with the second derivative 1/r errs by h^2 / (8 r); values are floats.
    const double spacing = 5e-3, radius = 0.25 * (1 - level);
    const double bound = spacing * spacing / (8 * (radius - spacing)) + 1e-7;
    for (const Point& p : points)  // the scene is half as large as the domain
      EXPECT_NEAR(std::hypot(2 * p.x - 1 - 0.5, 2 * p.y - 1), radius, bound);
  }
}

TEST(Contour, LevelsAreRoundInsideTheRangeAndNeverZero) {
  const std::vector<double> expected{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  const auto levels = contour_levels({0, 1});
  ASSERT_EQ(levels.size(), expected.size());
  for (std::size_t i = 0; i < levels.size(); ++i) EXPECT_DOUBLE_EQ(levels[i], expected[i]);
  for (const ColourRange range : {ColourRange{-0.2, 1}, {0, 0.35}, {0, 1e-9}, {-5, 5}, {3, 4}}) {
    const auto list = contour_levels(range);
    EXPECT_GE(list.size(), 5u);
    EXPECT_LE(list.size(), 15u);
    for (const double level : list) {
      EXPECT_GT(level, range.min);
      EXPECT_LT(level, range.max);
      EXPECT_GT(std::fabs(level), 1e-3 * (range.max - range.min));
    }
  }
}

TEST_F(ContourPicture, OfAConeFallsWithinItsPanelFromAboveAndAtItsHeightsFromTheSide) {
  const Image image = drawn(find_style("contour"), cone(0.5, 0));
  // The line of 0.5 in both halves, well above the colour bar. A ring on the left, one level line on the right.
  const Colour colour = viridis(0.5);
  int left_low = 2000, left_high = 0, right_low = 2000, right_high = 0;
  for (int y = 180; y < 850; ++y)
    for (int x = 0; x < 1280; ++x)
      if (distance(image.at(x, y), colour) <= 2) {
        int& low = x < 640 ? left_low : right_low;
        int& high = x < 640 ? left_high : right_high;
        low = std::min(low, y), high = std::max(high, y);
      }
  EXPECT_GT(left_high - left_low, 100) << "a circle";
  EXPECT_LE(right_high - right_low, 3) << "seen edge-on, a line of 3 pixels";
  EXPECT_GT(right_low, left_low) << "at half the height";
}

TEST_F(Picture, OfUnusualDomainsIsDrawn) {
  const auto bump = [](double cx, double cy, double radius) {
    return [=](double x, double y) { return wendland(std::hypot(x - cx, y - cy) / radius); };
  };
  const std::vector<DensityGrid> domains{
      sampled({0, 0, 0}, {2, 1, 0}, 80, bump(1, 0.5, 0.3)),
      sampled({0, 0, 0}, {100, 100, 0}, 80, bump(50, 50, 20)),
      sampled({1e6, 1e6, 0}, {1e6 + 1, 1e6 + 1, 0}, 80, bump(1e6 + 0.5, 1e6 + 0.5, 0.3)),
      sampled({0, 0, 0}, {1e-9, 1e-9, 0}, 80, bump(5e-10, 5e-10, 3e-10)),
      sampled({0, 0, 0}, {1, 50, 0}, 200, bump(0.5, 25, 0.5)),
      sampled({0, 0, 0}, {1, 1e-3, 0}, 20, bump(0.5, 0, 0.5)),  // one point across
      sampled({0, 0, 0}, {1, 1, 0}, 2, bump(0, 0, 0.5)),
      sampled({-1e300, -1e300, 0}, {1e300, 1e300, 0}, 20, [](double x, double) { return x > 0 ? 1. : 0.; }),
  };
  for (std::size_t i = 0; i < domains.size(); ++i)
    for (const Style& style : flat_styles())
      EXPECT_GT(colours_of(drawn(style, domains[i], {.width = 640, .height = 480})), 50u) << "domain " << i;
}

TEST_F(Picture, OfUnusualDensitiesIsDrawn) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto filled = [](double a, double b) {
    return sampled({-1, -1, 0}, {1, 1, 0}, 30, [=](double x, double y) { return x * x + y * y < 0.25 ? a : b; });
  };
  const PictureOptions small{.width = 320, .height = 240};
  for (const Style& style : flat_styles()) {
    for (const double a : {0., 1., nan, infinity, -infinity, 1e300, 1e-320})
      for (const double b : {0., nan, -infinity})
        EXPECT_GT(colours_of(drawn(style, filled(a, b), small)), 30u) << a << " " << b;
    for (const auto& [low, high] :
         {std::pair{0., 0.}, {1., 0.}, {nan, 1.}, {0., infinity}, {0., 1e-320}, {-1e300, 1e300}})
      EXPECT_GT(
          colours_of(drawn(style, filled(0.5, 0), {.range_min = low, .range_max = high, .width = 320, .height = 240})),
          30u)
          << low << " " << high;
  }
}

TEST_F(Picture, TakesAnyTitle) {
  for (const char* title :
       {"", " ", "line\nbreak", "\xFF\xC3 broken UTF-8", "\u03B5 = 2h, \u222B\u03C1 dx", "$x^2$ $y$", "50 % <b>&</b>"})
    EXPECT_GT(colours_of(drawn(find_style("heatmap"), cone(0, 0), {.title = title, .width = 320, .height = 240})), 30u)
        << title;
}

TEST_F(Picture, RefusesWhatItCannotShow) {
  const ScratchFolder folder;
  auto density = cone(0, 0);
  density.rho.pop_back();
  EXPECT_THROW(draw(find_style("heatmap"), density, {}, folder / "p.png"), Error);
  const DensityGrid solid{make_lattice(3, {0, 0, 0}, {1, 1, 1}, 3), std::vector<double>(27)};
  EXPECT_THROW(draw(find_style("surface"), solid, {}, folder / "p.png"), Error);
  EXPECT_THROW(draw(find_style("surface"), cone(0, 0), {.width = 0}, folder / "p.png"), Error);
  EXPECT_EQ(folder.count(), 0u);
  EXPECT_GT(colours_of(drawn(find_style("surface"), cone(0, 0))), 100u) << "and the next picture is none the worse";
}

TEST_F(Picture, KeepsTheOldFileOnAFullDisk) {
  const ScratchFolder folder;
  draw(find_style("heatmap"), cone(0, 0), {}, folder / "p.png");
  const std::string old = read_file(folder / "p.png");
  std::string text;
  {
    const FileSizeLimit limit(1000);
    text = message_of<FileError>([&] { draw(find_style("heatmap"), cone(0.5, 0), {}, folder / "p.png"); });
  }
  EXPECT_NE(text.find("p.png: File too large"), std::string::npos) << text;
  EXPECT_EQ(read_file(folder / "p.png"), old);
  EXPECT_EQ(folder.count(), 1u);
}

TEST_F(Picture, MayBeDrawnByAnotherThread) {
  const Image here = drawn(find_style("surface"), cone(0.5, 0));
  Image there;
  std::thread([&] { there = drawn(find_style("surface"), cone(0.5, 0)); }).join();
  EXPECT_EQ(there.pixels, here.pixels);
  EXPECT_EQ(drawn(find_style("surface"), cone(0.5, 0)).pixels, here.pixels);
}

/// This program once more, with next to no environment: no DISPLAY, and a home that cannot be written or created.
TEST_F(Picture, NeedsNeitherDisplayNorHome) {
  const pid_t child = fork();
  if (child == 0) {
    const char* program = "/proc/self/exe";
    const char* filter = "--gtest_filter=Picture.HasTheSizeAskedForAndIsNotBlank";
    const char* const arguments[] = {program, filter, "--gtest_brief=1", nullptr};
    const char* const environment[] = {"PATH=/usr/bin:/bin", "HOME=/proc/none", "XDG_CACHE_HOME=/proc/none",
                                       "ASAN_OPTIONS=detect_leaks=0", nullptr};
    execve(program, const_cast<char* const*>(arguments), const_cast<char* const*>(environment));
    _exit(127);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace gaussdrift::render
