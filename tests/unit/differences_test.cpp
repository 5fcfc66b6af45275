// Slopes by differences: those of smooth fields and of corners are kept, a jump is told and is none.
#include "field/velocity/differences.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "field/gridded/gridded.hpp"
#include "field/velocity/expression_field.hpp"

namespace gaussdrift {
namespace {

constexpr double distance = 1e-5;  // a thousandth of the core radius of a usual case

struct Found {
  std::array<Columns, max_dimension> gradient;
  std::vector<Jump> jumps;
  double slope(int component, int axis) const {
    return gradient[static_cast<std::size_t>(component)][static_cast<std::size_t>(axis)][0];
  }
};

Found at(const VelocityField& field, const Vector& place, int dimension = 2) {
  Columns x;
  for (int k = 0; k < dimension; ++k) x[static_cast<std::size_t>(k)] = {place[static_cast<std::size_t>(k)]};
  Found found;
  found.gradient = gradient_by_differences(field, 0, x, dimension, distance, &found.jumps);
  return found;
}

TEST(Differences, KeepSteepSmoothSlopes) {
  const ExpressionField steep({"-1000*(x-0.5)", "1e6*y"}, {});
  const Found linear = at(steep, {0.62, 0.3, 0});
  EXPECT_NEAR(linear.slope(0, 0), -1000, 1e-5);  // rounding of 120 over 2e-5
  EXPECT_NEAR(linear.slope(1, 1), 1e6, 1e-2);
  EXPECT_EQ(linear.slope(0, 1), 0);
  EXPECT_TRUE(linear.jumps.empty());
  // A front twenty differences wide is a slope, all over it.
  const ExpressionField front({"-tanh((x-0.5)/2e-4)", "0"}, {});
  for (const double offset : {-4e-4, -1e-4, 0., 3e-5, 2e-4}) {
    const Found found = at(front, {0.5 + offset, 0.3, 0});
    const double exact = -1 / 2e-4 / std::pow(std::cosh(offset / 2e-4), 2);
    EXPECT_NEAR(found.slope(0, 0), exact, 2e-3 * std::abs(exact)) << offset;  // (d/w)^2/3
    EXPECT_TRUE(found.jumps.empty()) << offset;
  }
}

TEST(Differences, TakeTheSlopeBesideAJump) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> where(-1.5 * distance, 1.5 * distance), height(-3, 3);
  for (int trial = 0; trial < 200; ++trial) {
    const double jump = trial == 0 ? 0.62 : 0.62 + where(random), by = trial == 0 ? 1 : height(random);
    const ExpressionField field({"3*x + (x < jump ? by : 0)", "y*x", "5*z - (x < jump ? 2 : 0)"},
                                {{"jump", jump}, {"by", by}});
    const Found found = at(field, {0.62, 0.3, 0.1}, 3);
    EXPECT_NEAR(found.slope(0, 0), 3, 1e-8) << jump;  // rounding of 3 over 1e-5 a few times
    EXPECT_NEAR(found.slope(2, 0), 0, 1e-8) << jump;
    EXPECT_NEAR(found.slope(2, 2), 5, 1e-8) << jump;
    EXPECT_NEAR(found.slope(1, 1), 0.62, 1e-8) << jump;
    EXPECT_EQ(found.jumps.size(), std::abs(jump - 0.62) <= distance ? 1u : 0u) << jump;
    for (const Jump& one : found.jumps) {
      EXPECT_NEAR(one.place[0], jump, distance / 8);
      EXPECT_NEAR(one.height, std::hypot(by, 2), 1e-4);
    }
  }
}

TEST(Differences, SeeAJumpOnThePointItself) {
  for (const char* text : {"sign(x-0.5)", "x<0.5?1:0", "x<=0.5?1:0", "x>0.5?-1:1", "floor(x+0.6)"}) {
    const double place = std::string(text).find("floor") == 0 ? 0.4 : 0.5;
    const Found found = at(ExpressionField({text, "0"}, {}), {place, 0.3, 0});
    EXPECT_EQ(found.slope(0, 0), 0) << text;
    EXPECT_FALSE(found.jumps.empty()) << text;
  }
}

TEST(Differences, TakeNoCornerAndNoRippleForAJump) {
  const Found corner = at(ExpressionField({"7*abs(x-0.5)", "min(y, 0.3)"}, {}), {0.5 + 3e-6, 0.3, 0});
  EXPECT_NEAR(corner.slope(0, 0), 7 * 0.3, 1e-8);  // 13 parts right of it, 7 left, of 20
  EXPECT_NEAR(corner.slope(1, 1), 0.5, 1e-8);
  EXPECT_TRUE(corner.jumps.empty());
  // Treads far below the difference are the slope of the stairs.
  const Found stairs = at(ExpressionField({"floor(1e8*x)/1e8", "0"}, {}), {0.5, 0.3, 0});
  EXPECT_NEAR(stairs.slope(0, 0), 1, 2e-3);
  EXPECT_TRUE(stairs.jumps.empty());
  // Rounding is no jump, wherever the domain is.
  const Found far = at(ExpressionField({"1e3 + sin(x)", "x*x - 1e12"}, {}), {1e6, 0.3, 0});
  EXPECT_TRUE(far.jumps.empty());
}

TEST(Differences, SeeTheEdgeOfDataThatEndInZero) {
  auto data = std::make_shared<GridData>();
  data->dimension = 2;
  data->components = 2;
  data->axis[0] = {0, 0.5, 1};
  data->axis[1] = {0, 1};
  data->times = {0};
  data->values = {{1, 2, 1, 2, 1, 2, 1, 2, 1, 2, 1, 2}};
  const GriddedVelocity wind(GridInterpolator(data, Interpolation::linear, Outside::zero));
  const Found edge = at(wind, {1 + 2e-6, 0.5, 0});
  EXPECT_EQ(edge.slope(0, 0), 0);
  EXPECT_EQ(edge.slope(1, 0), 0);
  ASSERT_EQ(edge.jumps.size(), 1u);
  EXPECT_NEAR(edge.jumps[0].height, std::sqrt(5.), 1e-9);
  // Nothing is known outside of data that end in an error.
  const GriddedVelocity bounded(GridInterpolator(data, Interpolation::linear, Outside::error));
  const Found outside = at(bounded, {1, 0.5, 0});
  EXPECT_TRUE(std::isnan(outside.slope(0, 0)));
  EXPECT_TRUE(outside.jumps.empty());
}

}  // namespace
}  // namespace gaussdrift
