// Looks of pictures: what a zoom, a range, a logarithm, an eye and a field change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <set>

#include "gaussdrift/error.hpp"
#include "pictures.hpp"
#include "render/picture.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {
namespace {

using Looks = Drawn;

DensityGrid sampled(const std::function<double(double, double)>& rho) {
  DensityGrid density{make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 81), {}};
  const Lattice& lattice = density.lattice;
  FieldOnGrid velocity{"velocity", 2, {}};
  for (std::size_t j = 0; j < lattice.points[1]; ++j)
    for (std::size_t i = 0; i < lattice.points[0]; ++i) {
      density.rho.push_back(rho(lattice.coordinate(0, i), lattice.coordinate(1, j)));
      velocity.values.push_back(3), velocity.values.push_back(4);
    }
  density.fields = {velocity};
  return density;
}

/// How many pixels have this colour.
std::size_t count(const Image& image, const Colour& colour) {
  return static_cast<std::size_t>(std::count(image.pixels.begin(), image.pixels.end(), colour));
}

Image map_of(const DensityGrid& density, PicturesSpec looks, double low = 0, double high = 1) {
  return picture_of(
      find_style("heatmap"), density,
      {.title = "", .range_min = low, .range_max = high, .width = 640, .height = 480, .looks = std::move(looks)});
}

TEST_F(Looks, ZoomShowsThatPartAlone) {
  // 1 in the upper right quarter, else 0.
  const auto density = sampled([](double x, double y) { return x > 0.01 && y > 0.01 ? 1. : 0.; });
  const Image whole = map_of(density, {}), part = map_of(density, {.zoom = {0.1, 0.9, 0.1, 0.9}}),
              other = map_of(density, {.zoom = {-0.9, -0.1, -0.9, -0.1}});
  EXPECT_GT(count(part, viridis(1)), 3 * count(whole, viridis(1)));
  EXPECT_LT(count(part, viridis(0)), 50u) << "but for the bar";
  EXPECT_LT(count(other, viridis(1)), 50u);
}

TEST_F(Looks, LogarithmGivesPowersOfTenEqualSteps) {
  for (const double power : {-1., -2., -3.}) {
    const auto density = sampled([&](double, double) { return std::pow(10, power); });
    const Image image = map_of(density, {.log = true}, 1e-4, 1);
    EXPECT_GT(count(image, viridis(1 + power / 4)), 50'000u) << power;
  }
  // What is not positive has the lowest colour, and no number of it is missing.
  const Image none = map_of(sampled([](double x, double) { return x > 0 ? -1. : 0.; }), {.log = true}, 1e-4, 1);
  EXPECT_GT(count(none, viridis(0)), 50'000u);
  EXPECT_EQ(count(none, not_a_number), 0u);
}

TEST(LogarithmicRange, IsRoundAndAtMostSixPowersWide) {
  EXPECT_EQ(logarithmic_range(0, 0.97), std::pair(1e-6, 1.));
  EXPECT_EQ(logarithmic_range(0.03, 0.97), std::pair(0.02, 1.));
  EXPECT_EQ(logarithmic_range(-1, 0), std::pair(0.1, 1.));
}

TEST(RangeOfAStyle, IsAsFarBelowZeroAsAboveForBothSigns) {
  const Style &map = find_style("heatmap"), &lines = find_style("contour");
  EXPECT_EQ(range_of(map, {}, -0.5, 1), std::pair(-1., 1.));
  EXPECT_EQ(range_of(map, {}, -1, 0), std::pair(-1., 1.));
  EXPECT_EQ(range_of(map, {}, -0.005, 1), std::pair(0., 1.)) << "an overshoot of blobs of high order";
  EXPECT_EQ(range_of(map, {.colour_map = "viridis"}, -0.5, 1), lines.range(-0.5, 1)) << "as the case wishes";
  EXPECT_EQ(range_of(lines, {}, -0.5, 1), lines.range(-0.5, 1)) << "white lines are not seen";
}

TEST_F(Looks, ValuesOfBothSignsHaveWhiteAtZeroAndOthersNot) {
  const auto of = [](double low) {
    const auto density = sampled([low](double x, double) { return x < 0.5 ? low : 1; });
    const Image image = picture_of(find_style("heatmap"), density, {.range_max = 0, .width = 640, .height = 480});
    return std::pair(count(image, blue_white_red(1)), count(image, viridis(1)));
  };
  EXPECT_GT(of(-1).first, 10'000u);
  EXPECT_LT(of(-1).second, 100u);
  EXPECT_GT(of(0).second, 10'000u);
  EXPECT_LT(of(0).first, 100u);
}

TEST_F(Looks, ColourMapReplacesThatOfTheStyle) {
  const auto density = sampled([](double, double) { return 0.5; });
  for (const ColourMap& map : colour_maps())
    for (const char* style : {"heatmap", "contour", "surface"}) {
      const Image image =
          picture_of(find_style(style), density,
                     {.width = 320, .height = 240, .looks = {.colour_map = std::string(map.about.name)}});
      for (const double position : {0.25, 0.45, 0.75}) {  // between the marks
        // The bar has them all, in steps of one row.
        const Colour wanted = map.map(position);
        const auto is_near = [&](const Colour& colour) {
          return std::abs(colour[0] - wanted[0]) + std::abs(colour[1] - wanted[1]) + std::abs(colour[2] - wanted[2]) <
                 8;
        };
        EXPECT_TRUE(std::any_of(image.pixels.begin(), image.pixels.end(), is_near))
            << map.about.name << " " << style << " at " << position;
      }
    }
}

TEST_F(Looks, BackgroundIsThereOrNot) {
  const auto density = sampled([](double x, double y) { return std::exp(-8 * (x * x + y * y)); });
  for (const char* style : {"heatmap", "surface"}) {
    const auto options = [&](bool transparent) {
      return PictureOptions{.width = 320, .height = 240, .looks = {.transparent = transparent}};
    };
    const Image opaque = picture_of(find_style(style), density, options(false)),
                clear = picture_of(find_style(style), density, options(true));
    EXPECT_TRUE(opaque.opacity.empty());
    ASSERT_EQ(clear.opacity.size(), clear.pixels.size());
    EXPECT_EQ(clear.pixels, opaque.pixels) << "over white they are the same";
    EXPECT_EQ(clear.opacity[0], 0);
    EXPECT_GT(std::count(clear.opacity.begin(), clear.opacity.end(), 255), 5000);
  }
}

TEST_F(Looks, EveryEyeSeesTheSceneInItsMargins) {
  const auto density = sampled([](double x, double y) { return std::exp(-8 * (x * x + y * y)); });
  std::set<std::vector<Colour>> pictures;
  for (const double azimuth : {-62., 30., 135., 230.}) {
    const Image image =
        picture_of(find_style("surface"), density, {.width = 320, .height = 240, .looks = {.view = {azimuth, 25}}});
    for (int x = 0; x < image.width; ++x) EXPECT_EQ(image.at(x, 1), white);
    for (int y = 0; y < image.height; ++y) EXPECT_EQ(image.at(1, y), white);
    pictures.insert(image.pixels);
  }
  EXPECT_EQ(pictures.size(), 4u);
}

TEST_F(Looks, VelocityLiesOverMapsAndFieldsReplaceTheDensity) {
  auto density = sampled([](double, double) { return 0.; });
  const Image plain = map_of(density, {}), arrows = map_of(density, {.velocity = "arrows"});
  std::size_t covered = 0;
  for (std::size_t i = 0; i < plain.pixels.size(); ++i) covered += plain.pixels[i] != arrows.pixels[i];
  EXPECT_GT(covered, 24u * 24u * 5u) << "24 x 24 arrows of some pixels";
  DensityGrid without = density;
  without.fields.clear();
  EXPECT_THROW(map_of(without, {.velocity = "arrows"}), Error);
  show_field(density, "velocity");
  EXPECT_EQ(density.rho, std::vector<double>(density.rho.size(), 5.0)) << "the length of (3, 4)";
  EXPECT_THROW(show_field(density, "age"), Error);
}

TEST_F(Looks, IsosurfaceOfALowDensityHasLevelsOfItsOwn) {
  DensityGrid density{make_lattice(3, {-1, -1, -1}, {1, 1, 1}, 21), {}};
  const Lattice& lattice = density.lattice;
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    const double x = lattice.coordinate(0, i % 21), y = lattice.coordinate(1, i / 21 % 21),
                 z = lattice.coordinate(2, i / 441);
    density.rho.push_back(0.05 * std::exp(-4 * (x * x + y * y + z * z)));
  }
  const PictureOptions options{.width = 640, .height = 480};
  const auto coloured = [&](const DensityGrid& one) {
    const Image image = picture_of(find_style("isosurface"), one, options);
    std::size_t inside = 0;
    for (int y = 100; y < 380; ++y)
      for (int x = 100; x < 500; ++x) {
        const Colour& c = image.at(x, y);
        inside += std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}) > 15;
      }
    return inside;
  };
  EXPECT_GT(coloured(density), 500u);
  std::fill(density.rho.begin(), density.rho.end(), 0.0);
  EXPECT_EQ(coloured(density), 0u);
}

}  // namespace
}  // namespace gaussdrift::render
