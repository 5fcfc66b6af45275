#include "field/density/box_density.hpp"
#include "field/density/radial_density.hpp"
#include "field/density/shapes.hpp"
#include "field/density/sum_density.hpp"
#include "field/density/written_density.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace gaussdrift {
namespace {

using Profile = RadialDensity::Profile;

double at(const InitialDensity& density, double x, double y) {
  PointsView point{2, 1, {&x, &y, nullptr}};
  double value = 0;
  density.add(point, &value);
  return value;
}

double at(const InitialDensity& density, double x, double y, double z) {
  PointsView point{3, 1, {&x, &y, &z}};
  double value = 0;
  density.add(point, &value);
  return value;
}

RadialDensity radial(Profile profile, const Vector& centre, double radius, double height) {
  return {profile, 2, centre, radius, height};
}

TEST(RadialDensity, HasItsHeightAtTheCentreAndItsProfileAside) {
  const Vector centre{0.5, -0.25, 0};
  EXPECT_EQ(at(radial(Profile::wendland, centre, 0.25, 1), 0.5, -0.25), 1);
  EXPECT_EQ(at(radial(Profile::wendland, centre, 0.25, 2), 0.625, -0.25), 2 * 0.0625 * 3);  // s = 1/2: (1/2)^4 * 3
  EXPECT_EQ(at(radial(Profile::wendland, centre, 0.25, 1), 0.75, -0.25), 0);
  EXPECT_DOUBLE_EQ(at(radial(Profile::wendland4, centre, 0.25, 1), 0.625, -0.25),
                   20.75 / 192);                                                          // (1/2)^6 (35/4 + 9 + 3) / 3
  EXPECT_EQ(at(radial(Profile::wendland6, centre, 0.25, 1), 0.625, -0.25), 15.25 / 256);  // (1/2)^8 (4 + 25/4 + 4 + 1)
  EXPECT_EQ(at(radial(Profile::cone, centre, 0.5, 4), 0.5, 0), 2);
  EXPECT_EQ(at(radial(Profile::gaussian, centre, 0.5, 1), 1, -0.25), std::exp(-1.0));
  EXPECT_DOUBLE_EQ(at(radial(Profile::cosine_bell, centre, 0.5, 2), 0.75, -0.25), 1);  // s = 1/2
  EXPECT_EQ(at(radial(Profile::cosine_bell, centre, 0.5, 2), 1.5, -0.25), 0) << "not the next bell";
  EXPECT_EQ(at(radial(Profile::disk, centre, 0.5, 3), 0.99, -0.25), 3);
  EXPECT_EQ(at(radial(Profile::disk, centre, 0.5, 3), 1, -0.25), 0);  // the edge is outside
}

TEST(RadialDensity, IsABallInSpace) {
  const RadialDensity ball(Profile::disk, 3, {0, 0, 1}, 0.5, 1);
  EXPECT_EQ(at(ball, 0, 0, 1.49), 1);
  EXPECT_EQ(at(ball, 0, 0, 1.51), 0);
  EXPECT_EQ(at(RadialDensity(Profile::cone, 3, {}, 3, 1), 1, 1, 1), 1 - std::sqrt(3.0) / 3);
}

// The integral of f over [0, end] by Gauss's rule with 5 nodes on each of `pieces` pieces.
double integral(const std::function<double(double)>& f, double end, int pieces) {
  constexpr std::array<double, 5> node{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                       0.9061798459386640};
  constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                         0.2369268850561891};
  double sum = 0;
  for (int piece = 0; piece < pieces; ++piece)
    for (std::size_t q = 0; q < node.size(); ++q) sum += weight[q] * f(end * (piece + 0.5 + 0.5 * node[q]) / pieces);
  return 0.5 * sum * end / pieces;
}

constexpr std::array every_profile{Profile::wendland, Profile::wendland4,   Profile::wendland6, Profile::cone,
                                   Profile::gaussian, Profile::cosine_bell, Profile::disk};

class EveryProfile : public ::testing::TestWithParam<Profile> {};

TEST_P(EveryProfile, HasTheMassOfItsRadialIntegral) {
  constexpr double radius = 0.3, height = 1.7, pi = std::numbers::pi;
  const double end = GetParam() == Profile::gaussian ? 8 * radius : radius;  // beyond 8 radii: exp(-64)
  for (const int dimension : {2, 3}) {
    const RadialDensity density(GetParam(), dimension, {}, radius, height);
    const double mass = integral(
        [&](double r) {
          return dimension == 2 ? 2 * pi * r * at(density, r, 0) : 4 * pi * r * r * at(density, r, 0, 0);
        },
        end, 64);
    // 4e-15, rounding: polynomials of degree at most 13 on 64 pieces; the Gaussian and the cosine are as smooth
    EXPECT_NEAR(density.mass().value(), mass, 4e-15 * mass) << dimension;
  }
}

TEST_P(EveryProfile, FadesAsSmoothlyAsItSays) {
  // With m continuous derivatives the profile falls like (1-s)^(m+1) at the edge: halving 1 - s divides it by 2^(m+1).
  const auto at_edge = [&](double gap) { return at(radial(GetParam(), {}, 1, 1), 1 - gap, 0); };
  const double order = std::log2(at_edge(2e-3) / at_edge(1e-3));
  switch (GetParam()) {
    case Profile::wendland:
      EXPECT_NEAR(order, 4, 0.0034);  // (1-s)^4: three derivatives vanish at the edge, two exist at the centre
      break;
    case Profile::wendland4:
      EXPECT_NEAR(order, 6, 0.0068);
      break;
    case Profile::wendland6:
      EXPECT_NEAR(order, 8, 0.01);
      break;
    case Profile::cone:
      EXPECT_NEAR(order, 1, 1e-12);  // exactly, and measured so
      break;
    case Profile::cosine_bell:
      EXPECT_NEAR(order, 2, 1e-5);
      break;
    case Profile::gaussian:
    case Profile::disk:
      EXPECT_LT(std::abs(order), 0.008);  // no edge, or a jump; measured 0.0029
      break;
  }
}

INSTANTIATE_TEST_SUITE_P(, EveryProfile, ::testing::ValuesIn(every_profile));

std::unique_ptr<InitialDensity> slotted_disk(int dimension, const Vector& center, double width, double length,
                                             double height) {
  return find_named_shape("slotted_disk")
      .make(dimension, {{"center", {center[0], center[1], center[2]}},
                        {"radius", {15}},
                        {"slot_width", {width}},
                        {"slot_length", {length}},
                        {"height", {height}}});
}

bool slot_fits(double radius, double width, double length) {
  const Arguments arguments{{"radius", {radius}}, {"slot_width", {width}}, {"slot_length", {length}}};
  return find_named_shape("slotted_disk").about.problem(2, arguments).empty();
}

TEST(SlottedDisk, IsTheDiskOfZalesakWithoutItsSlot) {
  const auto disk = slotted_disk(2, {50, 75, 0}, 5, 25, 1);
  EXPECT_EQ(at(*disk, 50, 86), 1) << "the bridge above the slot, which ends at y = 85";
  EXPECT_EQ(at(*disk, 50, 84.9), 0);
  EXPECT_EQ(at(*disk, 50, 61), 0) << "the slot is open below";
  EXPECT_EQ(at(*disk, 52.4, 70), 0);
  EXPECT_EQ(at(*disk, 52.6, 70), 1);
  EXPECT_EQ(at(*disk, 64.9, 75), 1);
  EXPECT_EQ(at(*disk, 65.1, 75), 0);
}

TEST(SlottedDisk, HasTheMassOfItsArea) {
  for (const auto& [width, length] : {std::pair{5., 25.}, {8., 12.}, {2., 29.}}) {
    const auto disk = slotted_disk(2, {}, width, length, 2);
    // Columns of the disk, less what the slot takes of those within half its width. The circle's ends are like roots.
    const double whole = 2 * 225 * std::numbers::pi;
    const double slot =
        2 * 2 * integral([cut = length](double x) { return cut - 15 + std::sqrt(225 - x * x); }, width / 2, 64);
    EXPECT_NEAR(disk->mass().value(), whole - slot, 7e-13) << "three roundings of 1400";
    // And by counting lattice points, which is right to about the perimeter times the spacing.
    double area = 0;
    const double h = 0.05;
    for (double x = -15 + h / 2; x < 15; x += h)
      for (double y = -15 + h / 2; y < 15; y += h) area += h * h * at(*disk, x, y);
    EXPECT_NEAR(disk->mass().value(), area, 2 * 0.045 * h * 150)
        << "perimeter times spacing times 0.045; measured 0.014";
  }
}

TEST(SlottedDisk, InSpaceIsABallWithASlotThroughIt) {
  const auto ball = slotted_disk(3, {}, 5, 25, 1);
  EXPECT_EQ(at(*ball, 0, 0, 14), 0);
  EXPECT_EQ(at(*ball, 3, 0, 14), 1);
  EXPECT_EQ(at(*ball, 3, 0, 15), 0);
  EXPECT_EQ(at(*ball, 0, 11, 0), 1);
  EXPECT_FALSE(ball->mass().has_value());
}

TEST(SlottedDisk, KnowsWhichSlotsFit) {
  EXPECT_TRUE(slot_fits(15, 5, 25));
  EXPECT_FALSE(slot_fits(15, 5, 30)) << "cuts the disk in two";
  EXPECT_FALSE(slot_fits(15, 40, 15)) << "wider than the disk";
  EXPECT_FALSE(slot_fits(15, 20, 1)) << "its corners are below the circle";
  EXPECT_FALSE(slot_fits(15, 0, 25));
}

TEST(BoxDensity, IsItsHeightInsideAndHasItsVolume) {
  const BoxDensity plane(2, {1, 2, 0}, {0.5, 4, 0}, 3);
  EXPECT_EQ(at(plane, 1.24, 3.9), 3);
  EXPECT_EQ(at(plane, 1.26, 3.9), 0);
  EXPECT_EQ(at(plane, 1, 4.1), 0);
  EXPECT_DOUBLE_EQ(plane.mass().value(), 6);
  const BoxDensity solid(3, {}, {1, 2, 3}, 2);
  EXPECT_EQ(at(solid, 0.4, 0.9, 1.4), 2);
  EXPECT_EQ(at(solid, 0.4, 0.9, 1.6), 0);
  EXPECT_DOUBLE_EQ(solid.mass().value(), 12);
}

TEST(WrittenDensity, KnowsCoordinatesAndParams) {
  EXPECT_DOUBLE_EQ(at(WrittenDensity("a*x + y^2", 2, {{"a", 3}}), 0.5, 2), 5.5);
}

TEST(SumDensity, AddsItsPartsAndTheirMasses) {
  std::vector<std::unique_ptr<InitialDensity>> parts;
  parts.push_back(std::make_unique<RadialDensity>(Profile::disk, 2, Vector{}, 1, 1));
  parts.push_back(std::make_unique<WrittenDensity>("x", 2, std::vector<std::pair<std::string, double>>{}));
  const SumDensity with_expression(std::move(parts));
  EXPECT_DOUBLE_EQ(at(with_expression, 0.5, 0), 1.5);
  EXPECT_FALSE(with_expression.mass().has_value());
  parts.clear();
  parts.push_back(std::make_unique<BoxDensity>(2, Vector{}, Vector{1, 1, 0}, 1));
  parts.push_back(std::make_unique<BoxDensity>(2, Vector{}, Vector{1, 1, 0}, 2));
  EXPECT_DOUBLE_EQ(SumDensity(std::move(parts)).mass().value(), 3);
}

TEST(EveryDensity, SaysItsFormulaAndMass) {
  EXPECT_EQ(RadialDensity(Profile::wendland4, 2, {0.5, 0, 0}, 0.25, 1).describe(),
            "wendland4 (1-s)^6 (35s^2+18s+3)/3, 4 times continuously differentiable; centre (0.5, 0), radius 0.25, "
            "height 1, mass 0.0218166156");
  EXPECT_EQ(BoxDensity(3, {}, {1, 2, 3}, 1).describe(),
            "box, discontinuous; centre (0, 0, 0), lengths (1, 2, 3), height 1, mass 6");
}

}  // namespace
}  // namespace gaussdrift
