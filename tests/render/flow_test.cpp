// Arrows and lines along a velocity: directions, lengths, distances.
#include "render/flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gaussdrift/error.hpp"

namespace gaussdrift::render {
namespace {

constexpr std::size_t nx = 121, ny = 81;
constexpr double middle_x = 60, middle_y = 40;

template <class Velocity>
DensityGrid grid_of(const Velocity& velocity) {
  DensityGrid grid;
  grid.lattice.dimension = 2;
  grid.lattice.points = {nx, ny, 1};
  grid.rho.assign(nx * ny, 0.0);
  FieldOnGrid field{"velocity", 2, {}};
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i) {
      const Point u = velocity(static_cast<double>(i), static_cast<double>(j));
      field.values.push_back(u.x), field.values.push_back(u.y);
    }
  grid.fields = {field};
  return grid;
}

DensityGrid rotation() {
  return grid_of([](double x, double y) { return Point{-(y - middle_y), x - middle_x}; });
}

TEST(Arrows, PointAlongTheVelocityAndAreAsLongAsItIsFast) {
  const FlowPlane flow(rotation(), "velocity");
  const double fastest = std::hypot(60, 40), cell = 120. / 24;
  EXPECT_NEAR(flow.largest_speed(), fastest, 1e-12);
  const auto list = arrows(flow, 24);
  EXPECT_GT(list.size(), 24u * 15);
  for (const auto& arrow : list) {
    ASSERT_EQ(arrow.size(), 5u);  // tail, tip, and the head
    const Point &tail = arrow[0], &tip = arrow[1];
    const double x = (tail.x + tip.x) / 2 - middle_x, y = (tail.y + tip.y) / 2 - middle_y;
    EXPECT_NEAR(tip.x - tail.x, -y / fastest * 0.9 * cell, 1e-9);
    EXPECT_NEAR(tip.y - tail.y, x / fastest * 0.9 * cell, 1e-9);
    EXPECT_NEAR(arrow[3].x, tip.x, 1e-12);
  }
}

TEST(Streamlines, OfARotationAreCirclesThatKeepTheirDistance) {
  const FlowPlane flow(rotation(), "velocity");
  const double apart = 5;
  const auto list = streamlines(flow, apart);
  ASSERT_EQ(list.size() % 2, 0u);
  ASSERT_GE(list.size(), 2u * 6);
  double covered = 0;
  for (std::size_t k = 0; k < list.size(); k += 2) {
    const auto radius = [](const Point& p) { return std::hypot(p.x - middle_x, p.y - middle_y); };
    const double r = radius(list[k].front());
    for (const Point& p : list[k]) {
      EXPECT_NEAR(radius(p), r, 0.02);
      for (std::size_t other = 0; other < list.size(); other += 2) {
        if (other == k) continue;
        for (const Point& q : list[other]) ASSERT_GE(std::hypot(p.x - q.x, p.y - q.y), apart / 2 - 1e-9);
      }
    }
    covered += 0.5 * static_cast<double>(list[k].size());
    EXPECT_EQ(list[k + 1].size(), 3u) << "the head of an arrow";
  }
  // All of the plane: lines as long as its area over twice the distance, at least.
  EXPECT_GT(covered, 120 * 80 / (2 * apart));
}

TEST(Flow, ThatStandsStillOrIsNotKnownHasNoLines) {
  const DensityGrid still = grid_of([](double, double) { return Point{0, 0}; });
  EXPECT_TRUE(arrows(FlowPlane(still, "velocity"), 24).empty());
  EXPECT_TRUE(streamlines(FlowPlane(still, "velocity"), 5).empty());
  const DensityGrid half = grid_of([](double x, double) { return Point{x < 60 ? 1 : NAN, 0}; });
  for (const auto& arrow : arrows(FlowPlane(half, "velocity"), 24)) EXPECT_LT(arrow[1].x, 63);
  for (const auto& line : streamlines(FlowPlane(half, "velocity"), 5))
    for (const Point& p : line) EXPECT_LT(p.x, 60);
  DensityGrid without = still;
  without.fields.clear();
  EXPECT_THROW((FlowPlane{without, "velocity"}), Error);
}

}  // namespace
}  // namespace gaussdrift::render
