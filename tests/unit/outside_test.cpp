// What is outside the domain, and what is said about it.
#include "sim/borders/outside.hpp"

#include <gtest/gtest.h>

namespace gaussdrift {
namespace {

const Domain box{3, {0, 0, 0}, {1, 2, 1}};

Particles in_a_row(const std::vector<double>& x, const std::vector<double>& alpha) {
  Particles particles;
  particles.dimension = 3;
  particles.position[0] = x;
  particles.position[1].assign(x.size(), 1.5);
  particles.position[2].assign(x.size(), 0.5);
  particles.alpha = alpha;
  return particles;
}

TEST(PartOutside, IsOfTheSizesOfWeights) {
  EXPECT_EQ(part_outside(in_a_row({0.5, 1.5, -0.1, 0.9}, {4, 1, -2, 1}), box), 3.0 / 8);
  EXPECT_EQ(part_outside(in_a_row({0, 1, 1 + 1e-12}, {1, 1, 1}), box), 0) << "the edge, but for rounding, is inside";
  EXPECT_EQ(part_outside(in_a_row({2, 3}, {0, 0}), box), 0) << "no weight is nowhere";
  Particles deep = in_a_row({0.5, 0.5}, {1, 3});
  deep.position[2][1] = 1.01;
  EXPECT_EQ(part_outside(deep, box), 0.75) << "the third axis counts";
}

TEST(Percent, ShowsWhatIsMissing) {
  EXPECT_EQ(percent_text(0.0123), "1.2 %");
  EXPECT_EQ(percent_text(0.962235), "96 %");
  EXPECT_EQ(percent_text(0.99995), "99.995 %");
  EXPECT_EQ(percent_text(1), "all");
  EXPECT_EQ(percent_text(1 - 1e-13), "all");
}

std::vector<std::pair<double, FrameNumbers>> outputs(const std::vector<double>& outside, double weight_at_end = 1) {
  std::vector<std::pair<double, FrameNumbers>> frames;
  for (const double part : outside) {
    frames.emplace_back(static_cast<double>(frames.size()), FrameNumbers{});
    frames.back().second.outside = part;
    frames.back().second.weight = 1;
  }
  frames.back().second.weight = weight_at_end;
  return frames;
}

TEST(AboutLeaving, SaysHowMuchAndSinceWhen) {
  EXPECT_EQ(about_leaving({}), "");
  EXPECT_EQ(about_leaving(outputs({0, 1e-4})), "") << "a layer at the edge";
  EXPECT_EQ(about_leaving(outputs({0, 0.5, 1, 1})),
            "all of the mass has left the domain by t = 2: outputs from there on show nothing of it; end the run "
            "earlier, or enlarge the domain");
  EXPECT_EQ(about_leaving(outputs({0, 0.02})),
            "at t = 1, 2 % of the mass is outside the domain; outputs show the density of what is inside");
  EXPECT_EQ(about_leaving(outputs({0, 0.4, 0.02})),
            "at t = 2, 2 % of the mass is outside the domain, and at t = 1, 40 % of it was outside; outputs show the "
            "density of what is inside");
  EXPECT_EQ(about_leaving(outputs({0, 1, 0})),
            "at t = 1, all of the mass was outside; outputs show the density of what is inside");
  EXPECT_NE(about_leaving(outputs({0, 0, 0}, 0)).find("every weight has fallen to 0 by t = 2"), std::string::npos);
}

TEST(PartBeyond, IsWhatTheLatticeCannotSee) {
  const Lattice lattice = make_lattice(3, {0, 0, 0}, {1, 1, 1}, 3);
  Particles corner;
  corner.dimension = 3;
  corner.alpha = {1, 2};
  corner.id = {0, 13};  // a corner, and the middle
  EXPECT_EQ(part_beyond(12.0, corner, lattice), 0.75);
  EXPECT_EQ(part_beyond(std::nullopt, corner, lattice), 0) << "a mass that is not known";
  corner.alpha[0] = 0;
  EXPECT_EQ(part_beyond(12.0, corner, lattice), 0) << "nothing at the edge: the shape is coarse, not cut";
}

}  // namespace
}  // namespace gaussdrift
