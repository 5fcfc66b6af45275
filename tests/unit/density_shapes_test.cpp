#include "field/density.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gaussdrift {
namespace {

using Profile = RadialDensity::Profile;

double at(const InitialDensity& density, double x, double y) {
  PointsView point{2, 1, {&x, &y, nullptr}};
  double value = 0;
  density.add(point, &value);
  return value;
}

TEST(RadialDensity, HasItsHeightAtTheCentreAndItsProfileAside) {
  const Vector centre{0.5, -0.25, 0};
  EXPECT_EQ(at(RadialDensity(Profile::wendland, centre, 0.25, 1), 0.5, -0.25), 1);
  EXPECT_EQ(at(RadialDensity(Profile::wendland, centre, 0.25, 2), 0.625, -0.25),
            2 * 0.0625 * 3);  // s = 1/2: (1/2)^4 * 3
  EXPECT_EQ(at(RadialDensity(Profile::wendland, centre, 0.25, 1), 0.75, -0.25), 0);
  EXPECT_EQ(at(RadialDensity(Profile::cone, centre, 0.5, 4), 0.5, 0), 2);
  EXPECT_EQ(at(RadialDensity(Profile::gaussian, centre, 0.5, 1), 1, -0.25), std::exp(-1.0));
  EXPECT_EQ(at(RadialDensity(Profile::disk, centre, 0.5, 3), 0.99, -0.25), 3);
  EXPECT_EQ(at(RadialDensity(Profile::disk, centre, 0.5, 3), 1, -0.25), 0);  // the edge is outside
}

TEST(WrittenDensity, KnowsCoordinatesAndParams) {
  EXPECT_DOUBLE_EQ(at(WrittenDensity("a*x + y^2", 2, {{"a", 3}}), 0.5, 2), 5.5);
}

TEST(SumDensity, AddsItsParts) {
  std::vector<std::unique_ptr<InitialDensity>> parts;
  parts.push_back(std::make_unique<RadialDensity>(Profile::disk, Vector{}, 1, 1));
  parts.push_back(std::make_unique<WrittenDensity>("x", 2, std::vector<std::pair<std::string, double>>{}));
  EXPECT_DOUBLE_EQ(at(SumDensity(std::move(parts)), 0.5, 0), 1.5);
}

}  // namespace
}  // namespace gaussdrift
