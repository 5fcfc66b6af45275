#include "gaussdrift/lattice.hpp"

#include <gtest/gtest.h>

namespace gaussdrift {
namespace {

TEST(Lattice, HasThePapersSpacingOnASquare) {
  const Lattice lattice = make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 300);
  EXPECT_DOUBLE_EQ(lattice.spacing, 2.0 / 299);  // [Sch06, 5.3.5]: h = side / (n_g - 1)
  EXPECT_EQ(lattice.size(), 90'000u);
  EXPECT_EQ(lattice.coordinate(0, 0), -1.0);
  EXPECT_NEAR(lattice.coordinate(1, 299), 1.0, 1e-15);  // one rounding
}

TEST(Lattice, KeepsTheSpacingOnTheShorterAxisAndCentresIt) {
  const Lattice lattice = make_lattice(2, {0, 0, 0}, {2, 1.1, 0}, 21);
  EXPECT_EQ(lattice.points[0], 21u);
  EXPECT_EQ(lattice.points[1], 12u);  // floor(1.1 / 0.1) + 1
  EXPECT_NEAR(lattice.coordinate(1, 0) - 0, 1.1 - lattice.coordinate(1, 11), 1e-15);
}

TEST(Lattice, KeepsThePointThatRoundingWouldLose) {
  // 0.3 / 0.1 is 2.9999999999999996 in floating point; the axis has four points all the same.
  const Lattice lattice = make_lattice(2, {0, 0, 0}, {1, 0.3, 0}, 11);
  EXPECT_EQ(lattice.points[1], 4u);
}

TEST(Lattice, WithASpacingCoversALongDomainAndIsCentred) {
  const Lattice channel = make_lattice_with_spacing(2, {0, 0, 0}, {10000, 100, 0}, 5);
  EXPECT_EQ(channel.points, (std::array<std::size_t, 3>{2001, 21, 1}));
  EXPECT_EQ(channel.spacing, 5);
  EXPECT_EQ(channel.coordinate(1, 20), 100);
  const Lattice rest = make_lattice_with_spacing(2, {0, 0, 0}, {1, 0.5, 0}, 0.3);
  EXPECT_EQ(rest.points, (std::array<std::size_t, 3>{4, 2, 1}));
  EXPECT_NEAR(rest.coordinate(0, 0), 0.05, 1e-15);  // a few roundings of 1
  EXPECT_NEAR(rest.coordinate(0, 3), 0.95, 1e-15);
}

TEST(Lattice, CountsAllAxesInThreeDimensions) {
  const Lattice lattice = make_lattice(3, {0, 0, 0}, {1, 0.5, 0.25}, 9);
  EXPECT_EQ(lattice.points, (std::array<std::size_t, 3>{9, 5, 3}));
  EXPECT_EQ(lattice.size(), 135u);
}

TEST(Lattice, FarFromTheOriginStaysUniform) {
  const Lattice lattice = make_lattice(2, {1e6, 1e6, 0}, {1e6 + 1, 1e6 + 1, 0}, 101);
  EXPECT_EQ(lattice.points[0], 101u);
  EXPECT_NEAR(lattice.coordinate(0, 100), 1e6 + 1, 2e-10);  // spacing of doubles at 1e6
}

}  // namespace
}  // namespace gaussdrift
