// Pictures of densities in space: drawn, read back, and looked at where the density should be.
#include "render/solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "base/nan.hpp"
#include "gaussdrift/error.hpp"
#include "pictures.hpp"
#include "render/drawn.hpp"
#include "render/read_png.hpp"
#include "render/styles.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::render {
namespace {

using SlicesAndProjection = Drawn;
using Projection = Drawn;
using Slices = Drawn;
using ErrorPicture = Drawn;
using Isosurface = Drawn;
using SolidPicture = Drawn;

using base::nan;

DensityGrid sampled(const Vector& min, const Vector& max, int per_axis,
                    const std::function<double(double, double, double)>& rho) {
  DensityGrid density{make_lattice(3, min, max, per_axis), {}};
  const Lattice& lattice = density.lattice;
  for (std::size_t k = 0; k < lattice.points[2]; ++k)
    for (std::size_t j = 0; j < lattice.points[1]; ++j)
      for (std::size_t i = 0; i < lattice.points[0]; ++i)
        density.rho.push_back(rho(lattice.coordinate(0, i), lattice.coordinate(1, j), lattice.coordinate(2, k)));
  return density;
}

DensityGrid ball(double x, double y, double z, double height = 1) {
  return sampled({0, 0, 0}, {1, 1, 1}, 33, [=](double p, double q, double r) {
    const double s = std::sqrt((p - x) * (p - x) + (q - y) * (q - y) + (r - z) * (r - z)) / 0.25;
    return s < 1 ? height * std::pow(1 - s, 4) * (4 * s + 1) : 0;
  });
}

TEST(Solid, SlicesAndProjectionsAreWhatTheyAreCalled) {
  // rho = 100 i + 10 j + k on 2 x 3 x 4 points.
  DensityGrid density{make_lattice(3, {0, 0, 0}, {1, 2, 3}, 4), {}};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 2; ++i) density.rho.push_back(100 * i + 10 * j + k);
  const Plane xy = slice(density, 0, 1, 2);
  EXPECT_EQ(xy.nx, 2u);
  EXPECT_EQ(xy.ny, 3u);
  EXPECT_EQ(xy.value, (std::vector<double>{2, 102, 12, 112, 22, 122}));
  EXPECT_EQ(slice(density, 2, 1, 1).value,
            (std::vector<double>{100, 101, 102, 103, 110, 111, 112, 113, 120, 121, 122, 123}));
  EXPECT_EQ(projection(density, 0, 1).value, (std::vector<double>{3, 103, 13, 113, 23, 123}));
  EXPECT_EQ(projection(density, 0, 2).value, (std::vector<double>{20, 120, 21, 121, 22, 122, 23, 123}));
  EXPECT_EQ(largest_point(density), (std::array<std::size_t, 3>{1, 2, 3}));
  density.rho[1] = -500;
  EXPECT_EQ(largest_point(density), (std::array<std::size_t, 3>{1, 0, 0})) << "largest in size";
  EXPECT_EQ(projection(density, 0, 1).value[1], -500);
  density.rho[1] = nan;
  EXPECT_EQ(projection(density, 0, 1).value[1], 103) << "one that is not a number hides no others";
}

TEST(Solid, TheLargestPointOfAPlateauIsItsMiddle) {
  // Noise of rounding, largest in a corner of the plateau.
  const DensityGrid plateau = sampled({0, 0, 0}, {1, 1, 1}, 21, [](double x, double y, double z) {
    const bool inside = std::abs(x - 0.5) < 0.26 && std::abs(y - 0.6) < 0.26 && std::abs(z - 0.4) < 0.26;
    return inside ? 1 + 1e-9 * (x + y + z) : 0.;
  });
  EXPECT_EQ(largest_point(plateau), (std::array<std::size_t, 3>{10, 12, 8}));
}

TEST(Solid, ThinningKeepsPlacesAndValues) {
  const auto density =
      sampled({-1, 0, 2}, {1, 1, 4}, 41, [](double x, double y, double z) { return x + 10 * y + 100 * z; });
  const DensityGrid thin = thinned(density, 20);
  for (const std::size_t points : thin.lattice.points) EXPECT_LE(points, 21u);
  EXPECT_EQ(thin.rho.size(), thin.lattice.size());
  const Lattice& at = thin.lattice;
  for (const std::array<std::size_t, 3> i : {std::array<std::size_t, 3>{0, 0, 0}, {3, 2, 1}, {20, 10, 20}})
    EXPECT_DOUBLE_EQ(thin.rho[i[0] + at.points[0] * (i[1] + at.points[1] * i[2])],
                     at.coordinate(0, i[0]) + 10 * at.coordinate(1, i[1]) + 100 * at.coordinate(2, i[2]));
  EXPECT_EQ(thinned(density, 41).rho, density.rho);
}

TEST(Style, KnowsTheDimensionsItShows) {
  for (const char* flat : {"surface", "contour", "heatmap"}) {
    EXPECT_TRUE(find_style(flat).about.shows(2)) << flat;
    EXPECT_FALSE(find_style(flat).about.shows(3)) << flat;
  }
  for (const char* solid : {"slices", "projection", "isosurface"}) {
    EXPECT_FALSE(find_style(solid).about.shows(2)) << solid;
    EXPECT_TRUE(find_style(solid).about.shows(3)) << solid;
  }
  EXPECT_TRUE(find_style("error").about.shows(2) && find_style("error").about.shows(3));
}

std::vector<Style> solid_styles() {
  std::vector<Style> solid;
  for (const Style& style : styles())
    if (style.about.shows(3)) solid.push_back(style);
  return solid;
}

/// Pixel frames of the three panels, from a picture without a single number: red, each in one piece of its own.
struct PanelFrame {
  int left, right, bottom, top;
  int width() const { return right - left; }
  int height() const { return top - bottom; }
};

std::array<PanelFrame, 3> panels_of(DensityGrid density) {
  std::fill(density.rho.begin(), density.rho.end(), nan);
  const Image image = drawn(find_style("slices"), density);
  const auto bounds = [&](int x0, int x1, int y0, int y1) {
    PanelFrame found{image.width, -1, image.height, -1};
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        if (image.at(x, y) == not_a_number)
          found = {std::min(found.left, x), std::max(found.right, x), std::min(found.bottom, y),
                   std::max(found.top, y)};
    return found;
  };
  // The heading tells the number of missing values in the same red, above all panels.
  const int top = image.height - 110;
  const PanelFrame all = bounds(0, image.width, 0, top);
  // A column and a row of the picture without red part them.
  int gap_x = all.left, gap_y = all.bottom;
  while (bounds(gap_x, gap_x + 1, all.bottom, all.bottom + 20).right >= 0) ++gap_x;
  while (bounds(all.left, all.left + 20, gap_y, gap_y + 1).right >= 0) ++gap_y;
  return {bounds(0, gap_x, 0, gap_y), bounds(0, gap_x, gap_y, top), bounds(gap_x, image.width, 0, gap_y)};
}

/// Brightest place of a panel as a share of its sides.
std::array<double, 2> brightest(const Image& image, const PanelFrame& panel) {
  double most = -1, sum_x = 0, sum_y = 0, count = 0;
  for (int y = panel.bottom + 3; y < panel.top - 3; ++y)
    for (int x = panel.left + 3; x < panel.right - 3; ++x) {
      const double light = 0.2126 * image.at(x, y)[0] + 0.7152 * image.at(x, y)[1];
      if (light > most) most = light, sum_x = sum_y = count = 0;
      if (light == most) sum_x += x, sum_y += y, ++count;
    }
  return {(sum_x / count - panel.left) / panel.width(), (sum_y / count - panel.bottom) / panel.height()};
}

TEST_F(SlicesAndProjection, AreBrightestWhereTheDensityIsLargest) {
  const std::array<double, 3> at{0.25, 0.625, 0.75};  // a lattice point
  const auto density = ball(at[0], at[1], at[2]);
  const auto panels = panels_of(density);
  for (const PanelFrame& panel : panels) EXPECT_EQ(panel.width(), panel.height()) << "equal aspect";
  for (const char* style : {"slices", "projection"}) {
    const Image image = drawn(find_style(style), density);
    const auto xy = brightest(image, panels[0]), xz = brightest(image, panels[1]), zy = brightest(image, panels[2]);
    const double pixel = 1. / panels[0].width();
    EXPECT_NEAR(xy[0], at[0], pixel);
    EXPECT_NEAR(xy[1], at[1], pixel);
    EXPECT_NEAR(xz[0], at[0], pixel);
    EXPECT_NEAR(xz[1], at[2], pixel);
    EXPECT_NEAR(zy[0], at[2], pixel);
    EXPECT_NEAR(zy[1], at[1], pixel);
  }
}

TEST_F(Projection, ShowsWhatTheSlicesMiss) {
  auto density = ball(0.25, 0.25, 0.25);
  const auto second = ball(0.75, 0.75, 0.75, 0.8);
  for (std::size_t i = 0; i < density.rho.size(); ++i) density.rho[i] += second.rho[i];
  const auto panels = panels_of(density);
  const auto colour_at = [&](const Style& style, double x, double y) {
    const PanelFrame& panel = panels[0];
    return drawn(style, density)
        .at(panel.left + static_cast<int>(x * panel.width()), panel.bottom + static_cast<int>(y * panel.height()));
  };
  EXPECT_EQ(colour_at(find_style("slices"), 0.75, 0.75), viridis(0)) << "the slice lies at z = 0.25";
  const Colour seen = colour_at(find_style("projection"), 0.75, 0.75), expected = viridis(0.8);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], expected[k], 4) << "half a pixel beside the top";
}

TEST_F(Slices, KeepTheShapeOfTheBox) {
  const auto panels = panels_of(sampled({0, 0, 0}, {2, 1, 0.5}, 81, [](double, double, double) { return 0.; }));
  // Sides are whole pixels.
  const double pixels = panels[0].width() / 2.;
  EXPECT_NEAR(panels[0].height(), pixels, 1);
  EXPECT_NEAR(panels[1].width(), 2 * pixels, 1);
  EXPECT_NEAR(panels[1].height(), pixels / 2, 1);
  EXPECT_NEAR(panels[2].width(), pixels / 2, 1);
  EXPECT_NEAR(panels[2].height(), pixels, 1);
}

TEST_F(Slices, GiveAValueTheSameColourInEveryFrame) {
  const auto density = [](double other) {
    return sampled({0, 0, 0}, {1, 1, 1}, 17, [=](double x, double, double) { return x < 0.5 ? 0.5 : other; });
  };
  const auto panels = panels_of(density(0));
  for (const double other : {0., 0.3, 1., 40.}) {
    const Image image = drawn(find_style("slices"), density(other));
    const int y = panels[0].bottom + panels[0].height() / 3;
    EXPECT_EQ(image.at(panels[0].left + panels[0].width() / 4, y), viridis(0.5));
    EXPECT_EQ(image.at(panels[0].left + 3 * panels[0].width() / 4, y), viridis(other));
  }
}

TEST_F(ErrorPicture, IsBlueBelowWhiteAtAndRedAboveZero) {
  const auto error = sampled({0, 0, 0}, {1, 1, 1}, 31, [](double x, double, double) {
    return x < 0.3 ? -1e-3 : x > 0.7 ? 1e-3 : 0.;
  });
  const auto panels = panels_of(error);
  const auto solid = drawn(find_style("error"), error, {.range_min = -1e-3, .range_max = 1e-3});
  const auto colour = [&](double share) {
    const PanelFrame& panel = panels[0];
    return solid.at(panel.left + static_cast<int>(share * panel.width()), panel.bottom + panel.height() / 3);
  };
  EXPECT_EQ(colour(0.15), blue_white_red(0));
  EXPECT_EQ(colour(0.5), blue_white_red(0.5));
  EXPECT_EQ(colour(0.85), blue_white_red(1));
  EXPECT_GT(colours_of(
                drawn(find_style("error"), {make_lattice(2, {0, 0, 0}, {1, 1, 0}, 20), std::vector<double>(400, 0.1)})),
            30u);
}

/// Bounds of the pixels of about the colour of the solid surface, left of the colour bar and below the heading.
PanelFrame solid_surface(const Image& image) {
  PanelFrame found{image.width, -1, image.height, -1};
  for (int y = 0; y < image.height - 120; ++y)
    for (int x = 0; x < image.width - 180; ++x)
      if (const Colour& c = image.at(x, y); c[1] > c[2] + 30 && c[1] > c[0] + 20)
        found = {std::min(found.left, x), std::max(found.right, x), std::min(found.bottom, y), std::max(found.top, y)};
  return found;
}

TEST_F(Isosurface, OfABallIsRoundAndMovesWithIt) {
  const PanelFrame low = solid_surface(drawn(find_style("isosurface"), ball(0.5, 0.5, 0.3)));
  const PanelFrame high = solid_surface(drawn(find_style("isosurface"), ball(0.5, 0.5, 0.7)));
  ASSERT_GT(low.width(), 20);
  EXPECT_NEAR(low.width(), low.height(), 2);  // a pixel at either edge
  EXPECT_GT(high.bottom, low.bottom + 100);
  EXPECT_NEAR(high.left, low.left, 1);
}

TEST_F(Isosurface, LetsTheSolidOneShineThrough) {
  const Image image = drawn(find_style("isosurface"), ball(0.5, 0.5, 0.5));
  const PanelFrame solid = solid_surface(image);
  // Around it the clear ones tint the white background without hiding it.
  std::size_t tinted = 0;
  for (int x = solid.left - 60; x < solid.left; ++x) {
    const Colour& c = image.at(x, (solid.bottom + solid.top) / 2);
    tinted += c != white && c[0] > 100;
  }
  EXPECT_GT(tinted, 20u);
}

TEST_F(SolidPicture, HasItsSizeWhiteMarginsAndNoChange) {
  for (const Style& style : solid_styles()) {
    const PictureOptions options{.title = "Ball", .time = 1.5};
    const Image image = drawn(style, ball(0.5, 0.4, 0.3), options);
    EXPECT_EQ(image.width, 1280);
    EXPECT_EQ(image.height, 960);
    EXPECT_GT(colours_of(image), 100u);
    EXPECT_EQ(drawn(style, ball(0.5, 0.4, 0.3), options).pixels, image.pixels) << "the same input";
    const auto inner = [](int at, int size) { return at >= 8 && at < size - 8; };
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        ASSERT_TRUE((inner(x, image.width) && inner(y, image.height)) || image.at(x, y) == white)
            << x << ", " << y << " " << style.about.name;
    EXPECT_NE(drawn(style, ball(0.5, 0.4, 0.6), options).pixels, image.pixels);
  }
}

TEST_F(SolidPicture, OfUnusualBoxesAndDensitiesIsDrawn) {
  const auto slope = [](double x, double, double) { return x; };
  std::vector<DensityGrid> densities{
      sampled({0, 0, 0}, {1, 1, 1}, 2, slope),
      sampled({0, 0, 0}, {3, 1, 0.01}, 20, slope),  // one point along z
      sampled({0, 0, 0}, {0.02, 1, 4}, 100, slope),
      sampled({1e6, 1e6, 1e6}, {1e6 + 1, 1e6 + 1, 1e6 + 1}, 20, slope),
      sampled({0, 0, 0}, {1e-9, 1e-9, 1e-9}, 20, slope),
      sampled({-1, -1, -1}, {1, 1, 1}, 20, slope),  // on both sides of 0
      sampled({0, 0, 0}, {1, 1, 1}, 5, [](double, double, double) { return 0.; }),
      sampled({0, 0, 0}, {1, 1, 1}, 5, [](double, double, double) { return nan; }),
      sampled({0, 0, 0}, {1, 1, 1}, 5,
              [](double x, double, double) { return x > 0.5 ? std::numeric_limits<double>::infinity() : -1e300; }),
  };
  for (std::size_t i = 0; i < densities.size(); ++i)
    for (const char* style : {"slices", "projection", "isosurface"})
      EXPECT_GT(colours_of(drawn(find_style(style), densities[i], {.range_max = 0, .width = 320, .height = 240})), 20u)
          << "density " << i << ", " << style;
}

TEST_F(SolidPicture, OfTheWrongDimensionIsRefused) {
  const ScratchFolder folder;
  const DensityGrid flat{make_lattice(2, {0, 0, 0}, {1, 1, 0}, 3), std::vector<double>(9)};
  for (const char* style : {"slices", "projection", "isosurface"})
    EXPECT_THROW(draw(find_style(style), flat, {}, folder / "p.png"), Error);
  for (const char* style : {"surface", "contour", "heatmap"})
    EXPECT_THROW(draw(find_style(style), ball(0.5, 0.5, 0.5), {}, folder / "p.png"), Error);
  auto short_one = ball(0.5, 0.5, 0.5);
  short_one.rho.pop_back();
  for (const Style& style : solid_styles()) EXPECT_THROW(draw(style, short_one, {}, folder / "p.png"), Error);
  EXPECT_EQ(folder.count(), 0u);
}

}  // namespace
}  // namespace gaussdrift::render
